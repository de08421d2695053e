function text = disp(value)
% DISP  A struct as MATLAB shows it: numbers and texts with their values, of all else the size.
names = fieldnames(value);
shown = '';
if ~isscalar(value), shown = sprintf("    %s array with fields:\n", extent(value)); end
for k = 1:numel(names)
    line = names{k};
    if isscalar(value), line = [line ': ' summary(value.(line))]; end
    shown = [shown sprintf("    %s\n", line)];
end
if nargout, text = shown; else fputs(stdout, shown); end
end

function text = summary(value)
if ischar(value) && rows(value) < 2 && columns(value) < 200
    text = ["'" value "'"];
elseif isscalar(value) && (isnumeric(value) || islogical(value) || is_function_handle(value))
    if issparse(value), value = full(value); end
    text = strtrim(disp(value));
elseif isrow(value) && (isnumeric(value) || islogical(value)) && numel(value) <= 10 && ~isempty(value)
    text = mat2str(double(value), 5);
else
    text = ['[' extent(value) ']'];
end
end

function text = extent(value)
text = [strjoin(arrayfun(@(n) sprintf('%d', n), size(value), 'UniformOutput', false), 'x') ' ' class(value)];
end
