function varargout = system(command, varargin)
% SYSTEM  What it starts must not read what the simulator tells Octave.
if ischar(command) && ~ispc(), command = ["exec </dev/null\n" command]; end
[varargout{1:max(nargout, 1)}] = builtin('system', command, varargin{:});
end
