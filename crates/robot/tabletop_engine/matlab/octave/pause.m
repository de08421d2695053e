function pause(varargin)
% PAUSE  Time passes as ever; a key never comes, because the simulator runs the script.
if nargin == 0 || isequal(varargin{1}, Inf)
    error('tabletop:input', 'pause without a time cannot be used here: the simulator runs this script, nobody can type');
end
builtin('pause', varargin{:});
end
