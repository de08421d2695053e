function root = tabletop_get(file)
% TABLETOP_GET  Read named arrays; dots in their names become nested structs.
persistent known plan                              % the last header and what it means: it seldom changes
fid = fopen(file, 'r');
if fid < 0, error('tabletop:file', 'cannot open %s', file); end
bytes = fread(fid, [1 Inf], '*uint8');
fclose(fid);
extent = numel(known);
if extent == 0 || numel(bytes) < extent || any(bytes(1:extent) ~= known)
    [known, plan] = read_header(bytes, file);
end
codes = plan.codes;
starts = plan.starts;
ends = plan.ends;
dims = plan.dims;
values = cell(1, numel(codes));
for k = plan.numbers
    values{k} = reshape(typecast(bytes(starts(k):ends(k)), 'double'), dims{k});
end
for k = plan.others
    data = bytes(starts(k):ends(k));
    switch codes(k)
        case 1
            values{k} = reshape(data, dims{k});
        case 2
            values{k} = tabletop_text(data);
        case 3
            values{k} = reshape(data ~= 0, dims{k});
        case 4
            values{k} = reshape(double(data) / 255, dims{k});
        case 5
            values{k} = named_points(data, prod(dims{k}));
        case 6
            values{k} = texts(data, prod(dims{k}));
        otherwise                                  % 8: no numbers
            values{k} = zeros(dims{k});
    end
end
root = plan.empty;
if ~isempty(plan.name)
    root.(plan.name) = cell2struct(values, plan.fields, 2);
    return
end
paths = plan.paths;
for k = 1:numel(codes)
    path = paths{k};
    switch numel(path)
        case 1
            root.(path{1}) = values{k};
        case 2
            root.(path{1}).(path{2}) = values{k};
        otherwise
            root.(path{1}).(path{2}).(path{3}) = values{k};
    end
end
end

function [header, plan] = read_header(bytes, file)
words = double(typecast(bytes(1:16), 'uint32'));
count = words(3);
if words(1) ~= 826365012 || words(2) ~= 1 || count < 1
    error('tabletop:version', '%s is not of the version that this driver reads', file);
end
head = reshape(double(typecast(bytes(17:16 + 48 * count), 'uint32')), 12, count);
header_end = 16 + 48 * count + 8 * ceil(words(4) / 8);
header = bytes(1:header_end);
names = char(bytes(17 + 48 * count:16 + 48 * count + words(4)));
name_ends = cumsum(head(2, :));
space = 8 * ceil(head(3, :) / 8);
starts = header_end + cumsum(space) - space + 1;
dims = cell(1, count);
paths = cell(1, count);
for k = 1:count
    dims{k} = head(5:4 + head(4, k), k)';
    name = names(name_ends(k) - head(2, k) + 1:name_ends(k));
    dots = [0, find(name == '.'), numel(name) + 1];
    path = cell(1, numel(dots) - 1);
    for j = 1:numel(path), path{j} = name(dots(j) + 1:dots(j + 1) - 1); end
    paths{k} = path;
end
codes = head(1, :);
if any(codes > 6), error('tabletop:class', 'there is an unknown class in %s', file); end
codes(codes == 0 & head(3, :) == 0) = 8;
plan = struct('codes', codes, 'starts', starts, 'ends', starts + head(3, :) - 1);
plan.numbers = find(codes == 0);
plan.others = find(codes ~= 0);
plan.dims = dims;
plan.paths = paths;
plan.empty = struct();
% Most often all are fields of one struct, which is made at once.
plan.name = '';
plan.fields = {};
if all(cellfun('length', paths) == 2)
    parts = vertcat(paths{:});
    if all(strcmp(parts(:, 1), parts{1})), plan.name = parts{1}; plan.fields = parts(:, 2)'; end
end
end

function list = texts(data, count)
list = cell(1, count);
if count == 0, return; end
lengths = double(typecast(data(1:4 * count), 'uint32'));
from = 4 * count + 1;
for k = 1:count
    list{k} = tabletop_text(data(from:from + lengths(k) - 1));
    from = from + lengths(k);
end
end

function map = named_points(data, count)
names = texts(data(24 * count + 1:end), count);
xyz = zeros(count, 3);
if count > 0, xyz = reshape(typecast(data(1:24 * count), 'double'), 3, count)'; end
if exist('OCTAVE_VERSION', 'builtin') || exist('containers.Map', 'class')
    map = containers.Map('KeyType', 'char', 'ValueType', 'any');
    if count > 0, map = containers.Map(names, mat2cell(xyz, ones(1, count), 3)'); end
else                                               % before R2008b: a struct, with _ for what no name may hold
    map = struct();
    for k = 1:count, map.(strrep(names{k}, '-', '_')) = xyz(k, :); end
end
end
