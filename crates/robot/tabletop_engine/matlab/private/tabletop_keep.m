function value = tabletop_keep(value)
% TABLETOP_KEEP  What shall survive "clear all": set (1 argument) or read (none).
persistent kept
mlock;
if nargin, kept = value; end
value = kept;
end
