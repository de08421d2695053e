function varargout = load(varargin)
% LOAD  As ever. Says, once for a file, which of its variables are objects of MATLAB classes: Octave makes structs without sense of them.
persistent told = {};
if nargout > 0 || ~iscellstr(varargin)
    [varargout{1:nargout}] = builtin('load', varargin{:});
else
    given = cellfun(@(text) [", '" strrep(text, "'", "''") "'"], varargin, 'UniformOutput', false);
    evalin('caller', ["builtin('load'" given{:} ");"]);
end
if ~iscellstr(varargin), return; end
files = varargin(~strncmp(varargin, '-', 1));
if isempty(files) || any(strcmp(told, files{1})), return; end
names = objects(files{1});
if isempty(names), return; end
told{end + 1} = files{1};
warning('off', 'backtrace', 'local');
warning('tabletop:objects', ['%s: Octave cannot read objects of MATLAB classes: %s. ' ...
    'In MATLAB, save what you need of them as numbers, texts and structs.'], files{1}, strjoin(names, ', '));
end

function names = objects(file)
% The variables of a file that are objects, with their classes.
names = {};
if ~exist(file, 'file'), file = [file '.mat']; end
stream = fopen(file, 'r');
if stream < 0, return; end
header = fread(stream, [1 124], 'uint8');
fclose(stream);
% MATLAB writes where the properties of objects are at the end of the text; else there are spaces or zeros.
if numel(header) < 124 || ~strncmp(char(header), 'MATLAB 5.0', 10) || all(header(117:124) == 0 | header(117:124) == 32), return; end
contents = builtin('load', file);
for [value, name] = contents
    if isstruct(value) && isfield(value, 'MCOS'), names{end + 1} = [name ' (' fieldnames(value){end} ')']; end
end
end
