% BABBLEINIT  The robot learns by babbling which angles of its right S0 and E1 bring its hand where.
%   It moves at random, watches its hand, and fits radial basis functions from X and Y to both angles.
%   What it has learnt goes to babble.mat. Then it reaches for the markers. See babbleCallback.

aux.initJointAngles = zeros(2, 7);
aux.initJointAngles(2, 3) = pi / 2;      % so that S0 and E1 turn the hand in a horizontal plane
targets = [10 -0.5; 8.5 0.5; 6 1.5; 3 1.8];        % X Y in units of 10 cm
aux.drawMarkers = [targets, 6 * ones(size(targets, 1), 1)];

babbleTime = 60;                         % seconds of simulation
babbleSpeed = 2.5;                       % rad/s
range = [-0.7 0.9; 0.1 1.6];             % of S0 and E1 while babbling, in rad
goal = mean(range, 2)';
spread = 0.6;                            % width of a unit, in units of 10 cm
rate = 0.3;                              % how fast a unit learns
centres = zeros(0, 2);                   % where the units are
weights = zeros(0, 2);                   % the angles that they stand for
times = [];                              % when errors were noted
errors = [];                             % and how large they were, in rad
elapsed = 0;
stage = 'babble';
target = 0;
misses = [];                             % distances from the targets in the end
rand('state', 1);                        % the same babbling every time
