if isfield(sensor, 'trackerLoc')
    names = keys(sensor.trackerLoc);
    place = sensor.trackerLoc('l-S1');
    if ~isequal(size(place), [1 3]), error('maps:place', 'a place is a row'); end
    if sensor.trackerLoc.isKey('nowhere'), error('maps:key', 'no such key'); end
    motor.headVelocity = place(3);
end
action = actions('wave');
motor.jointVelocities = action(motor);
colours('blue') = [0 0 1];
all_values = values(colours);
if colours.Count ~= 3 || ~isequal(all_values{1}, [0 0 1]), error('maps:values', 'wrong'); end
if any(strcmp('r-W1', names)), aux.exit = true; end
