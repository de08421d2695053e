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
end
