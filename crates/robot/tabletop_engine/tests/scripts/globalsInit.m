function globalsInit
% A pair of functions instead of scripts: what they share is global.
global aux count
count = 0;
aux.initJointAngles = ones(2, 7) * 0.1;
end
