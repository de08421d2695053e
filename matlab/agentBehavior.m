function [init, callback] = agentBehavior()
% AGENTBEHAVIOR  Names the scripts that control the robot: one that is run once, one that is run in every tick.
%   Others to try: reach, follow, babble, pick, record (each with Init and Callback).
init = @exampleInit;
callback = @exampleCallback;
end
