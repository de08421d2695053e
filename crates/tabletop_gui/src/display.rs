//! Display settings (report 2.3, figure 3), what the display offers, and what becomes of a choice that it does not offer.

use std::{fmt, num::NonZeroU32, str::FromStr};

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

/// Under which name the settings are kept between runs.
pub const CONCERN: &str = "display";

pub use crate::panels::display::{DisplayDialog, DisplayRequest, TITLE};

/// The size of a window in points, which are pixels where the desktop is not scaled, or of a screen in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Resolution {
    /// From left to right.
    pub width: u32,
    /// From top to bottom.
    pub height: u32,
}

/// How edges are smoothed: how many points of each pixel are looked at.
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

/// What the user chooses before the window opens.
#[derive(Resource, Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct DisplaySettings {
    /// The size of the window, or of the screen if the window fills it.
    pub resolution: Resolution,
    /// Whether the window fills the screen.
    pub fullscreen: bool,
    /// Whether a picture is only shown when the screen has shown the last one wholly.
    pub vsync: bool,
    /// Pictures a second, at most.
    pub refresh_rate: NonZeroU32,
    /// Bits of a pixel's colour, if the window fills the screen; else it has the desktop's.
    pub color_depth: u16,
    /// How edges are smoothed.
    pub antialiasing: Antialiasing,
    /// Whether the user is asked when the program starts.
    pub ask: bool,
}

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

/// What there is to choose from.
#[derive(Resource, Clone, Debug, PartialEq, Eq)]
pub struct DisplayOffer {
    /// The size of the desktop in points, in which windows have room.
    pub desktop: Resolution,
    /// How the screen is set now.
    pub screen: ScreenMode,
    /// What the screen can show instead.
    pub modes: Vec<ScreenMode>,
    /// How edges can be smoothed, in rising order. `Off` is always offered.
    pub antialiasing: Vec<Antialiasing>,
    /// Whether the processor draws.
    pub is_software: bool,
}

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

/// As many pictures a second as the simulation has ticks, which the report recommends, and half as many.
const SIXTY: NonZeroU32 = NonZeroU32::new(60).expect("it is not zero");
const HALF: NonZeroU32 = NonZeroU32::new(30).expect("it is not zero");

impl Resolution {
    /// So many pixels.
    pub const fn new(width: u32, height: u32) -> Self {
        Self { width, height }
    }

    const fn fits_into(self, other: Self) -> bool {
        self.width <= other.width && self.height <= other.height
    }

    /// How different two sizes are, in pixels.
    const fn difference(self, other: Self) -> u32 {
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
                format!("expected a width and a height of 1 to {MOST}, such as 1280x800")
            })
    }
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

fn in_order<T: Ord>(mut choices: Vec<T>) -> Vec<T> {
    choices.sort_unstable();
    choices.dedup();
    choices
}

impl DisplayOffer {
    /// What is chosen as long as the user has not chosen anything: the report's recommendations, or what is fluent where the
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

    /// The nearest to these settings that the display can do, and what had to be changed, a line each.
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::{collection, option, prelude::*, sample::select};

    fn hz(rate: u32) -> NonZeroU32 {
        NonZeroU32::new(rate).unwrap()
    }

    fn mode(width: u32, height: u32, rate: u32, color_depth: u16) -> ScreenMode {
        ScreenMode {
            resolution: Resolution::new(width, height),
            refresh_rate: hz(rate),
            color_depth,
        }
    }

    fn offer() -> DisplayOffer {
        DisplayOffer {
            desktop: Resolution::new(1920, 1080),
            screen: mode(1920, 1080, 144, 24),
            modes: vec![
                mode(1920, 1080, 60, 24),
                mode(1920, 1080, 144, 24),
                mode(1280, 1024, 75, 24),
                mode(640, 480, 60, 16),
            ],
            antialiasing: vec![Antialiasing::Off, Antialiasing::X4],
            is_software: false,
        }
    }

    fn settings() -> DisplaySettings {
        DisplaySettings {
            antialiasing: Antialiasing::Off,
            ..default()
        }
    }

    #[test]
    fn what_the_display_offers_stays() {
        let (nearest, changes) = offer().nearest(settings());
        assert_eq!(nearest, settings());
        assert_eq!(changes, [""; 0]);
    }

    #[test]
    fn what_it_does_not_offer_becomes_the_nearest_and_is_told() {
        let with = |change: fn(&mut DisplaySettings)| {
            let mut settings = settings();
            change(&mut settings);
            let (nearest, changes) = offer().nearest(settings);
            assert_eq!(changes.len(), 1, "{changes:?}");
            nearest
        };
        let nearest = with(|s| s.resolution = Resolution::new(4000, 700));
        assert_eq!(nearest.resolution, Resolution::new(1920, 700));
        let nearest = with(|s| s.antialiasing = Antialiasing::X2);
        assert_eq!(nearest.antialiasing, Antialiasing::X4);
        let nearest = with(|s| s.antialiasing = Antialiasing::X8);
        assert_eq!(nearest.antialiasing, Antialiasing::X4);
        let nearest = with(|s| {
            (s.fullscreen, s.resolution) = (true, Resolution::new(1300, 1000));
        });
        assert_eq!(nearest.mode(), mode(1280, 1024, 75, 24));
        let nearest = with(|s| {
            (s.fullscreen, s.refresh_rate) = (true, hz(120));
            s.resolution = Resolution::new(1920, 1080);
        });
        assert_eq!(nearest.mode(), mode(1920, 1080, 144, 24));
        let nearest = with(|s| {
            (s.fullscreen, s.resolution) = (true, Resolution::new(640, 480));
        });
        assert_eq!(nearest.mode(), mode(640, 480, 60, 16));
    }

    #[test]
    fn a_processor_that_draws_gets_what_it_draws_fluently() {
        let offer = DisplayOffer {
            is_software: true,
            ..offer()
        };
        assert_eq!(offer.default_settings().antialiasing, Antialiasing::Off);
        let chosen = DisplaySettings {
            antialiasing: Antialiasing::X2,
            ..settings()
        };
        assert_eq!(offer.nearest(chosen).0.antialiasing, Antialiasing::Off);
    }

    #[test]
    fn a_window_has_sizes_up_to_the_desktop_and_the_full_screen_its_modes() {
        let sizes = |fullscreen| {
            let sizes = offer().resolutions(fullscreen);
            sizes.iter().map(|size| size.width).collect::<Vec<_>>()
        };
        assert_eq!(sizes(true), [640, 1280, 1920]);
        assert_eq!(sizes(false), [640, 800, 1024, 1280, 1280, 1280, 1600, 1920]);
    }

    #[test]
    fn texts_are_read_back() {
        for antialiasing in Antialiasing::ALL {
            assert_eq!(antialiasing.to_string().parse(), Ok(antialiasing));
        }
        assert_eq!("8".parse(), Ok(Antialiasing::X8));
        assert!("3".parse::<Antialiasing>().is_err());
        let size = Resolution::new(1280, 800);
        assert_eq!("1280x800".parse(), Ok(size));
        assert_eq!(size.to_string().parse(), Ok(size));
        for wrong in ["1280", "x", "0x3", "1280x", "-3x4", "99999x2"] {
            assert!(wrong.parse::<Resolution>().is_err(), "{wrong}");
        }
    }

    fn modes() -> impl Strategy<Value = ScreenMode> {
        (1..5000u32, 1..5000u32, 1..300u32, select(vec![16, 24, 30]))
            .prop_map(|(width, height, rate, depth)| mode(width, height, rate, depth))
    }

    fn offers() -> impl Strategy<Value = DisplayOffer> {
        let antialiasing = proptest::sample::subsequence(Antialiasing::ALL.to_vec(), 0..=4);
        let all_modes = collection::vec(modes(), 0..6);
        (modes(), modes(), all_modes, antialiasing, any::<bool>()).prop_map(
            |(desktop, screen, modes, antialiasing, is_software)| DisplayOffer {
                desktop: desktop.resolution,
                screen,
                modes,
                antialiasing,
                is_software,
            },
        )
    }

    fn choices() -> impl Strategy<Value = DisplaySettings> {
        let antialiasing = select(Antialiasing::ALL.to_vec());
        let flags = any::<(bool, bool, bool)>();
        (modes(), option::of(Just(24)), antialiasing, flags).prop_map(
            |(mode, depth, antialiasing, (fullscreen, vsync, ask))| DisplaySettings {
                resolution: mode.resolution,
                refresh_rate: mode.refresh_rate,
                color_depth: depth.unwrap_or(mode.color_depth),
                fullscreen,
                vsync,
                antialiasing,
                ask,
            },
        )
    }

    proptest! {
        #[test]
        fn the_nearest_is_offered_and_is_its_own_nearest(offer in offers(), chosen in choices()) {
            let (nearest, changes) = offer.nearest(chosen);
            prop_assert_eq!(offer.nearest(nearest), (nearest, vec![]));
            prop_assert_eq!(nearest.fullscreen, chosen.fullscreen);
            if nearest.fullscreen {
                prop_assert!(offer.resolutions(true).contains(&nearest.resolution));
                prop_assert!(offer.refresh_rates(true, nearest.resolution).contains(&nearest.refresh_rate));
                let depths = offer.color_depths(true, nearest.resolution, nearest.refresh_rate);
                prop_assert!(depths.contains(&nearest.color_depth));
                let said = nearest != chosen;
                prop_assert_eq!(said, !changes.is_empty());
            } else {
                prop_assert!(nearest.resolution.fits_into(offer.desktop));
                prop_assert_eq!(nearest.refresh_rate, chosen.refresh_rate);
            }
            let antialiasing = nearest.antialiasing;
            prop_assert!(antialiasing == Antialiasing::Off || offer.antialiasing.contains(&antialiasing));
        }

        #[test]
        fn whatever_can_be_chosen_is_offered(offer in offers(), fullscreen: bool) {
            for resolution in offer.resolutions(fullscreen) {
                for refresh_rate in offer.refresh_rates(fullscreen, resolution) {
                    for color_depth in offer.color_depths(fullscreen, resolution, refresh_rate) {
                        let chosen = DisplaySettings {
                            resolution,
                            fullscreen,
                            refresh_rate,
                            color_depth,
                            ..settings()
                        };
                        prop_assert_eq!(offer.nearest(chosen), (chosen, vec![]));
                    }
                }
            }
        }
    }
}
