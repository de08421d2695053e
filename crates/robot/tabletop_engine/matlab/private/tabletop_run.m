function tabletop_run(name, folder)
% TABLETOP_RUN  Call one of the scripts in the base workspace, and undo what would stop the driver.
evalin('base', [name '();']);
try
    tabletop_relink;
catch                                              % the script has taken the driver from the path
    driver = [folder 'driver' filesep];
    addpath(driver);
    tabletop_path(driver);
    kept = tabletop_keep();
    addpath(kept.folder);
    tabletop_relink;
end
kept = tabletop_keep();
if ~isempty(kept.copies), tabletop_front(kept.copies, folder); end
end

function tabletop_front(copies, folder)
% Have the COPIES of scripts found first again, but for what else is in FOLDER, if a script has put others there.
parts = ostrsplit(path(), pathsep());
own = find(strcmp(parts, copies), 1);
ahead = parts(1:own - 1);
if isempty(own) || ~all(strcmp(ahead, '.') | strncmp(ahead, folder, numel(folder))), addpath(copies); end
end
