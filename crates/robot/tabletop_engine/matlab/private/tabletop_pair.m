function [initFunc, callbackFunc] = tabletop_pair(agent)
% TABLETOP_PAIR  Handles of the scripts to run.
if isfield(agent, 'init')
    initFunc = agent.init;
    callbackFunc = agent.callback;
    source = '';
else
    [initFunc, callbackFunc] = agentBehavior;
    source = ', which agentBehavior.m names';
end
initFunc = tabletop_handle('init', initFunc, agent.folder, source);
callbackFunc = tabletop_handle('callback', callbackFunc, agent.folder, source);
end

function script = tabletop_handle(what, script, folder, source)
if ischar(script) && ~isempty(script), script = str2func(script); end
if ~isa(script, 'function_handle')
    error('tabletop:agent', 'agentBehavior: %s is %dx%d %s; it must be a function handle', ...
        what, size(script, 1), size(script, 2), class(script));
end
about = functions(script);
if strcmp(about.type, 'simple') && ~any(about.function == '.') && ~exist(about.function)
    error('tabletop:agent', 'there is no %s.m in %s%s', about.function, folder, source);
end
end
