function [total, count] = arraysSum(varargin)
total = 0;
count = nargin;
if count == 0, return; end
for k = 1:count, total = total + varargin{k}; end
end
