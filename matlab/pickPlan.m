function plan = pickPlan()
% PICKPLAN  How the right arm puts the red block of tablesetup/robot-stack.xml on the green one.
%   A row is a posture to go to (S0 S1 E0 E1 W0 W1 W2, in rad), then what the gripper does there
%   (units per second; negative closes) and for how long (seconds). "tabletop robot ik" tells the postures.
over1 = [-0.2105 -0.0802 1.5725 1.8601 -1.4935 1.5495 0.8634];      % hand at (3,-3,3), fingers down
near1 = [-0.1897  0.0480 1.3700 1.8270 -1.6695 1.3892 0.8657];      % 1.8 above the table
at1   = [-0.1601  0.1519 1.2336 1.7365 -1.7852 1.2686 0.8496];      % 0.9
over2 = [ 0.3987 -0.1598 1.6338 1.6401 -1.4068 1.6218 1.2627];      % (0,-3,3.6)
near2 = [ 0.4050 -0.0510 1.4901 1.6601 -1.5270 1.4860 1.2758];      % 2.6
at2   = [ 0.4188  0.0243 1.3947 1.6351 -1.6069 1.3967 1.2738];      % 1.93
home  = [-0.25 0 1.527 2.618 -1.529 1.5 0];                          % where the arm is in the beginning
plan = [
    over1,  1, 0
    near1,  0, 0
    at1,   -1, 1.8
    near1,  0, 0
    over1,  0, 0
    over2,  0, 0
    near2,  0, 0
    at2,    1, 1.5
    near2,  0, 0
    over2,  0, 0
    over1,  0, 0
    home,   0, 0];
end
