//! The engines' side of the bridge: files that are embedded in the program and written to a session's folder.

use crate::{kind::EngineKind, octave::stubs};

macro_rules! files {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("../../matlab/", $name)))),*]
    };
}

/// The driver for MATLAB and Octave. Its private functions are found with any path that a script sets.
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
    "octave/load.m",
    "octave/mfilename.m",
    "octave/pause.m",
    "octave/popen.m",
    "octave/source.m",
    "octave/system.m",
    "octave/tabletop_repair.m",
    "octave/which.m",
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
const PYTHON: &[(&str, &str)] = &[(
    "tabletop_driver.py",
    include_str!("../../../../../python/tabletop_driver.py"),
)];

/// The files of the driver for an engine: names and texts.
pub(crate) fn files(kind: EngineKind) -> Vec<(String, String)> {
    let driver = match kind {
        EngineKind::Matlab | EngineKind::Octave => MATLAB,
        EngineKind::Python => PYTHON,
        EngineKind::Driver => &[],
    };
    let files = driver
        .iter()
        .map(|(name, text)| ((*name).to_owned(), (*text).to_owned()));
    match kind {
        EngineKind::Octave => files.chain(stubs::files()).collect(),
        EngineKind::Matlab | EngineKind::Python | EngineKind::Driver => files.collect(),
    }
}
