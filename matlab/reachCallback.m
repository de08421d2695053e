% REACHCALLBACK  Tries out each joint once, then goes to the targets by damped least squares and
%   corrects its idea of the arm with every move (Broyden's rule).

angles = sensor.jointAngles(2, :)';
hand = sensor.endEffPos(2, :)';
elapsed = elapsed + sensor.timeElapsed;
motor.jointVelocities = zeros(2, 7);

if elapsed > sensor.timeElapsed          % what the last move has done
    turned = angles - lastAngles;
    moved = hand - lastHand;
    if norm(turned) > 1e-5
        jacobian = jacobian + (moved - jacobian * turned) * turned' / (turned' * turned);
    end
end

if tried < 7
    tried = tried + 1;
    motor.jointVelocities(2, tried) = 0.5;
else
    way = targets(target, :)' - hand;
    if norm(way) < closeEnough
        disp(sprintf('target %d reached after %.1f s', target, elapsed));
        reachTimes(end + 1) = elapsed;
        if target == size(targets, 1), aux.exit = true; else target = target + 1; end
        way = targets(target, :)' - hand;
    end
    velocity = 3 * way;
    velocity = velocity * min(1, reachSpeed / max(norm(velocity), eps));
    % A joint at its limit cannot help: the others do its part.
    usable = true(7, 1);
    for attempt = 1:7
        part = jacobian;
        part(:, ~usable) = 0;
        turning = part' * ((part * part' + 0.5 * eye(3)) \ velocity);
        stuck = (angles >= aux.maxJointAngles(2, :)' - 1e-3 & turning > 0) ...
            | (angles <= aux.minJointAngles(2, :)' + 1e-3 & turning < 0);
        if ~any(stuck & usable), break; end
        usable(stuck) = false;
    end
    turning = turning * min(1, turnSpeed / max(max(abs(turning)), eps));
    motor.jointVelocities(2, :) = turning';
end
lastAngles = angles;
lastHand = hand;
