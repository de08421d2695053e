weights(:, :, 2) = [1 2 3; 4 5 6];
slice = squeeze(weights(1, :, 1:2));
turned = permute(weights, [3 1 2]);
stack = cat(3, z, z');
many = repmat(z, [1 1 4]);
near = bsxfun(@le, X, Y + 1);
sums = sum(many(:)) + sum(sum(z, 2));
lower = tril(ones(3)); s = sparse([1 2], [1 2], [3 4]);
[~, place] = min([4 2 8]);
LR = 'LR'; side = find(LR == 'R');
values = [1 NaN Inf -2];
ok = isequal(size(turned), [25 2 3]) && isequal(slice(:, 2)', [1 2 3]) && sums == 50 && place == 2 && side == 2 ...
    && full(s(2, 2)) == 4 && sum(isnan(values)) == 1 && any(near(:)) && isequal(stack(:, :, 2), [1 3; 2 4]) ...
    && islogical(near) && mod(-1, 5) == 4 && isequal(z(:, end)', [2 4]) && lower(1, 3) == 0 && norm([3 4]) == 5;
if ~ok, error('arrays:result', 'something is different'); end
z(z > 2) = 0;
z(:) = 1:4;
z = z';
motor.jointVelocities(:) = linspace(0, 1, 14);
x = arraysSum(1, 2, 3);
if arraysSum() ~= 0 || x ~= 6, error('arrays:varargin', 'wrong'); end
picture = sensor.rgbVision;
if ~isequal(size(picture), [3 4 3]) || max(picture(:)) > 1, error('arrays:picture', 'wrong'); end
gray = mean(picture, 3) * 0.5 + 0.1;
aux.exit = 0;
