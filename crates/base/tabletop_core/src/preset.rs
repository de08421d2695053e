//! Objects that need no task file (report section 6.1).

use std::{fmt, ops::RangeInclusive};

use serde::{Deserialize, Serialize};

/// Objects in random colours at a random free place over the table.
///
/// ```
/// use tabletop_core::Preset;
///
/// assert_eq!(Preset::Stack(5).to_string(), "a stack of 5 blocks");
/// assert!(Preset::Stack(0).fault().is_some());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Preset {
    /// A cube of 1.5 units that falls from 10 units, turned.
    BigBlock,
    /// This many unit cubes on top of each other.
    Stack(u32),
    /// A gray box, open at the top, that falls from 10 units.
    BoxContainer,
}

impl Preset {
    /// Numbers of blocks that a stack can have.
    pub const STACKED: RangeInclusive<u32> = 1..=50;

    /// The fault of a preset that makes no sense.
    pub fn fault(self) -> Option<String> {
        match self {
            Self::Stack(blocks) if !Self::STACKED.contains(&blocks) => Some(format!(
                "a stack has {} to {} blocks, not {blocks}",
                Self::STACKED.start(),
                Self::STACKED.end()
            )),
            Self::BigBlock | Self::Stack(_) | Self::BoxContainer => None,
        }
    }
}

impl fmt::Display for Preset {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::BigBlock => f.write_str("a big block"),
            Self::Stack(1) => f.write_str("a block"),
            Self::Stack(blocks) => write!(f, "a stack of {blocks} blocks"),
            Self::BoxContainer => f.write_str("a box container"),
        }
    }
}
