counter.add();
add(same);
f = table('twice');
motor.jointVelocities(1, 1) = counter.count;
motor.headVelocity = double_it(2) + f(1) + Counter.twice(0.5);
if counter.count ~= same.count, error('classes:handle', 'two objects'); end
if counter.count >= 12, aux.exit = []; end
