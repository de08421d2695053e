function tabletop_call(op, folder, seq, draw, polled)
% TABLETOP_CALL  One exchange with the simulator: do OP, write FOLDER/reply.bin, say that it is there.
%   OP is 'hello', 'init' or 'step'.  SEQ is the number of the request.  DRAW tells whether figures
%   may be brought up to date now.  POLLED tells whether the simulator waits for a file or for a line.
%   For MATLAB R2007b and later and GNU Octave 6 and later, as all these files.
try
    switch op
        case 'hello'
            [names, values] = tabletop_hello(draw);
        case 'init'
            [names, values] = tabletop_init(folder);
        otherwise
            [names, values] = tabletop_step(folder);
    end
catch err
    driver = [folder 'driver' filesep];
    addpath(driver);                               % the script may have taken it from the path
    tabletop_path(driver);
    message = err.message;
    if isempty(message), message = 'error without a message'; end
    names = {'error.id', 'error.message', 'error.stack'};
    values = {err.identifier, message, tabletop_where(err.stack)};
end
tabletop_put([folder 'reply.bin'], names, values);
if polled
    fid = fopen([folder 'done.bin'], 'r+', 'ieee-le');
    fwrite(fid, [seq, seq], 'uint32');
    fclose(fid);
else
    fprintf('\001done %d\n', seq);
    fflush(stdout);
end
if draw
    try
        if ~isempty(get(0, 'Children')), drawnow; end
    catch err
        disp(err.message);
    end
end
end

function where = tabletop_where(stack)
% The script's part of the stack, one "line file" a line, innermost first.
where = '';
driver = fileparts(mfilename('fullpath'));
for k = 1:numel(stack)
    if strncmp(stack(k).file, driver, numel(driver)), continue; end
    where = [where sprintf('%d %s\n', stack(k).line, stack(k).file)]; %#ok<AGROW>
end
kept = tabletop_keep();
if isempty(where) && isfield(kept, 'running') && ~isempty(kept.running), where = ['-1 ' kept.running]; end
end
