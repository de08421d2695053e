function frame = getframe(varargin)
% GETFRAME  A picture of nothing.
frame = struct('cdata', zeros(0, 0, 3, 'uint8'), 'colormap', []);
end
