% The same as globalsInit, as a script.
count = 0;
aux.initJointAngles = ones(2, 7) * 0.1;
