function [names, values] = tabletop_init(folder)
% TABLETOP_INIT  Start afresh and run the init script.  The reply holds what it has set in aux.
evalin('base', 'clear all; close all; clc;');
request = tabletop_get([folder 'request.bin']);
template = struct('jointVelocities', zeros(2, 7), 'gripperVelocities', zeros(2, 1));
addpath(request.agent.folder);
rehash;
tabletop_global('sensor', struct());
tabletop_global('motor', struct());
tabletop_global('aux', request.aux);
evalin('base', 'global sensor motor aux');
while true
    try
        [initFunc, callbackFunc] = tabletop_pair(request.agent);
        break
    catch err
        octave = exist('OCTAVE_VERSION', 'builtin');
        if ~octave || ~tabletop_repair(err.message, folder), rethrow(err); end
    end
end
assignin('base', 'initFunc', initFunc);
assignin('base', 'callbackFunc', callbackFunc);
tabletop_keep(struct('aux', request.aux, 'motor', template, 'callbackFunc', callbackFunc));
evalin('base', 'initFunc();');
tabletop_relink;
tabletop_global('motor', template);
aux = tabletop_global('aux');
[names, values] = tabletop_fields('aux', aux, {'drawMarkers', 'initJointAngles', 'exit'});
if isstruct(aux) && numel(aux) == 1
    given = fieldnames(request.aux);
    for k = 1:numel(given)
        if ~isfield(aux, given{k}), aux.(given{k}) = request.aux.(given{k}); end
    end
    tabletop_global('aux', aux);
end
end

function [initFunc, callbackFunc] = tabletop_pair(agent)
if isfield(agent, 'init')
    initFunc = str2func(agent.init);
    callbackFunc = str2func(agent.callback);
else
    [initFunc, callbackFunc] = agentBehavior;
end
end
