//! The choice of the engine that runs the scripts.

use std::{convert::Infallible, path::PathBuf, str::FromStr};

use crate::kind::EngineKind;

/// The variable that names the engine where nobody else does: "matlab", "octave", "python" or a program's path.
pub const ENGINE_VARIABLE: &str = "TABLETOP_ENGINE";

/// The engine that was asked for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum EngineChoice {
    /// The variable `TABLETOP_ENGINE`, else MATLAB if it is there, else Octave.
    #[default]
    Auto,
    /// One kind of engine.
    Kind(EngineKind),
    /// A program, or the folder in which it is.
    Program(PathBuf),
    /// A user's driver (see docs/script-protocol.md).
    Driver(PathBuf),
}

impl FromStr for EngineChoice {
    type Err = Infallible;

    /// "auto", "matlab", "octave", "python", or the path of a program.
    fn from_str(text: &str) -> Result<Self, Infallible> {
        Ok(match text.to_ascii_lowercase().as_str() {
            "" | "auto" => Self::Auto,
            "matlab" => Self::Kind(EngineKind::Matlab),
            "octave" => Self::Kind(EngineKind::Octave),
            "python" => Self::Kind(EngineKind::Python),
            _ => Self::Program(text.into()),
        })
    }
}
