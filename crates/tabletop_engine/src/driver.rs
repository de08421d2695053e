//! The engines' side of the bridge: files that are embedded in the program and written to a session's folder.

macro_rules! files {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("../matlab/", $name)))),*]
    };
}

/// The driver for MATLAB and Octave.
pub(crate) const MATLAB: &[(&str, &str)] = files![
    "tabletop_call.m",
    "tabletop_fields.m",
    "tabletop_get.m",
    "tabletop_global.m",
    "tabletop_hello.m",
    "tabletop_init.m",
    "tabletop_keep.m",
    "tabletop_poll.m",
    "tabletop_put.m",
    "tabletop_relink.m",
    "tabletop_step.m",
    "tabletop_text.m",
    "octave/input.m",
    "octave/keyboard.m",
];

/// What draws. Each becomes a file "undrawn/NAME.m" beside the driver for Octave, for use where there is nothing to draw with.
pub(crate) const UNDRAWN: &[&str] = &[
    "area",
    "axes",
    "axis",
    "bar",
    "box",
    "caxis",
    "cla",
    "clf",
    "colorbar",
    "colormap",
    "contour",
    "drawnow",
    "errorbar",
    "figure",
    "fill",
    "gca",
    "gcf",
    "grid",
    "hold",
    "image",
    "imagesc",
    "imshow",
    "legend",
    "line",
    "loglog",
    "mesh",
    "patch",
    "plot",
    "plot3",
    "print",
    "quiver",
    "rectangle",
    "refresh",
    "saveas",
    "scatter",
    "scatter3",
    "semilogx",
    "semilogy",
    "stairs",
    "stem",
    "subplot",
    "surf",
    "text",
    "title",
    "view",
    "xlabel",
    "xlim",
    "ylabel",
    "ylim",
    "zlabel",
    "zlim",
];

/// A function that takes anything and gives nothing, or as many empty matrices as are asked for.
pub(crate) fn undrawn(name: &str) -> String {
    format!("function varargout = {name}(varargin)\nvarargout = cell(1, nargout);\nend\n")
}

/// The driver for Python.
pub(crate) const PYTHON: &[(&str, &str)] =
    &[("tabletop.py", include_str!("../../../python/tabletop.py"))];
