function varargout = system(command, varargin)
% SYSTEM  What it starts must not read what the simulator tells Octave.  While it runs, Octave knows of no interrupt.
if ischar(command) && ~ispc(), command = ["exec </dev/null\ntrap 'exit 130' INT\n" command]; end
[varargout{1:max(nargout, 1)}] = builtin('system', command, varargin{:});
if varargout{1} == 130 && numel(varargin) < 2, error('tabletop:interrupt', 'system was interrupted'); end
end
