//! Options for the display of the window.

use std::num::NonZeroU32;

use crate::window::{Antialiasing, DisplayOptions, Resolution};
use clap::{ArgAction, Args};

use super::range::NumberRange;

const REFRESH_RATES: NumberRange<NonZeroU32> = NumberRange::whole(
    NonZeroU32::MIN,
    NonZeroU32::new(1000).expect("it is not zero"),
)
.of("Hz");

const COLOR_DEPTHS: NumberRange<u16> = NumberRange::whole(1, 128).of("bits");

/// Missing options are as chosen in the display settings of the last run.
#[derive(Args)]
#[command(next_help_heading = "Display")]
pub(super) struct DisplayArgs {
    /// Ask for the display settings before the window opens
    #[arg(long, conflicts_with = "no_settings")]
    settings: bool,
    /// Do not ask for them; so does each of the following
    #[arg(long)]
    no_settings: bool,
    /// The size of the window in points (pixels, if the desktop is not scaled), or with --fullscreen that of the screen in pixels; sides from 1 to 16384
    #[arg(long, value_name = "WIDTHxHEIGHT")]
    resolution: Option<Resolution>,
    /// Fill the screen
    #[arg(long)]
    fullscreen: bool,
    /// Do not fill the screen
    #[arg(long, conflicts_with = "fullscreen")]
    windowed: bool,
    /// Wait for the screen, so that no picture is torn
    #[arg(long, value_name = "on|off", value_parser = on_or_off, action = ArgAction::Set)]
    vsync: Option<bool>,
    /// Pictures a second, at most: from 1 to 1000
    #[arg(long, value_name = "HZ", value_parser = REFRESH_RATES, allow_negative_numbers = true)]
    refresh: Option<NonZeroU32>,
    /// Bits of a pixel's colour, from 1 to 128, with --fullscreen
    #[arg(long, value_name = "BITS", value_parser = COLOR_DEPTHS, allow_negative_numbers = true, requires = "fullscreen")]
    color_depth: Option<u16>,
    /// Smooth edges: off, 2, 4 or 8
    #[arg(long, value_name = "N")]
    antialiasing: Option<Antialiasing>,
}

impl DisplayArgs {
    pub fn options(&self) -> DisplayOptions {
        let either = |yes: bool, no: bool| (yes || no).then_some(yes);
        DisplayOptions {
            resolution: self.resolution,
            fullscreen: either(self.fullscreen, self.windowed),
            vsync: self.vsync,
            refresh_rate: self.refresh,
            color_depth: self.color_depth,
            antialiasing: self.antialiasing,
            ask: either(self.settings, self.no_settings),
        }
    }
}

fn on_or_off(text: &str) -> Result<bool, String> {
    match text {
        "on" => Ok(true),
        "off" => Ok(false),
        _ => Err("expected on or off".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    #[derive(Parser)]
    struct CommandLine {
        #[command(flatten)]
        display: DisplayArgs,
    }

    fn options(words: &str) -> Option<DisplayOptions> {
        let words = ["tabletop"].into_iter().chain(words.split_whitespace());
        let line = CommandLine::try_parse_from(words).ok()?;
        Some(line.display.options())
    }

    #[test]
    fn every_option_is_read() {
        let none = DisplayOptions::default();
        for (words, expected) in [
            ("", none.clone()),
            (
                "--settings",
                DisplayOptions {
                    ask: Some(true),
                    ..none.clone()
                },
            ),
            (
                "--no-settings",
                DisplayOptions {
                    ask: Some(false),
                    ..none.clone()
                },
            ),
            (
                "--windowed",
                DisplayOptions {
                    fullscreen: Some(false),
                    ..none.clone()
                },
            ),
            (
                "--resolution 1280x800 --fullscreen --vsync off --refresh 75 --color-depth 16 --antialiasing 2",
                DisplayOptions {
                    resolution: Some(Resolution::new(1280, 800)),
                    fullscreen: Some(true),
                    vsync: Some(false),
                    refresh_rate: NonZeroU32::new(75),
                    color_depth: Some(16),
                    antialiasing: Some(Antialiasing::X2),
                    ask: None,
                },
            ),
        ] {
            assert_eq!(options(words), Some(expected), "{words}");
        }
    }

    #[test]
    fn invalid_display_options_are_refused() {
        for words in [
            "--settings --no-settings",
            "--fullscreen --windowed",
            "--resolution big",
            "--vsync maybe",
            "--refresh 0",
            "--antialiasing 3",
            "--color-depth 16",
        ] {
            assert_eq!(options(words), None, "{words}");
        }
    }
}
