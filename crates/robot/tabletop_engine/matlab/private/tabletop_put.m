function tabletop_put(file, names, values)
% TABLETOP_PUT  Write named arrays.
count = numel(names);
head = zeros(12, count);
data = cell(1, count);
for k = 1:count
    value = values{k};
    if isa(value, 'double') && isreal(value) && ~issparse(value) && ~isempty(value) && numel(value) <= 3e5
        class_code = 0;
        bytes = typecast(value(:)', 'uint8');
        extent = numel(bytes);
    else
        [class_code, bytes] = elements(value);
        extent = numel(bytes);
        bytes = [bytes, zeros(1, mod(-extent, 8), 'uint8')]; %#ok<AGROW>
    end
    dims = size(value);
    if numel(dims) > 8, dims = [dims(1:7), prod(dims(8:end))]; end
    head(1:4 + numel(dims), k) = [class_code; numel(names{k}); extent; numel(dims); dims'];
    data{k} = bytes;
end
text = [names{:}];
start = [826365012; 1; count; numel(text); head(:)]';
text = [uint8(text), zeros(1, mod(-numel(text), 8), 'uint8')];
fid = fopen(file, 'w');
if fid < 0, error('tabletop:file', 'cannot write %s', file); end
fwrite(fid, [typecast(uint32(start), 'uint8'), text, data{:}], 'uint8');
fclose(fid);
end

function [class_code, bytes] = elements(value)
if isnumeric(value) && ~isreal(value) && ~any(imag(value(:))), value = real(value); end
if ischar(value), value = value(1:min(end, 3e5)); end
if numel(value) > 3e5                              % nobody wants that much: its size and class will do
    class_code = 7;
    bytes = uint8(class(value));
elseif isnumeric(value) && isreal(value)
    class_code = 0;
    bytes = zeros(1, 0, 'uint8');
    if ~isempty(value), bytes = typecast(double(full(value(:)))', 'uint8'); end
elseif ischar(value)
    class_code = 2;
    bytes = value(:)';
    if any(bytes > 127) && ~exist('OCTAVE_VERSION', 'builtin'), bytes = unicode2native(bytes, 'UTF-8'); end
    bytes = uint8(bytes);
elseif islogical(value)
    class_code = 3;
    bytes = uint8(full(value(:)))';
else
    class_code = 7;
    if isnumeric(value), bytes = uint8('complex'); else bytes = uint8(class(value)); end
end
end
