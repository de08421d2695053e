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
    "tabletop_poll.m",
    "tabletop_put.m",
    "tabletop_relink.m",
    "tabletop_step.m",
    "tabletop_text.m",
    "octave/input.m",
    "octave/keyboard.m",
    "octave/tabletop_repair.m",
];

/// The driver for Python.
const PYTHON: &[(&str, &str)] = &[("tabletop.py", include_str!("../../../python/tabletop.py"))];

/// What draws, in Octave. Where there is nothing to draw with, it does nothing.
const UNDRAWN: &str = "area axes axis bar box caxis cla clf colorbar colormap contour drawnow errorbar figure fill gca gcf grid hold \
    image imagesc imshow legend line loglog mesh patch plot plot3 print quiver rectangle refresh saveas scatter \
    scatter3 semilogx semilogy stairs stem subplot surf text title view xlabel xlim ylabel ylim zlabel zlim";

/// The files of the driver for an engine: names and texts.
pub(crate) fn files(kind: EngineKind) -> Vec<(String, String)> {
    let driver = match kind {
        EngineKind::Matlab | EngineKind::Octave => MATLAB,
        EngineKind::Python => PYTHON,
    };
    let undrawn = match kind {
        EngineKind::Octave => UNDRAWN,
        EngineKind::Matlab | EngineKind::Python => "",
    };
    let driver = driver
        .iter()
        .map(|(name, text)| ((*name).to_owned(), (*text).to_owned()));
    let undrawn = undrawn.split_whitespace();
    driver
        .chain(undrawn.map(|name| (format!("undrawn/{name}.m"), nothing(name))))
        .collect()
}

/// A function that takes anything and gives nothing, or as many empty matrices as are asked for.
fn nothing(name: &str) -> String {
    format!("function varargout = {name}(varargin)\nvarargout = cell(1, nargout);\nend\n")
}
