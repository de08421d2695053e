function source(file, varargin)
% SOURCE  As ever, but of a script that was repaired the copy. RUN comes here as well.
session = fileparts(fileparts(fileparts(mfilename('fullpath'))));
copies = fullfile(session, 'repaired');
[folder, name, extension] = fileparts(canonicalize_file_name(file));
copy = fullfile(copies, [name extension '.sourced']);
if exist(copy, 'file') && strcmp(folder, fileread(fullfile(copies, 'original'))), file = copy; end
given = cellfun(@(text) [", '" strrep(text, "'", "''") "'"], [{file}, varargin], 'UniformOutput', false);
evalin('caller', ["builtin('source'" given{:} ");"]);
end
