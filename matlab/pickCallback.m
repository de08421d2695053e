% PICKCALLBACK  Goes to the next posture of the plan, all joints in step, then lets the gripper do its part.

way = plan(step, 1:7) - sensor.jointAngles(2, :);
motor.jointVelocities = zeros(2, 7);
motor.gripperVelocities = [0; 0];

if max(abs(way)) > 0.01
    velocity = 5 * way;
    motor.jointVelocities(2, :) = velocity * min(1, pickSpeed / max(abs(velocity)));
elseif gripped < plan(step, 9)
    gripped = gripped + sensor.timeElapsed;
    motor.gripperVelocities(2) = plan(step, 8);
elseif step < size(plan, 1)
    step = step + 1;
    gripped = 0;
else
    disp('done');
    aux.exit = true;
end
