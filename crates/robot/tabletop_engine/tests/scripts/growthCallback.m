Nbt = Nbt + 1;
history(end + 1) = sensor.timeElapsed;
log{end + 1} = strcat('call', num2str(Nbt));
Theta(:, end + 1) = sensor.jointAngles(:, 1);
motor.jointVelocities(2, 1) = numel(log);
motor.gripperVelocities(2, 1) = 1;
[most, where] = max(history);
[rows, columns] = size(Theta);
if columns ~= Nbt || ~strcmp(log{end}, ['call' num2str(Nbt)]), error('growth:history', 'lost %d', Nbt); end
[a, b, c] = tasks(1).args{:};
if ~strcmp(c, 'four') || ~isempty(tasks(2).args), error('growth:tasks', 'wrong'); end
if plan.steps{3}(1, 2) ~= 3 || ~isempty(plan.steps{1}), error('growth:plan', 'wrong'); end
plan.deep.er(Nbt + 2).value = Nbt;
if numel(plan.deep.er) ~= Nbt + 2, error('growth:deep', 'wrong'); end
for k = 1:10
    if k > 3, break, end
    if k == 2, continue, end
    motor.jointVelocities(1, k) = k;
end
while true, Nbt = Nbt; break; end
if ~strcmp(aux.note, 'mine'), error('growth:aux', 'aux was not kept'); end
switch log{end}
    case {'call1', 'call2'}
        return
    case 'call4'
        aux.exit = 1;
end
