function tabletop_poll(folder)
% TABLETOP_POLL  Serve requests that are announced in FOLDER/trigger.bin: number, operation, whether
%   to draw, heartbeat, sum.  Ends when asked to, or when the simulator's heart no longer beats.
ops = {'hello', 'init', 'step'};
last = 0;
beat = -1;
quiet = 0;                                         % seconds since the last sign of life
idle = 0;                                          % seconds since the last request
while quiet < 30
    fid = fopen([folder 'trigger.bin'], 'r', 'ieee-le');
    words = [];
    if fid >= 0
        words = fread(fid, [1 5], 'uint32');
        fclose(fid);
    end
    whole = numel(words) == 5 && mod(sum(words(1:4)), 4294967296) == words(5);
    if whole && words(4) ~= beat
        beat = words(4);
        quiet = 0;
    end
    if whole && words(1) ~= last
        last = words(1);
        idle = 0;
        if words(2) == 0, return; end
        tabletop_call(ops{words(2)}, folder, last, words(3), 1);
    else
        if idle < 0.01, nap = 0.0002; elseif idle < 5, nap = 0.001; else nap = 0.01; end
        before = clock;
        builtin('pause', nap);                         % longer where the timer is coarse, not at all after "pause off"
        nap = min(max(etime(clock, before), 0), 1);    % not the night that the computer has slept through
        idle = idle + nap;
        quiet = quiet + nap;
    end
end
end
