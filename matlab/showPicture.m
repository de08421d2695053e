function showPicture(picture)
% SHOWPICTURE  Shows what the robot sees, if there is a display. Setting the data of the image that is
%   there already is much faster than drawing another one.
persistent failed
if ~isempty(failed) || strcmp(get(0, 'DefaultFigureVisible'), 'off'), return; end
try
    shown = findobj('Tag', 'robotView');
    if isempty(shown)
        image(picture, 'Tag', 'robotView');
        axis image off
    else
        set(shown(1), 'CData', picture);
    end
catch err
    failed = true;
    disp(['The picture is not shown: ' err.message]);
end
end
