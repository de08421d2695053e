function varargout = ginput(varargin)
% GINPUT  Nobody has clicked.
varargout = cell(1, nargout);
end
