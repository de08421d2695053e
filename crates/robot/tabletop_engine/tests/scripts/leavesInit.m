% A pair that leaves its scripts by "break", as MATLAB allows.
steps = 0;
if steps == 0
    break
end
error('leaves:init', 'the script was not left');
