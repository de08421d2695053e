% PICKINIT  Pick and place by a plan of postures: see pickPlan. Load tablesetup/robot-stack.xml and show the robot first.

plan = pickPlan();
step = 1;
gripped = 0;                             % seconds that the gripper has worked in this step
pickSpeed = 0.8;                         % rad/s, of the joint that has the longest way
aux.drawMarkers = [3 -3 0; 0 -3 1];      % from here to there
