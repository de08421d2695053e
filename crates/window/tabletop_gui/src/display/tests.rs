use std::num::NonZeroU32;

use super::*;
use bevy::prelude::*;
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
fn offered_settings_stay() {
    let (nearest, changes) = offer().nearest(settings());
    assert_eq!(nearest, settings());
    assert_eq!(changes, [""; 0]);
}

#[test]
fn other_settings_become_the_nearest_offered_and_are_reported() {
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
fn software_rendering_gets_no_antialiasing() {
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
    fn every_choice_is_offered(offer in offers(), fullscreen: bool) {
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
