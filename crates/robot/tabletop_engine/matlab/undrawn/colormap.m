function varargout = colormap(varargin)
% COLORMAP  The one that is given, or the usual one.
map = viridis(64);
if nargin > 0 && isnumeric(varargin{end}) && columns(varargin{end}) == 3, map = varargin{end}; end
if nargin == 0 || nargout > 0, varargout{1} = map; end
end
