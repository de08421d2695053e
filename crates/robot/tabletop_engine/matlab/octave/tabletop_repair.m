function used = tabletop_repair(scripts, folder)
% TABLETOP_REPAIR  MATLAB leaves a script at a "break" outside a loop; Octave refuses to read such a script.
%   Copies of those in the folder SCRIPTS, with "return" there, are found first from now on.  Returns the folder of the copies,
%   empty if there are none.
used = '';
if is_same_file(pwd(), scripts), return; end       % where the originals are found before all copies
copies = [folder 'repaired'];
if ~isfolder(copies), mkdir(copies); end
for old = dir(fullfile(copies, '*.*'))', unlink(fullfile(copies, old.name)); end
original = canonicalize_file_name(scripts);
write(fullfile(copies, 'original'), original);
share_private(original, copies);
addpath(copies);
dir_encoding(copies, dir_encoding(original));
for file = dir(fullfile(scripts, '*.m'))'
    if file.isdir || file.name(1) == '.', continue; end
    try
        text = fileread(fullfile(scripts, file.name));
    catch
        continue                                   % Octave tells when it needs it
    end
    if isempty(strfind(text, 'break')), continue; end
    [~, name] = fileparts(file.name);
    do
        [text, number] = repaired(text, name);
        if number > 0
            write(fullfile(copies, file.name), text);
            % Octave would look for a file of that name first, which SOURCE does not want.
            write(fullfile(copies, [file.name '.sourced']), text);
            rehash;
            used = copies;
            note = "\001note %s:%d: Octave knows no \"break\" outside a loop; \"return\" is used instead\n";
            printf(note, file.name, number);
        end
    until number == 0
end
end

function share_private(original, copies)
% What is private to the scripts is private to their copies.
theirs = fullfile(original, 'private');
ours = fullfile(copies, 'private');
if ~isfolder(theirs) || isfolder(ours), return; end
if symlink(theirs, ours) ~= 0, copyfile(theirs, ours); end
end

function write(file, text)
fid = fopen(file, 'w');
fputs(fid, text);
fclose(fid);
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
    if isempty(places), number = 0; return; end
    last_letter = numel(found{2}) + 1 - numel('>>> ');
    [~, nearest] = min(abs(places + numel('break') - 1 - last_letter));
    place = places(nearest);
    lines{number} = [line(1:place - 1) 'return' line(place + numel('break'):end)];
    text = strjoin(lines, "\n");
end
end
