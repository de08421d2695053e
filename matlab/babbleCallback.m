% BABBLECALLBACK  Babbles and learns, then reaches for the markers with what it has learnt.

hand = sensor.endEffPos(2, 1:2);
angles = sensor.jointAngles(2, [1 4]);
elapsed = elapsed + sensor.timeElapsed;
motor.jointVelocities = zeros(2, 7);

switch stage
    case 'babble'
        [guess, activity] = babbleMap(hand, centres, weights, spread);
        times(end + 1) = elapsed;
        errors(end + 1) = norm(angles - guess);
        if isempty(activity) || min(sum((centres - repmat(hand, size(centres, 1), 1)) .^ 2, 2)) > spread ^ 2
            centres(end + 1, :) = hand;          % nobody knows this place: a new unit
            weights(end + 1, :) = angles;
        else
            weights = weights + rate * activity' * (angles - guess);
        end
        if max(abs(goal - angles)) < 0.05
            goal = range(:, 1)' + rand(1, 2) .* (range(:, 2) - range(:, 1))';
        end
        if elapsed > babbleTime
            save([aux.path 'babble.mat'], 'centres', 'weights', 'spread', 'times', 'errors');
            disp(sprintf('%d units; error %.3f rad in the first and %.3f rad in the last ten seconds', ...
                size(centres, 1), mean(errors(times < 10)), mean(errors(times > babbleTime - 10))));
            if strcmp(get(0, 'DefaultFigureVisible'), 'on')
                plot(times, errors);
                xlabel('time (s)');
                ylabel('error (rad)');
            end
            learnt = load([aux.path 'babble.mat']);
            stage = 'reach';
        end
    case 'reach'
        if target > 0 && max(abs(goal - angles)) < 0.005
            misses(target) = norm(hand - targets(target, :));
            disp(sprintf('target %d: %.2f units away', target, misses(target)));
        end
        if target == 0 || max(abs(goal - angles)) < 0.005
            target = target + 1;
            if target > size(targets, 1)
                aux.exit = true;
                return
            end
            goal = babbleMap(targets(target, :), learnt.centres, learnt.weights, learnt.spread);
        end
end

speed = (goal - angles) * 8;
motor.jointVelocities(2, [1 4]) = max(-babbleSpeed, min(babbleSpeed, speed));
