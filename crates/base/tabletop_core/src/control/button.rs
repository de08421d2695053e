//! Push buttons.

use std::f32::consts::FRAC_1_SQRT_2;

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

use tabletop_geometry::{Rgb, UNITS_PER_METER};

/// A button. Its cap is the control: an object of its own, which slides in a housing and springs back up.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Reflect)]
pub struct PushButton {
    /// Radius of the cap, in units.
    pub radius: f32,
    /// Height of the housing, in units.
    pub zspan: f32,
    /// How far the cap goes down, in units.
    pub travel: f32,
    /// The force that takes the cap all the way down, in newtons.
    pub force: f32,
    /// Colour of the cap.
    pub color: Rgb,
    /// Its effect downstream.
    pub mode: PressMode,
    /// Its state while it is pressed; else it is in state 0.
    pub state: u32,
}

/// The effect of a push button downstream.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Reflect)]
pub enum PressMode {
    /// Its state when it is pressed, and nothing when it comes up.
    Once,
    /// Its state when it is pressed, and 0 when it comes up.
    Held,
}

impl PushButton {
    /// Length of the cap, and the part of it that stands out when it is down, for a travel of 1.
    const LENGTH: f32 = 2.0;
    const OUTSTANDING: f32 = 0.25;
    /// The shares of the travel up to which it is not pressed any more, and beyond which it is pressed.
    const PRESSED: [f32; 2] = [0.25, 0.5];
    /// Turns X up: the cap slides along -Z of the button, and any slider along its -X.
    pub(crate) const UPWARDS: Quat = Quat::from_xyzw(0.0, -FRAC_1_SQRT_2, 0.0, FRAC_1_SQRT_2);

    /// The least height of a housing that has room for a cap of this travel, in units.
    pub const fn least_zspan(travel: f32) -> f32 {
        (Self::LENGTH - Self::OUTSTANDING) * travel
    }

    /// The spring's force for a unit of way, in kg/s²: at rest it pushes half as hard as at the end.
    pub const fn stiffness(&self) -> f32 {
        UNITS_PER_METER as f32 * self.force / (2.0 * self.travel)
    }

    /// Whether it is pressed while its cap is down by so much, in units.
    pub const fn is_pressed_at(&self, displacement: f32, was_pressed: bool) -> bool {
        let [released, pressed] = Self::PRESSED;
        let share = if was_pressed { released } else { pressed };
        displacement > share * self.travel
    }

    /// Length of the cap, in units.
    pub(crate) const fn length(&self) -> f32 {
        Self::LENGTH * self.travel
    }

    /// Height of the middle of the cap above the bottom of the housing while it is up, in units.
    pub(crate) const fn height(&self) -> f32 {
        self.zspan + (1.0 + Self::OUTSTANDING) * self.travel - self.length() / 2.0
    }
}
