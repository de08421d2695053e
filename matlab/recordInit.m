% RECORDINIT  Saves what the robot sees of demonstrations to numbered files in the folder "pictures" beside this script.

recordFolder = [aux.path 'pictures/'];
if ~exist(recordFolder, 'dir'), mkdir(aux.path, 'pictures'); end
if ~isempty(dir([recordFolder '*.png'])), delete([recordFolder '*.png']); end
recorded = 0;
