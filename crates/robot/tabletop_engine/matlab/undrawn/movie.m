function movie(varargin)
% MOVIE  Nothing.
end
