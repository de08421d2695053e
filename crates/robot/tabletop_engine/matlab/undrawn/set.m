function varargout = set(h, varargin)
% SET  Nothing, but for the root.
varargout = cell(1, nargout);
if isequal(h, 0), [varargout{:}] = builtin('set', h, varargin{:}); end
end
