% Arrays of several dimensions, and the functions that scripts use on them.
weights = zeros(2, 3, 25);
z = [1 2; 3 4];
[X, Y] = ndgrid(1:3, 0:0.5:1);
