//! Stubs in place of Octave's functions that need a person, a debugger or a display.

/// Functions that would wait for somebody, in Octave, where commands come in on the standard input; and those that nobody can use.
const UNANSWERED: [(&str, &str); 5] = [
    ("input", "answer"),
    ("kbhit", "type"),
    ("keyboard", "type"),
    ("stdin", "type"),
    ("yes_or_no", "answer"),
];

/// Functions that would let Octave's debugger wait for commands.
const UNDEBUGGED: &str = "dbstop debug_on_error debug_on_interrupt debug_on_warning";

/// Functions of Octave that draw. Where there is nothing to draw with, they do nothing.
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

/// The limits of axes that are not drawn.
const LIMITS: &str = "caxis clim xlim ylim zlim";

/// Functions that look for drawings.
const SOUGHT: &str = "allchild findall findobj";

/// Functions that can return their points instead of drawing them.
const COMPUTED: &str = "bar barh contour contour3 contourf stairs";

/// Functions that would ask for a file in a window.
const CHOSEN: &str = "uigetdir uigetfile uiputfile";

/// Functions that would make a file of a drawing.
const PRINTED: &str = "hgsave print saveas savefig";

/// Names and texts.
pub(crate) fn files() -> impl Iterator<Item = (String, String)> {
    let refusing = UNANSWERED.map(|(name, deed)| ("octave", name, unanswered(name, deed)));
    let kinds: [(_, _, fn(&str) -> String); 7] = [
        ("octave", UNDEBUGGED, undebuggable),
        ("undrawn", UNDRAWN, undrawn),
        ("undrawn", LIMITS, limits),
        ("undrawn", SOUGHT, nothing_found),
        ("undrawn", COMPUTED, computed),
        ("undrawn", PRINTED, unprinted),
        ("undrawn", CHOSEN, |name| unanswered(name, "choose")),
    ];
    let others = kinds.into_iter().flat_map(|(folder, names, text)| {
        let names = names.split_whitespace();
        names.map(move |name| (folder, name, text(name)))
    });
    let all = refusing.into_iter().chain(others);
    all.map(|(folder, name, text)| (format!("{folder}/{name}.m"), text))
}

/// True if the one in place of this function says that it does nothing.
pub(crate) fn warns(function: &str) -> bool {
    let mut names = [UNDEBUGGED, PRINTED]
        .into_iter()
        .flat_map(str::split_whitespace);
    names.any(|name| name == function)
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

/// A function that takes anything and returns 1, a figure or a part of one, for every output.
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

/// A function that draws nothing, but returns the points that Octave's own function computes.
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
        "function varargout = {name}(varargin)\npersistent warned\nvarargout = num2cell(ones(1, nargout));\n\
         if isempty(warned), warning('tabletop:undrawn', '{name} makes no file here: there is no display to draw on'); end\n\
         warned = true;\nend\n"
    )
}
