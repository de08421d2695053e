//! Sizes of windows and screens.

use std::{fmt, str::FromStr};

use serde::{Deserialize, Serialize};

/// The size of a window in points, which are pixels where the desktop is not scaled, or of a screen in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Resolution {
    /// From left to right.
    pub width: u32,
    /// From top to bottom.
    pub height: u32,
}

impl Resolution {
    /// A resolution in pixels.
    pub const fn new(width: u32, height: u32) -> Self {
        Self { width, height }
    }

    pub(super) const fn fits_into(self, other: Self) -> bool {
        self.width <= other.width && self.height <= other.height
    }

    /// The difference of two sizes, in pixels.
    pub(super) const fn difference(self, other: Self) -> u32 {
        self.width
            .abs_diff(other.width)
            .saturating_add(self.height.abs_diff(other.height))
    }
}

impl fmt::Display for Resolution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} × {}", self.width, self.height)
    }
}

impl FromStr for Resolution {
    type Err = String;

    /// Reads a size such as `1280x800`.
    fn from_str(text: &str) -> Result<Self, String> {
        const MOST: u32 = 16384;
        text.split_once(['x', '×'])
            .and_then(|(width, height)| {
                let (width, height) = (width.trim().parse().ok()?, height.trim().parse().ok()?);
                Some(Self { width, height })
            })
            .filter(|size| (1..=MOST).contains(&size.width) && (1..=MOST).contains(&size.height))
            .ok_or_else(|| {
                format!("expected a width and a height from 1 to {MOST}, such as 1280x800")
            })
    }
}
