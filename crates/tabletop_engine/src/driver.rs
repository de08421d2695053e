//! The engines' side of the bridge: files that are embedded in the program and written to a session's folder.

use crate::find::EngineKind;

macro_rules! files {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("../matlab/", $name)))),*]
    };
}

/// The driver for MATLAB and Octave.
const MATLAB: &[(&str, &str)] = files![
    "tabletop_call.m",
    "tabletop_fields.m",
    "tabletop_get.m",
    "tabletop_global.m",
    "tabletop_hello.m",
    "tabletop_init.m",
    "tabletop_keep.m",
    "tabletop_pair.m",
    "tabletop_path.m",
    "tabletop_poll.m",
    "tabletop_put.m",
    "tabletop_relink.m",
    "tabletop_run.m",
    "tabletop_step.m",
    "tabletop_text.m",
    "octave/@struct/disp.m",
    "octave/@struct/display.m",
    "octave/pause.m",
    "octave/popen.m",
    "octave/system.m",
    "octave/tabletop_repair.m",
    "undrawn/getframe.m",
];

/// The driver for Python.
const PYTHON: &[(&str, &str)] = &[("tabletop.py", include_str!("../../../python/tabletop.py"))];

/// What would wait for somebody, in Octave, where commands come in on the standard input; and what nobody can do.
const UNANSWERED: [(&str, &str); 5] = [
    ("input", "answer"),
    ("kbhit", "type"),
    ("keyboard", "type"),
    ("stdin", "type"),
    ("yes_or_no", "answer"),
];

/// What would let Octave's debugger wait for commands.
const UNDEBUGGED: &str = "dbstop debug_on_error debug_on_interrupt debug_on_warning";

/// What draws, in Octave. Where there is nothing to draw with, it does nothing.
const UNDRAWN: &str = "annotation area axes axis bar bar3 bar3h barh box camlight camlookat camorbit campos camroll camtarget camup \
    camva camzoom caxis cla clabel clf close colorbar colormap comet comet3 compass contour contour3 contourf copyobj daspect \
    datetick delaxes drawnow errorbar ezcontour ezcontourf ezmesh ezmeshc ezplot ezplot3 ezpolar ezsurf ezsurfc feather figure \
    fill fill3 fplot gca gcf ginput grid gtext hggroup hgload hgsave hgtransform hidden histogram hold image imagesc \
    imshow legend light lightangle lighting line linkaxes linkprop loglog loglogerr material mesh meshc meshz movegui newplot \
    openfig orient pan patch pbaspect pcolor pie pie3 plot plot3 plotmatrix plotyy polar print quiver quiver3 rectangle refresh \
    refreshdata ribbon rotate rotate3d rticks saveas savefig scatter scatter3 semilogx semilogxerr semilogy semilogyerr \
    shading shg slice stairs stem stem3 streamline streamribbon streamtube subplot surf surface surfc surfl text tetramesh \
    thetaticks title trimesh triplot trisurf uicontextmenu uicontrol uifigure uimenu uipanel uipushtool uitable uitoggletool \
    uitoolbar view waitbar waitforbuttonpress waterfall whitebg xlabel xlim xtickangle xticklabels xticks ylabel ylim ytickangle \
    yticklabels yticks zlabel zlim zoom ztickangle zticklabels zticks";

/// The files of the driver for an engine: names and texts.
pub(crate) fn files(kind: EngineKind) -> Vec<(String, String)> {
    let driver = match kind {
        EngineKind::Matlab | EngineKind::Octave => MATLAB,
        EngineKind::Python => PYTHON,
        EngineKind::Driver => &[],
    };
    let mut files: Vec<_> = driver
        .iter()
        .map(|(name, text)| ((*name).to_owned(), (*text).to_owned()))
        .collect();
    if kind == EngineKind::Octave {
        let octave = |name: &str| format!("octave/{name}.m");
        files.extend(UNANSWERED.map(|(name, deed)| (octave(name), unanswered(name, deed))));
        let undebugged = UNDEBUGGED.split_whitespace();
        files.extend(undebugged.map(|name| (octave(name), undebuggable(name))));
        let undrawn = UNDRAWN.split_whitespace();
        files.extend(undrawn.map(|name| (format!("undrawn/{name}.m"), nothing(name))));
    }
    files
}

/// Whether a function is one of the driver's, by its name.
pub(crate) fn is_own(function: &str) -> bool {
    let file = function.split('>').next().unwrap_or_default();
    file.starts_with("tabletop_") || UNDEBUGGED.split_whitespace().any(|name| name == file)
}

/// A function that fails, and says why.
fn unanswered(name: &str, deed: &str) -> String {
    format!(
        "function varargout = {name}(varargin)\nerror('tabletop:input', \
         '{name} cannot be used here: the simulator runs this script, nobody can {deed}');\nend\n"
    )
}

/// A function that does nothing but say so.
fn undebuggable(name: &str) -> String {
    format!(
        "function varargout = {name}(varargin)\nwarning('tabletop:debug', \
         '{name} has no effect here: the simulator runs this script, nobody can debug');\n\
         varargout = cell(1, nargout);\nend\n"
    )
}

/// A function that takes anything and gives nothing, or as many empty matrices as are asked for.
fn nothing(name: &str) -> String {
    format!("function varargout = {name}(varargin)\nvarargout = cell(1, nargout);\nend\n")
}
