function tabletop_relink
% TABLETOP_RELINK  Undo what "clear" in a script has done: sensor, motor and aux of the base workspace
%   are the shared globals again, and callbackFunc is there.
linked = 'isglobal(''sensor'') && isglobal(''motor'') && isglobal(''aux'') && exist(''callbackFunc'', ''var'')';
if evalin('base', linked), return; end
kept = tabletop_keep();
names = {'motor', 'aux'};
for k = 1:2
    name = names{k};
    if evalin('base', ['exist(''' name ''', ''var'')'])
        value = evalin('base', name);              % set after "clear"
    else
        value = tabletop_global(name);             % set before "clear"
        if ~isstruct(value), value = kept.(name); end  % "clear all"
    end
    tabletop_global(name, value);
end
evalin('base', 'clear sensor motor aux; global sensor motor aux');
if ~evalin('base', 'exist(''callbackFunc'', ''var'')')
    assignin('base', 'callbackFunc', kept.callbackFunc);
end
end
