% Variables that grow, as scripts of 2014 let them.
clear tasks
duration = 2; Nbt = 0;
history = []; log = {};
tasks(2).name = 'second';
tasks(1).name = 'first'; tasks(1).args = {1, [2 3], 'four'};
plan.steps{3} = @(x, y) x + y;
plan.deep.er(2).value = 7;
Theta = zeros(2, 0);
aux.drawMarkers(2, 3) = 5;
aux.note = 'mine';
