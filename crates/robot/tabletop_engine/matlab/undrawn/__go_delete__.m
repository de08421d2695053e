function __go_delete__(varargin)
% __GO_DELETE__  Nothing: there is nothing that was drawn.
end
