count = count + 1;
motor.jointVelocities = 0.3 * sin(count / 10 + (0:6)' * [1 1])' - 0.1 * sensor.jointAngles;
motor.gripperVelocities(1) = -0.5;
if count == 120, aux.exit = 1; end
