function [angles, activity] = babbleMap(place, centres, weights, spread)
% BABBLEMAP  Angles for a place, and how much each unit has to say about it (in all: 1).
if isempty(centres)
    angles = [0 0];
    activity = [];
    return
end
distances = sum((centres - repmat(place, size(centres, 1), 1)) .^ 2, 2)';
activity = exp((min(distances) - distances) / (2 * spread ^ 2));
activity = activity / sum(activity);
angles = activity * weights;
end
