function name = mfilename(varargin)
% MFILENAME  As ever, but in a copy of a script that was repaired that of the script.
given = cellfun(@(what) [", '" what "'"], varargin, 'UniformOutput', false);
name = evalin('caller', ["builtin('mfilename'" given{:} ");"]);
file = evalin('caller', "builtin('mfilename', 'fullpathext');");
session = fileparts(fileparts(fileparts(builtin('mfilename', 'fullpath'))));
copies = [session filesep 'repaired' filesep];
if ~strncmp(file, copies, numel(copies)), return; end
name = strtok(file(numel(copies) + 1:end), '.');
script = [fileread([copies 'original']) filesep name];
switch [varargin{:}]
    case 'fullpath', name = script;
    case 'fullpathext', name = [script '.m'];
end
end
