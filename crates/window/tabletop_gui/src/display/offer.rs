//! The settings that a display can do.

use std::num::NonZeroU32;

use bevy::prelude::*;

use super::{
    antialiasing::Antialiasing,
    mode::ScreenMode,
    resolution::Resolution,
    settings::{DisplaySettings, SIXTY},
};

/// Sizes of windows, beside those of the screen's modes.
const WINDOW_SIZES: [Resolution; 9] = [
    Resolution::new(800, 600),
    Resolution::new(1024, 768),
    Resolution::new(1280, 720),
    Resolution::new(1280, 800),
    Resolution::new(1280, 1024),
    Resolution::new(1600, 900),
    Resolution::new(1920, 1080),
    Resolution::new(2560, 1440),
    Resolution::new(3840, 2160),
];

/// Half as many pictures a second as the simulation has ticks.
const HALF: NonZeroU32 = NonZeroU32::new(30).expect("it is not zero");

/// The choices of the display.
#[derive(Resource, Clone, Debug, PartialEq, Eq)]
pub struct DisplayOffer {
    /// The size of the desktop in points, in which windows have room.
    pub desktop: Resolution,
    /// The present mode of the screen.
    pub screen: ScreenMode,
    /// The other modes of the screen.
    pub modes: Vec<ScreenMode>,
    /// The kinds of anti-aliasing, in rising order. `Off` is always offered.
    pub antialiasing: Vec<Antialiasing>,
    /// True if the processor draws.
    pub is_software: bool,
}

fn in_order<T: Ord>(mut choices: Vec<T>) -> Vec<T> {
    choices.sort_unstable();
    choices.dedup();
    choices
}

impl DisplayOffer {
    /// The settings of a user who has not chosen any: the report's recommendations, or settings that run smoothly where the
    /// processor draws.
    pub fn default_settings(&self) -> DisplaySettings {
        let recommended = DisplaySettings::default();
        let antialiasing = match self.is_software {
            true => Antialiasing::Off,
            false => recommended.antialiasing,
        };
        DisplaySettings {
            antialiasing,
            color_depth: self.screen.color_depth,
            ..recommended
        }
    }

    /// The sizes that can be chosen, in rising order.
    pub fn resolutions(&self, fullscreen: bool) -> Vec<Resolution> {
        let mut sizes: Vec<_> = self.all_modes().map(|mode| mode.resolution).collect();
        if !fullscreen {
            sizes.extend(WINDOW_SIZES);
            sizes.retain(|size| size.fits_into(self.desktop));
        }
        in_order(sizes)
    }

    /// The rates that can be chosen, in rising order. A window may be drawn less often than the screen.
    pub fn refresh_rates(&self, fullscreen: bool, resolution: Resolution) -> Vec<NonZeroU32> {
        let of_size = self
            .all_modes()
            .filter(|mode| mode.resolution == resolution);
        in_order(match fullscreen {
            true => of_size.map(|mode| mode.refresh_rate).collect(),
            false => vec![HALF, SIXTY, self.screen.refresh_rate],
        })
    }

    /// The colour depths that can be chosen, in rising order. A window has that of the desktop.
    pub fn color_depths(
        &self,
        fullscreen: bool,
        resolution: Resolution,
        refresh_rate: NonZeroU32,
    ) -> Vec<u16> {
        let alike = self
            .all_modes()
            .filter(|mode| (mode.resolution, mode.refresh_rate) == (resolution, refresh_rate));
        in_order(match fullscreen {
            true => alike.map(|mode| mode.color_depth).collect(),
            false => vec![self.screen.color_depth],
        })
    }

    fn all_modes(&self) -> impl Iterator<Item = &ScreenMode> {
        self.modes.iter().chain([&self.screen])
    }

    /// The nearest settings that the display offers, and the changes, a line each.
    pub fn nearest(&self, chosen: DisplaySettings) -> (DisplaySettings, Vec<String>) {
        let mut nearest = DisplaySettings {
            antialiasing: self.nearest_antialiasing(chosen.antialiasing),
            ..chosen
        };
        let mut changes = Vec::new();
        if nearest.antialiasing != chosen.antialiasing {
            changes.push(format!(
                "the graphics driver has no anti-aliasing of {}: it is {}",
                chosen.antialiasing, nearest.antialiasing
            ));
        }
        if chosen.fullscreen {
            let mode = self.nearest_mode(chosen);
            if mode != chosen.mode() {
                changes.push(format!(
                    "the screen cannot show {}: it shows {mode}",
                    chosen.mode()
                ));
            }
            nearest.resolution = mode.resolution;
            nearest.refresh_rate = mode.refresh_rate;
            nearest.color_depth = mode.color_depth;
        } else {
            let Resolution { width, height } = self.desktop;
            nearest.resolution.width = chosen.resolution.width.min(width);
            nearest.resolution.height = chosen.resolution.height.min(height);
            nearest.color_depth = self.screen.color_depth;
            if nearest.resolution != chosen.resolution {
                changes.push(format!(
                    "a window of {} has no room: it is {}",
                    chosen.resolution, nearest.resolution
                ));
            }
        }
        (nearest, changes)
    }

    fn nearest_mode(&self, chosen: DisplaySettings) -> ScreenMode {
        let difference = |mode: &&ScreenMode| {
            let rate = mode.refresh_rate.get();
            (
                mode.resolution.difference(chosen.resolution),
                rate.abs_diff(chosen.refresh_rate.get()),
                mode.color_depth.abs_diff(chosen.color_depth),
                **mode,
            )
        };
        *self
            .all_modes()
            .min_by_key(difference)
            .unwrap_or(&self.screen)
    }

    /// The next better one that is offered, or the best one. Where the processor draws, the next worse one: each point costs it time.
    fn nearest_antialiasing(&self, chosen: Antialiasing) -> Antialiasing {
        let offered = |candidate: &&Antialiasing| {
            **candidate == Antialiasing::Off || self.antialiasing.contains(candidate)
        };
        let mut worse = Antialiasing::ALL
            .iter()
            .rev()
            .filter(offered)
            .filter(|candidate| **candidate <= chosen);
        let mut better = Antialiasing::ALL
            .iter()
            .filter(offered)
            .filter(|candidate| **candidate >= chosen);
        let nearest = match self.is_software {
            true => worse.next(),
            false => better.next().or_else(|| worse.next()),
        };
        nearest.copied().unwrap_or_default()
    }
}
