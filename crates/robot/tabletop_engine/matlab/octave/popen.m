function fid = popen(command, mode)
% POPEN  What it starts must not read what the simulator tells Octave.
if ischar(command) && strcmp(mode, 'r') && ~ispc(), command = ["exec </dev/null\n" command]; end
fid = builtin('popen', command, mode);
end
