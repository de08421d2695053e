function tabletop_path(driver)
% TABLETOP_PATH  Put the folders of the driver on the path.
octave = exist('OCTAVE_VERSION', 'builtin');
if octave && ~exist('fileparts', 'file'), restoredefaultpath; end
addpath(driver);
if ~octave, return; end
addpath([driver 'octave']);
% Where Octave has no means to draw, what draws does nothing.
if isempty(available_graphics_toolkits()), addpath([driver 'undrawn']); end
end
