calls = calls + 1;
subplot(1, 2, 2);
image(sensor.rgbVision); axis off
drawn = findobj(gcf, 'Type', 'image');
motor.headVelocity = numel(drawn);
if calls == 2, close all; aux.exit = 1; end
