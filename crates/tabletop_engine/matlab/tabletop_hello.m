function [names, values] = tabletop_hello(display)
% TABLETOP_HELLO  Prepare the engine and say which one it is.
if exist('OCTAVE_VERSION', 'builtin')
    engine = ['GNU Octave ' OCTAVE_VERSION];
    % Octave reads its own commands where a script would read answers.
    before = warning('off', 'Octave:shadowed-function');
    driver = fileparts(mfilename('fullpath'));
    addpath(fullfile(driver, 'octave'));
    % Where Octave has no means to draw, what draws does nothing.
    if isempty(available_graphics_toolkits()), addpath(fullfile(driver, 'undrawn')); end
    warning(before);
    struct_levels_to_print(0);                     % sizes instead of pages of numbers, as in MATLAB
else
    engine = ['MATLAB ' version];
end
if ~display, set(0, 'DefaultFigureVisible', 'off'); end
names = {'engine'};
values = {engine};
end
