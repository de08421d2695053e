% Objects of handle classes, and their static functions by handle.
counter = Counter(3);
same = counter;
double_it = @Counter.twice;
table = containers.Map();
table('twice') = @Counter.twice;
