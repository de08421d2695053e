function yes = ishghandle(h, varargin)
% ISHGHANDLE  Of numbers, yes: what draws gives 1 for what it has not drawn.
yes = repmat(isnumeric(h), size(h));
end
