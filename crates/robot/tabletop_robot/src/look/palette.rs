//! The colours of the robot.

use serde::Deserialize;
use tabletop_geometry::Rgb;

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
            Self::Red => Rgb::new(0.80, 0.062, 0.07),
            Self::Charcoal => Rgb::new(0.25, 0.25, 0.26),
            Self::Black => Rgb::new(0.07, 0.07, 0.076),
            Self::LightGray => Rgb::new(0.95, 0.95, 0.95),
            Self::Gray => Rgb::new(0.70, 0.70, 0.73),
        }
    }
}
