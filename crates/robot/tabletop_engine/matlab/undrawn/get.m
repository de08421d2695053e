function value = get(h, varargin)
% GET  Of the root what it has, of what was not drawn what is plausible.
value = struct();
if isempty(h) || isequal(h, 0)
    value = builtin('get', h, varargin{:});
elseif nargin > 1
    value = plausible(lower(varargin{1}));
end
end

function value = plausible(property)
switch property
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
