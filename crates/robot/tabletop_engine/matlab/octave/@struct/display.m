function display(value)
% DISPLAY  A struct with its name.
printf("%s =\n", inputname(1));
disp(value);
printf("\n");
end
