//! Indicator lights.

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

use tabletop_geometry::Rgb;

/// A row of lights along X.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, Reflect)]
pub struct IndicatorLights {
    /// Radius of a light, in units.
    pub radius: f32,
    /// Height of a light, in units.
    pub zspan: f32,
    /// Number of lights.
    pub lights: u32,
    /// Length of the row, in units.
    pub xspan: f32,
    /// The states, each with the lights that it turns on.
    pub states: Vec<LightState>,
}

/// A state of indicator lights: the lights that it turns on.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, Reflect)]
pub struct LightState {
    /// Its name in recordings; empty for its number.
    pub name: String,
    /// The numbers and colours of the lights that are on.
    pub lights: Vec<(u32, Rgb)>,
}
