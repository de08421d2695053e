function keyboard(varargin)
% KEYBOARD  There is nobody to type while the simulator runs the script.
error('tabletop:input', 'keyboard cannot be used here: the simulator runs this script, nobody can type');
end
