% Maps from names to values, functions and places on the arms.
actions = containers.Map();
actions('rest') = @(m) zeros(2, 7);
actions('wave') = @(m) ones(2, 7) * 0.25;
colours = containers.Map({'red', 'green'}, {[1 0 0], [0 1 0]});
names = {};
