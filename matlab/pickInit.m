% PICKINIT  Pick and place by a plan of postures: see pickPlan.

plan = pickPlan();
step = 1;
gripped = 0;                             % seconds that the gripper has worked in this step
pickSpeed = 0.8;                         % rad/s, of the joint that has the longest way
aux.initJointAngles = zeros(2, 7);
aux.initJointAngles(2, :) = plan(end, 1:7);
aux.initJointAngles(1, :) = [0.25 0 -1.527 2.618 1.529 1.5 0];
aux.drawMarkers = [5 -2 0; 2 -3 0];
