function value = get(h, varargin)
% GET  Of the root what it has, of what was not drawn what is plausible.
if isempty(h) || isequal(h, 0) || nargin < 2
    value = builtin('get', h(h == 0), varargin{:});
    return
end
switch lower(varargin{1})
    case {'position', 'outerposition', 'innerposition'}
        value = [0 0 560 420];
    case {'xlim', 'ylim', 'zlim', 'clim', 'alim'}
        value = [0 1];
    case {'xtick', 'ytick', 'ztick'}
        value = 0:0.2:1;
    case 'colormap'
        value = colormap();
    case 'cdata'
        value = getframe().cdata;
    case 'visible'
        value = 'on';
    case {'parent', 'currentaxes', 'title', 'xlabel', 'ylabel', 'zlabel'}
        value = 1;
    case {'type', 'tag', 'name', 'string', 'currentcharacter', 'currentkey'}
        value = '';
    otherwise
        value = [];
end
end
