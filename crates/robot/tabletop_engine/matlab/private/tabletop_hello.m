function [names, values] = tabletop_hello(display)
% TABLETOP_HELLO  Prepare the engine and say which one it is.
if exist('OCTAVE_VERSION', 'builtin')
    engine = ['GNU Octave ' OCTAVE_VERSION];
    % Nobody can answer a debugger.
    debug_on_error(false);
    debug_on_warning(false);
    % An engine that is killed leaves no file behind.
    crash_dumps_octave_core(false);
    sighup_dumps_octave_core(false);
    sigterm_dumps_octave_core(false);
else
    engine = ['MATLAB ' version];
end
if ~display, set(0, 'DefaultFigureVisible', 'off'); end
names = {'engine'};
values = {engine};
end
