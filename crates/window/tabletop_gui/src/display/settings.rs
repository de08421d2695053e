//! The settings of the display.

use std::num::NonZeroU32;

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

use super::{antialiasing::Antialiasing, mode::ScreenMode, resolution::Resolution};

/// Under which name the settings are kept between runs.
pub const CONCERN: &str = "display";

/// As many pictures a second as the simulation has ticks, as the report recommends.
pub(super) const SIXTY: NonZeroU32 = NonZeroU32::new(60).expect("it is not zero");

/// The settings that the user chooses before the window opens.
#[derive(Resource, Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct DisplaySettings {
    /// The size of the window, or of the screen if the window fills it.
    pub resolution: Resolution,
    /// True if the window fills the screen.
    pub fullscreen: bool,
    /// True if a picture is only shown when the screen has shown the last one wholly.
    pub vsync: bool,
    /// Pictures a second, at most.
    pub refresh_rate: NonZeroU32,
    /// Bits of a pixel's colour, if the window fills the screen; else it has the desktop's.
    pub color_depth: u16,
    /// The anti-aliasing.
    pub antialiasing: Antialiasing,
    /// True if the user is asked when the program starts.
    pub ask: bool,
}

impl Default for DisplaySettings {
    /// The report's recommendations.
    fn default() -> Self {
        Self {
            resolution: Resolution::new(1024, 768),
            fullscreen: false,
            vsync: true,
            refresh_rate: SIXTY,
            color_depth: 24,
            antialiasing: Antialiasing::X2,
            ask: true,
        }
    }
}

impl DisplaySettings {
    /// The mode of a screen that these settings ask for.
    pub const fn mode(&self) -> ScreenMode {
        ScreenMode {
            resolution: self.resolution,
            refresh_rate: self.refresh_rate,
            color_depth: self.color_depth,
        }
    }
}
