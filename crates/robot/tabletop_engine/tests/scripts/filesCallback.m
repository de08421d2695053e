calls = calls + 1;
fprintf(fid, '%d\n', calls);
seven = load([aux.path 'saved7.mat']);
six = load([aux.path 'saved6.mat'], 'given');
if ~strcmp(seven.values.name, 'a') || seven.values.list{2} ~= 2, error('files:seven', 'wrong'); end
motor.jointVelocities(1, 1:3) = six.given(2, :) + given(1, :);
if calls == 2
    fclose(fid);
    imwrite(repmat(reshape([1 0 0], 1, 1, 3), 4, 5), [aux.path 'red.png']);
    red = imread([aux.path 'red.png']);
    if ~isequal(size(red), [4 5 3]) || red(1, 1, 1) ~= intmax(class(red)), error('files:picture', 'wrong'); end
    delete([aux.path '*.png']);
    aux.exit = 'done';
end
