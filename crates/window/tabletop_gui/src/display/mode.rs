//! Modes of a screen.

use std::{fmt, num::NonZeroU32};

use super::resolution::Resolution;

/// A mode of a screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ScreenMode {
    /// Its size.
    pub resolution: Resolution,
    /// Pictures a second, rounded.
    pub refresh_rate: NonZeroU32,
    /// Bits of a pixel's colour.
    pub color_depth: u16,
}

impl fmt::Display for ScreenMode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            resolution,
            refresh_rate,
            color_depth,
        } = self;
        write!(f, "{resolution}, {refresh_rate} Hz, {color_depth} bit")
    }
}
