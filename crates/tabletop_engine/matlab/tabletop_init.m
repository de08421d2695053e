function [names, values] = tabletop_init(folder)
% TABLETOP_INIT  Start afresh and run the init script.  The reply holds what it has set in aux.
evalin('base', 'clear all; close all; clc;');
request = tabletop_get([folder 'request.bin']);
agent = request.agent;
template = struct('jointVelocities', zeros(2, 7), 'gripperVelocities', zeros(2, 1));
tabletop_path([folder 'driver' filesep]);
addpath(agent.folder);
if isfield(agent, 'encoding'), dir_encoding(canonicalize_file_name(agent.folder), agent.encoding); end
rehash;
tabletop_global('sensor', struct());
tabletop_global('motor', struct());
tabletop_global('aux', request.aux);
evalin('base', 'global sensor motor aux');
if exist('OCTAVE_VERSION', 'builtin'), tabletop_repair(agent.folder, folder); end
[initFunc, callbackFunc] = tabletop_pair(agent);
assignin('base', 'initFunc', initFunc);
assignin('base', 'callbackFunc', callbackFunc);
kept = struct('aux', request.aux, 'motor', template, 'callbackFunc', callbackFunc, 'folder', agent.folder);
tabletop_keep(kept);
tabletop_run('initFunc', folder);
tabletop_global('motor', template);
aux = tabletop_global('aux');
[names, values] = tabletop_fields('aux', aux, {'drawMarkers', 'initJointAngles', 'exit'});
scripts = {'agent.init', initFunc; 'agent.callback', callbackFunc};
for k = 1:2
    about = functions(scripts{k, 2});
    if strcmp(about.type, 'simple')
        names{end + 1} = scripts{k, 1};
        values{end + 1} = which(about.function);
    end
end
if isstruct(aux) && numel(aux) == 1
    given = fieldnames(request.aux);
    for k = 1:numel(given)
        if ~isfield(aux, given{k}), aux.(given{k}) = request.aux.(given{k}); end
    end
    tabletop_global('aux', aux);
end
end
