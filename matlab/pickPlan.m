function plan = pickPlan()
% PICKPLAN  How the right arm takes a unit cube from (5,-2) on the table to (2,-3).
%   A row is a posture to go to (S0 S1 E0 E1 W0 W1 W2, in rad), then what the gripper does there
%   (units per second; negative closes) and for how long (seconds).
over1 = [-0.2648 -0.0401 1.5779 1.3213 -1.5337 1.5875 -1.2992];
at1 = [-0.2118 0.2120 1.3670 1.1757 -1.6935 1.3040 -1.3540];
over2 = [-0.0225 -0.0598 1.5845 1.8549 -1.5096 1.5672 -0.5235];
at2 = [0.0219 0.1719 1.2485 1.7301 -1.8004 1.2860 -0.5431];
home = [-0.25 0 1.527 2.618 -1.529 1.5 0];
plan = [
    over1, 1, 0
    at1, -1, 1.8
    over1, 0, 0
    over2, 0, 0
    at2, 1, 1.5
    over2, 0, 0
    home, 0, 0];
end
