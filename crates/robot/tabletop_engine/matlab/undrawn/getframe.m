function frame = getframe(varargin)
% GETFRAME  A black picture.
frame = struct('cdata', zeros(420, 560, 3, 'uint8'), 'colormap', []);
end
