function varargout = axis(varargin)
% AXIS  The limits that are given, or those of empty axes.
limits = [0 1 0 1];
if nargin > 0 && isnumeric(varargin{end}) && numel(varargin{end}) > 1, limits = varargin{end}; end
if nargin == 0 || nargout > 0, varargout{1} = limits; end
end
