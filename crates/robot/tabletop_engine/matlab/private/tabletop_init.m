function [names, values] = tabletop_init(folder)
% TABLETOP_INIT  Start afresh and run the init script.  The reply holds what it has set in aux.
evalin('base', 'clear all; close all; clc;');
request = tabletop_get([folder 'request.bin']);
agent = request.agent;
limbs = request.aux.numLimbs;
template = struct('jointVelocities', zeros(limbs, request.aux.numJoints), 'gripperVelocities', zeros(limbs, 1));
driver = [folder 'driver' filesep];
tabletop_path(driver);
octave = exist('OCTAVE_VERSION', 'builtin');
% What the scripts shadow is told; what the driver shadows is not.
if octave, warning('on', 'Octave:shadowed-function'); end
addpath(agent.folder);
if octave, warning('off', 'Octave:shadowed-function'); end
if isfield(agent, 'encoding'), dir_encoding(canonicalize_file_name(agent.folder), agent.encoding); end
rehash;
tabletop_global('sensor', struct());
tabletop_global('motor', struct());
tabletop_global('aux', request.aux);
evalin('base', 'global sensor motor aux');
copies = '';
if octave, copies = tabletop_repair(agent.folder, folder); end
tabletop_keep(struct('running', fullfile(agent.folder, 'agentBehavior.m')));
[initFunc, callbackFunc] = tabletop_pair(agent);
assignin('base', 'initFunc', initFunc);
assignin('base', 'callbackFunc', callbackFunc);
kept = struct('aux', request.aux, 'motor', template, 'callbackFunc', callbackFunc, 'folder', agent.folder, 'copies', copies);
kept.running = tabletop_file(initFunc);
tabletop_keep(kept);
tabletop_run('initFunc', folder);
addpath(driver);                                   % before what init has put there
names = {'agent.init', 'agent.callback'};
values = {kept.running, tabletop_file(callbackFunc)};
kept.running = values{2};
tabletop_keep(kept);
tabletop_global('motor', template);
aux = tabletop_global('aux');
[aux_names, aux_values] = tabletop_fields('aux', aux, {'drawMarkers', 'initJointAngles', 'exit'});
names = [names, aux_names];
values = [values, aux_values];
if isstruct(aux) && numel(aux) == 1
    given = fieldnames(request.aux);
    for k = 1:numel(given)
        if ~isfield(aux, given{k}), aux.(given{k}) = request.aux.(given{k}); end
    end
    tabletop_global('aux', aux);
end
end
