% Files by command and by function: MAT v5, text, pictures.
load scripts/given.mat
values = struct('name', 'a', 'list', {{1, 2}});
save([aux.path 'saved7.mat'], 'values', '-v7');
save([aux.path 'saved6.mat'], 'given', '-v6');
fid = fopen([aux.path 'notes.txt'], 'w');
fprintf(fid, '%s %d\n', 'line', 1);
calls = 0;
