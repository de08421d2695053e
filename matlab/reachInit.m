% REACHINIT  The right hand reaches for the markers, one after the other, without knowing its arm: see reachCallback.

targets = [5 0 4; 3 -3 2; 6 -3 5; 2 -2 6];   % X Y Z in units of 10 cm
aux.drawMarkers = targets;
aux.initJointAngles = zeros(2, 7);
aux.initJointAngles(2, :) = [0 0 1.5 1.5 -1.5 1 0];

reachSpeed = 4;                          % units per second, at most
turnSpeed = 2;                           % rad/s, at most
closeEnough = 0.1;                       % units
target = 1;
jacobian = zeros(3, 7);                  % how the hand moves with each joint: not known yet
tried = 0;                               % joints that have been tried out
elapsed = 0;
reachTimes = [];
