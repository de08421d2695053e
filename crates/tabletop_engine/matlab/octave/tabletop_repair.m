function repaired = tabletop_repair(message, folder)
% TABLETOP_REPAIR  MATLAB leaves a script at a "break" outside a loop; Octave refuses to read such a script.
%   If that is what MESSAGE says, a copy of the script with "return" there is found first from now on.
repaired = false;
found = regexp(message, 'near line (\d+) of file ([^\n]+)\s+break must appear', 'tokens', 'once');
if isempty(found), return; end
number = str2double(found{1});
file = found{2};
lines = regexp(fileread(file), '\n', 'split');
line = regexprep(lines{number}, '\<break\>', 'return', 'once');
if strcmp(line, lines{number}), return; end
lines{number} = line;
copies = [folder 'repaired' filesep];
if ~exist(copies, 'dir'), mkdir(copies); end
[home, name] = fileparts(file);
fid = fopen([copies name '.m'], 'w');
fprintf(fid, '%s', strjoin(lines, "\n"));
fclose(fid);
addpath(copies);
rehash;
fprintf('%s.m:%d: Octave knows no "break" outside a loop; "return" is used instead\n', name, number);
repaired = true;
end
