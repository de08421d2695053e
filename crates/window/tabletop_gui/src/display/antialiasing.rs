//! Smooth edges.

use std::{fmt, str::FromStr};

use serde::{Deserialize, Serialize};

/// Anti-aliasing: the number of points of each pixel that are looked at.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
)]
pub enum Antialiasing {
    /// One.
    Off,
    /// Two, as the report recommends.
    #[default]
    X2,
    /// Four.
    X4,
    /// Eight.
    X8,
}

impl Antialiasing {
    /// All of them, in rising order.
    pub const ALL: [Self; 4] = [Self::Off, Self::X2, Self::X4, Self::X8];

    /// Points of a pixel that are looked at.
    pub const fn samples(self) -> u32 {
        match self {
            Self::Off => 1,
            Self::X2 => 2,
            Self::X4 => 4,
            Self::X8 => 8,
        }
    }
}

impl fmt::Display for Antialiasing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Off => f.write_str("off"),
            Self::X2 | Self::X4 | Self::X8 => write!(f, "{}x", self.samples()),
        }
    }
}

impl FromStr for Antialiasing {
    type Err = String;

    /// Reads `off`, `2`, `4`, `8`, or `2x` and so on.
    fn from_str(text: &str) -> Result<Self, String> {
        let samples = text.trim_end_matches(['x', '×']);
        let is_named = |candidate: &Self| match candidate {
            Self::Off => matches!(samples, "off" | "0" | "1"),
            Self::X2 | Self::X4 | Self::X8 => samples == candidate.samples().to_string(),
        };
        Self::ALL
            .into_iter()
            .find(is_named)
            .ok_or_else(|| "expected off, 2, 4 or 8".to_owned())
    }
}
