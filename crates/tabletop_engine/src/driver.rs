//! The engines' side of the bridge: files that are embedded in the program and written to a session's folder.

use crate::find::EngineKind;

macro_rules! files {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("../matlab/", $name)))),*]
    };
}

/// The driver for MATLAB and Octave. What is private is found whatever a script does to the path.
const MATLAB: &[(&str, &str)] = files![
    "private/tabletop_fields.m",
    "private/tabletop_file.m",
    "private/tabletop_get.m",
    "private/tabletop_global.m",
    "private/tabletop_hello.m",
    "private/tabletop_init.m",
    "private/tabletop_keep.m",
    "private/tabletop_pair.m",
    "private/tabletop_path.m",
    "private/tabletop_put.m",
    "private/tabletop_run.m",
    "private/tabletop_step.m",
    "private/tabletop_text.m",
    "savepath.m",
    "tabletop_call.m",
    "tabletop_poll.m",
    "tabletop_relink.m",
    "octave/@struct/disp.m",
    "octave/@struct/display.m",
    "octave/pause.m",
    "octave/popen.m",
    "octave/source.m",
    "octave/system.m",
    "octave/tabletop_repair.m",
    "undrawn/__go_delete__.m",
    "undrawn/axis.m",
    "undrawn/colormap.m",
    "undrawn/get.m",
    "undrawn/getframe.m",
    "undrawn/ginput.m",
    "undrawn/isaxes.m",
    "undrawn/isfigure.m",
    "undrawn/isgraphics.m",
    "undrawn/ishandle.m",
    "undrawn/ishghandle.m",
    "undrawn/movie.m",
    "undrawn/set.m",
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
const UNDRAWN: &str = "ancestor annotation area axes bar3 bar3h box camlight camlookat camorbit campos camroll camtarget camup camva camzoom cla \
    clabel clf close colorbar comet comet3 compass copyobj daspect datetick delaxes drawnow errorbar ezcontour ezcontourf \
    ezmesh ezmeshc ezplot ezplot3 ezpolar ezsurf ezsurfc feather figure fill fill3 fplot gca gcf grid gtext hggroup hgload \
    hgtransform hidden histogram hold image imagesc imshow legend light lightangle lighting line linkaxes linkprop loglog \
    loglogerr material mesh meshc meshz movegui newplot openfig orient pan patch pbaspect pcolor pie pie3 plot plot3 \
    plotmatrix plotyy polar quiver quiver3 rectangle refresh refreshdata ribbon rotate rotate3d rticks scatter scatter3 \
    semilogx semilogxerr semilogy semilogyerr shading shg slice stem stem3 streamline streamribbon streamtube subplot surf \
    surface surfc surfl text tetramesh thetaticks title trimesh triplot trisurf uicontextmenu uicontrol uifigure uimenu \
    uipanel uipushtool uitable uitoggletool uitoolbar view waitbar waitforbuttonpress waterfall whitebg xlabel xtickangle \
    xticklabels xticks ylabel ytickangle yticklabels yticks zlabel zoom ztickangle zticklabels zticks";

/// The limits of what is not drawn.
const LIMITS: &str = "caxis clim xlim ylim zlim";

/// What looks for what was drawn.
const SOUGHT: &str = "allchild findall findobj";

/// What can compute what it would draw.
const COMPUTED: &str = "bar barh contour contour3 contourf stairs";

/// What would make a file of a drawing.
const PRINTED: &str = "hgsave print saveas savefig";

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
        let kinds: [(_, fn(&str) -> String); 5] = [
            (UNDRAWN, undrawn),
            (LIMITS, limits),
            (SOUGHT, nothing_found),
            (COMPUTED, computed),
            (PRINTED, unprinted),
        ];
        for (names, text) in kinds {
            let names = names.split_whitespace();
            files.extend(names.map(|name| (format!("undrawn/{name}.m"), text(name))));
        }
    }
    files
}

/// Whether a function is one of the driver's, by its name.
pub(crate) fn is_own(function: &str) -> bool {
    let file = function.split('>').next().unwrap_or_default();
    let mut told = [UNDEBUGGED, PRINTED, "savepath"]
        .into_iter()
        .flat_map(str::split_whitespace);
    file.starts_with("tabletop_") || told.any(|name| name == file)
}

/// A function that fails, and says why.
fn unanswered(name: &str, deed: &str) -> String {
    format!(
        "function varargout = {name}(varargin)\nerror('tabletop:input', \
         '{name} cannot be used here: the simulator runs this script, nobody can {deed}');\nend\n"
    )
}

/// A function that does nothing but say so. Octave's own ask whether the debugger is on, and switch it off.
fn undebuggable(name: &str) -> String {
    format!(
        "function varargout = {name}(varargin)\nif nargin == 0 || nargout > 0, varargout = {{false}}; end\n\
         if nargin == 0 || isequal(varargin{{1}}, false), return; end\n\
         warning('tabletop:debug', '{name} has no effect here: the simulator runs this script, nobody can debug');\nend\n"
    )
}

/// A function that takes anything and gives 1, a figure or what is in it, for all that it is asked for.
fn undrawn(name: &str) -> String {
    format!("function varargout = {name}(varargin)\nvarargout = num2cell(ones(1, nargout));\nend\n")
}

/// A function that takes anything and gives the limits of empty axes.
fn limits(name: &str) -> String {
    format!(
        "function varargout = {name}(varargin)\nif nargin == 0 || nargout > 0, varargout = {{[0 1]}}; end\nend\n"
    )
}

/// A function that takes anything and finds nothing.
fn nothing_found(name: &str) -> String {
    format!("function found = {name}(varargin)\nfound = zeros(0, 1);\nend\n")
}

/// A function that draws nothing, but lets Octave's own compute what that would compute instead of drawing.
fn computed(name: &str) -> String {
    let (own, results) = match name.starts_with("contour") {
        true => ("contourc", 1),
        false => (name, 2),
    };
    format!(
        "function varargout = {name}(varargin)\nvarargout = num2cell(ones(1, nargout));\nif nargout < {results}, return; end\n\
         here = fileparts(mfilename('fullpath'));\nrmpath(here);\nback = onCleanup(@() addpath(here));\n\
         [varargout{{1:{results}}}] = {own}(varargin{{:}});\nend\n"
    )
}

/// A function that says, once, that it makes no file.
fn unprinted(name: &str) -> String {
    format!(
        "function varargout = {name}(varargin)\npersistent told\nvarargout = num2cell(ones(1, nargout));\n\
         if isempty(told), warning('tabletop:undrawn', '{name} makes no file here: there is no display to draw on'); end\n\
         told = true;\nend\n"
    )
}
