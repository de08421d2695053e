% FOLLOWCALLBACK  Looks for red in each new picture and turns the head towards it.

if any(strcmp('rgbVision', fieldnames(sensor)))
    picture = sensor.rgbVision;
    red = picture(:, :, 1) > 0.5 & picture(:, :, 2) < 0.3 & picture(:, :, 3) < 0.3;
    [rows, columns] = find(red);
    if isempty(columns)
        offset = NaN;
    else
        middle = (size(red, 2) + 1) / 2;
        offset = (mean(columns) - middle) / middle;
    end
    showPicture(picture);
end

if isnan(offset)
    sinceSeen = sinceSeen + sensor.timeElapsed;
    if mod(sinceSeen + searchTime / 2, 2 * searchTime) < searchTime
        motor.headVelocity = searchSpeed;
    else
        motor.headVelocity = -searchSpeed;
    end
else
    sinceSeen = 0;
    motor.headVelocity = -followGain * offset;   % positive turns to the left
end
