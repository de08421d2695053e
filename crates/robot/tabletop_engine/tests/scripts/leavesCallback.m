steps = steps + 1;
motor.headVelocity = steps;
if steps < 2, motor.jointVelocities(1, 1) = 1; break, end   % the break of an "if"
if steps < 3
    break;
end
for k = 1:3, if k == 2, break; end, end
motor.headVelocity = 10 * k;
aux.exit = 1;
