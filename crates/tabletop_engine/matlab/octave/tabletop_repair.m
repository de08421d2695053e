function tabletop_repair(scripts, folder)
% TABLETOP_REPAIR  MATLAB leaves a script at a "break" outside a loop; Octave refuses to read such a script.
%   Copies of those in the folder SCRIPTS, with "return" there, are found first from now on.
copies = [folder 'repaired'];
if ~isfolder(copies), mkdir(copies); end
for old = dir(fullfile(copies, '*.m'))', unlink(fullfile(copies, old.name)); end
addpath(copies);
dir_encoding(copies, dir_encoding(canonicalize_file_name(scripts)));
for file = dir(fullfile(scripts, '*.m'))'
    text = fileread(fullfile(scripts, file.name));
    if isempty(strfind(text, 'break')), continue; end
    [~, name] = fileparts(file.name);
    do
        [text, number] = repaired(text, name);
        if number > 0
            fid = fopen(fullfile(copies, file.name), 'w');
            fputs(fid, text);
            fclose(fid);
            rehash;
            note = "%s:%d: Octave knows no \"break\" outside a loop; \"return\" is used instead\n";
            printf(note, file.name, number);
        end
    until number == 0
end
end

function [text, number] = repaired(text, name)
% The TEXT of a script with the first such "break" replaced, and the number of its line; 0 if there is none.
number = 0;
try
    str2func(name);                                % reads the file
catch err
    message = err.message;
    message(message > 127) = '?';
    found = regexp(message, 'near line (\d+) of file .*\n\s*break must appear[^\n]*\s+>>> [^\n]*\n( *)\^', 'tokens', 'once');
    if isempty(found), return; end
    number = str2double(found{1});
    lines = ostrsplit(text, "\n");
    line = lines{number};
    places = strfind(line, 'break');
    last_letter = numel(found{2}) + 1 - numel('>>> ');
    [~, nearest] = min(abs(places + numel('break') - 1 - last_letter));
    place = places(nearest);
    lines{number} = [line(1:place - 1) 'return' line(place + numel('break'):end)];
    text = strjoin(lines, "\n");
end
end
