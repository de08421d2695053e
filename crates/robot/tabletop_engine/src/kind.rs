//! The kinds of engines.

use std::fmt;

/// A kind of engine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EngineKind {
    /// MATLAB, R2007b and later.
    Matlab,
    /// GNU Octave, 6 and later.
    Octave,
    /// Python 3.
    Python,
    /// A user's own program for scripts in another language.
    Driver,
}

impl fmt::Display for EngineKind {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.write_str(match self {
            Self::Matlab => "MATLAB",
            Self::Octave => "GNU Octave",
            Self::Python => "Python",
            Self::Driver => "a driver",
        })
    }
}
