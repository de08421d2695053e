% EXAMPLECALLBACK  Turns all joints and moves both grippers, five seconds one way, five seconds back.

if mod(elapsed, 2 * turn) < turn, direction = 1; else direction = -1; end
motor.jointVelocities(:) = direction * jointSpeed;
motor.gripperVelocities = [-1; -1] * direction * gripperSpeed;
elapsed = elapsed + sensor.timeElapsed;

if firstCall                             % show everything once
    sensor
    motor
    aux
    firstCall = false;
end

% A picture is there only when it is new.
if any(strcmp('rgbVision', fieldnames(sensor)))
    showPicture(sensor.rgbVision);
end
