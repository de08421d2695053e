% FOLLOWINIT  The head turns so that what is red stays in the middle of the picture.

followGain = 1;                          % rad/s for something at the picture's edge
searchSpeed = 0.5;                       % rad/s, while nothing red is in sight
searchTime = 3;                          % seconds until the search turns round, the first time half of it
sinceSeen = 0;
offset = NaN;                            % where the red is: -1 at the left edge, 1 at the right
