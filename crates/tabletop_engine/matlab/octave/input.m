function varargout = input(varargin) %#ok<STOUT>
% INPUT  There is nobody to answer while the simulator runs the script.
error('tabletop:input', 'input() cannot be used here: the simulator runs this script, nobody can answer');
end
