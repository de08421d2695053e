function value = tabletop_global(name, value)
% TABLETOP_GLOBAL  Read (1 argument) or set (2 arguments) one of the structs shared with the scripts.
%   A function of its own, because "clear all" in a script unlinks the globals of running functions.
global sensor motor aux
if nargin > 1
    switch name
        case 'sensor', sensor = value;
        case 'motor', motor = value;
        case 'aux', aux = value;
    end
else
    switch name
        case 'sensor', value = sensor;
        case 'motor', value = motor;
        case 'aux', value = aux;
    end
end
end
