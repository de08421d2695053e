% EXAMPLEINIT  What an init script can do: look at aux, place the arms, show markers, prepare variables.

aux                                      % what there is to know about the robot

% The angles to begin with: rows are left and right, columns S0 S1 E0 E1 W0 W1 W2.
aux.initJointAngles = zeros(aux.numLimbs, aux.numJoints);
aux.initJointAngles(2, 3) = pi / 2;

% Blue spheres, one for each row of X Y Z.
aux.drawMarkers = [-6 0 3; 6 0 3; 0 -4 3; 0 4 3];

% Variables of this script are there in the callback script as well.
jointSpeed = 0.5;                        % rad/s
gripperSpeed = 1;                        % units (10 cm) per second
turn = 5;                                % seconds in a direction
elapsed = 0;
firstCall = true;
