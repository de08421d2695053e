function varargout = which(varargin)
% WHICH  As ever, but of a script that was repaired the script instead of the copy.
here = fileparts(builtin('mfilename', 'fullpath'));
session = fileparts(fileparts(here));
copies = fullfile(session, 'repaired');
given = cellfun(@(name) ["'" strrep(name, "'", "''") "', "], varargin, 'UniformOutput', false);
rmpath(here);
back = onCleanup(@() addpath(here));
if nargout
    varargout{1} = evalin('caller', ["which(" [given{:}](1:end - 2) ");"]);
else
    varargout{1} = evalin('caller', ["evalc(\"which(" [given{:}](1:end - 2) ");\");"]);
end
clear back
original = '';
if exist(fullfile(copies, 'original'), 'file'), original = fileread(fullfile(copies, 'original')); end
if ~isempty(original), varargout{1} = strrep(varargout{1}, copies, original); end
if ~nargout
    fputs(stdout, varargout{1});
    varargout = {};
end
end
