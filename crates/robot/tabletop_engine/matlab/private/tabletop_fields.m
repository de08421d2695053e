function [names, values] = tabletop_fields(name, value, wanted)
% TABLETOP_FIELDS  The fields of a struct by their full names: all, or the WANTED ones.
if ~isstruct(value) || numel(value) ~= 1
    names = {name};
    values = {value};
    return
end
names = fieldnames(value)';
values = struct2cell(value)';
if nargin > 2
    keep = ismember(names, wanted);
    names = names(keep);
    values = values(keep);
end
for k = 1:numel(names)
    names{k} = [name '.' names{k}];
end
end
