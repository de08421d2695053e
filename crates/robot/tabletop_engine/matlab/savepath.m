function failed = savepath(varargin)
% SAVEPATH  Nothing: the path of this session holds folders of the simulator that are soon gone.
persistent told
if isempty(told)
    told = true;
    warning('tabletop:savepath', ['savepath has no effect here: the path that the simulator has set is for this script only; ' ...
        'use addpath in the init script']);
end
if nargout, failed = 0; end
end
