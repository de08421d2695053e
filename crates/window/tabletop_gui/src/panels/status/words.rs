//! The values of the Status window in words.

use std::time::Duration;

use bevy_egui::egui::RichText;
use tabletop_core::{Agent, History, TICKS_PER_SECOND};

use super::model::{FilmState, Model, Renderer};
use crate::widgets::style::ThemeColors;

/// Pictures a second. Of a still picture their number says nothing.
pub(super) fn frames(model: &Model) -> String {
    match (model.is_still, model.mean.fps) {
        (true, _) => "at rest".into(),
        (false, Some(fps)) => format!("{fps:03.0}"),
        (false, None) => "…".into(),
    }
}

/// The simulated time, and its pace.
pub(super) fn simulated(model: &Model) -> String {
    let seconds = model.tick.0 as f64 / f64::from(TICKS_PER_SECOND);
    match (model.is_paused, model.is_resting) {
        (true, _) => format!("{seconds:.1} s, paused"),
        (false, true) => format!("at rest since {seconds:.1} s"),
        (false, false) => format!("{seconds:.1} s, {:.2} × real time", model.mean.pace),
    }
}

/// The state of the script, in words.
pub(super) fn matlab(agent: &Agent, call: Option<Duration>) -> String {
    match (agent, call) {
        (Agent::Off, _) => "offline".into(),
        (Agent::Starting, _) => "starting".into(),
        (Agent::Online { .. }, None) => "online".into(),
        (Agent::Online { .. }, Some(call)) => {
            format!("online, {:.1} ms a call", call.as_secs_f64() * 1e3)
        }
        (Agent::Waiting { since }, _) => {
            format!("waiting for script {:.1} s", since.as_secs_f64())
        }
        (Agent::Failed, _) => "stopped by an error".into(),
    }
}

/// The state of recordings.
pub(super) fn recording(film: &FilmState) -> String {
    match film {
        FilmState::None => "not recording".into(),
        FilmState::Recorded {
            folder,
            segment,
            frame,
        } => format!("segment {segment}, frame {frame} in {}", folder.display()),
        FilmState::Replayed => "a recording is played".into(),
    }
}

/// The number of segments that can be undone, and the memory that they take.
pub(super) fn undo(history: &History) -> String {
    const MEGABYTE: usize = 1024 * 1024;
    let [used, most] = [history.bytes, history.most_bytes].map(|bytes| bytes.div_ceil(MEGABYTE));
    let segments = match history.undoable {
        1 => "1 segment".to_owned(),
        count => format!("{count} segments"),
    };
    let memory = format!("{segments}, {used} of {most} MB");
    match history.dropped {
        0 => memory,
        dropped => format!("{memory}; the first {dropped} are kept no longer"),
    }
}

/// The renderer, which stands out if it is slow.
pub(super) fn words_for(renderer: &Renderer, colors: &ThemeColors) -> RichText {
    match renderer.is_software {
        true => {
            RichText::new(format!("software renderer ({})", renderer.name)).color(colors.warning)
        }
        false => renderer.name.as_str().into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn ms(ms: u64) -> Duration {
        Duration::from_millis(ms)
    }

    #[test]
    fn the_script_has_words_for_all_that_it_does() {
        for (agent, call, words) in [
            (Agent::Off, None, "offline"),
            (Agent::Online { took: ms(9) }, None, "online"),
            (
                Agent::Online { took: ms(9) },
                Some(ms(1)),
                "online, 1.0 ms a call",
            ),
            (
                Agent::Waiting { since: ms(3210) },
                None,
                "waiting for script 3.2 s",
            ),
        ] {
            assert_eq!(matlab(&agent, call), words);
        }
    }

    #[test]
    fn the_memory_of_undo_and_dropped_segments_are_reported() {
        let mut history = History {
            undoable: 12,
            bytes: 3_500_000,
            most_bytes: 512 * 1024 * 1024,
            ..History::default()
        };
        assert_eq!(undo(&history), "12 segments, 4 of 512 MB");
        history.dropped = 5;
        let reported = "12 segments, 4 of 512 MB; the first 5 are kept no longer";
        assert_eq!(undo(&history), reported);
    }
}
