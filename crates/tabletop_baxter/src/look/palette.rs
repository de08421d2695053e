//! The colours of the robot.

use serde::Deserialize;
use tabletop_core::Rgb;

/// A colour of the robot, by the name that shape files use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Paint {
    /// Arms and yoke.
    Red,
    /// Torso, shoulders and pedestal.
    Charcoal,
    /// Caps of joints, cuffs, wheels and glass.
    Black,
    /// Plates around buttons, pads of fingers.
    LightGray,
    /// The strip on the chest.
    Gray,
}

impl Paint {
    /// The colour, as it is displayed.
    pub const fn rgb(self) -> Rgb {
        match self {
            Self::Red => Rgb::new(0.58, 0.045, 0.05),
            Self::Charcoal => Rgb::new(0.18, 0.18, 0.19),
            Self::Black => Rgb::new(0.05, 0.05, 0.055),
            Self::LightGray => Rgb::new(0.72, 0.72, 0.72),
            Self::Gray => Rgb::new(0.52, 0.52, 0.54),
        }
    }
}
