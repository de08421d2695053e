function file = tabletop_file(script)
% TABLETOP_FILE  The file of a function handle; none if it is of no file of its own.
file = '';
about = functions(script);
if strcmp(about.type, 'simple'), file = which(about.function); end
end
