function tabletop_relink
% TABLETOP_RELINK  Undo what "clear" in a script has done: sensor, motor and aux of the base workspace
%   are the shared globals again, and callbackFunc is there.
%   By BUILTIN, because the scripts may have variables of any name.
if exist('OCTAVE_VERSION', 'builtin')
    linked = 'builtin(''isglobal'', ''sensor'') && builtin(''isglobal'', ''motor'') && builtin(''isglobal'', ''aux'')';
else                                               % whose ISGLOBAL takes no names; this is slower in Octave
    linked = ['builtin(''sum'', builtin(''arrayfun'', @(v) v.global, ' ...
        'builtin(''whos'', ''sensor'', ''motor'', ''aux''))) == 3'];
end
linked = [linked ' && builtin(''exist'', ''callbackFunc'', ''var'') && ' ...
    'builtin(''isa'', callbackFunc, ''function_handle'') && builtin(''isstruct'', sensor)'];
try                                                % an expression would set "ans"
    evalin('base', ['if ~(' linked '), builtin(''error'', ''unlinked''); end']);
    return
catch
end
kept = tabletop_keep();
all_cleared = ~isstruct(tabletop_global('sensor'));
names = {'motor', 'aux'};
for k = 1:2
    name = names{k};
    if evalin('base', ['builtin(''exist'', ''' name ''', ''var'')'])
        value = evalin('base', name);              % set after "clear"
        is_lost = all_cleared && isempty(value);   % "clear all; global motor"
    else
        value = tabletop_global(name);             % set before "clear"
        is_lost = ~isstruct(value);                % "clear all"
    end
    if is_lost, value = kept.(name); end
    if k == 1, value = tabletop_complete(value, kept.motor); end
    tabletop_global(name, value);
end
evalin('base', 'clear sensor motor aux; global sensor motor aux');
if ~evalin('base', 'builtin(''exist'', ''callbackFunc'', ''var'')')
    assignin('base', 'callbackFunc', kept.callbackFunc);
end
callback = evalin('base', 'callbackFunc');
if ~isa(callback, 'function_handle')
    error('tabletop:agent', 'callbackFunc is %dx%d %s; it is the handle of the callback script, choose another name', ...
        size(callback, 1), size(callback, 2), class(callback));
end
end

function motor = tabletop_complete(motor, template)
% A motor that was begun anew, as if that had been done in the TEMPLATE: what it lacks is at rest.
if ~isstruct(motor) || numel(motor) ~= 1, return; end
names = fieldnames(template);
for k = 1:numel(names)
    whole = template.(names{k});
    if isfield(motor, names{k})
        part = motor.(names{k});
        [rows, columns] = size(part);
        larger = rows > size(whole, 1) || columns > size(whole, 2);
        if isempty(part) || ~isnumeric(part) || ndims(part) > 2 || larger, continue; end
        whole(1:rows, 1:columns) = part;
    end
    motor.(names{k}) = whole;
end
end
