//! A recording in the window.

use bevy::prelude::*;
use tabletop_core::SimTick;
use tabletop_gui::{Notices, Tone};

use crate::replay::{Player, Replay};

/// How many times as fast as it was what has led to the recording goes by, at most.
const HURRY: f32 = 50.0;

/// Plays a recording in the app of a window, and says when it is over.
pub(super) fn play(replay: &Replay, app: &mut App) {
    replay.play_in(app);
    let over = format!(
        "the replay of {} is over; you can go on from here",
        replay.folder().display()
    );
    let announce = move |mut notices: ResMut<Notices>| notices.add(Tone::News, &over);
    app.add_systems(
        Update,
        (
            hurry_to_the_start.run_if(not(is_over)),
            announce.run_if(is_over.and_then(run_once)),
        ),
    );
}

fn is_over(player: Res<Player>) -> bool {
    player.is_over()
}

/// Lets time fly until the recording begins.
fn hurry_to_the_start(player: Res<Player>, tick: Res<SimTick>, mut time: ResMut<Time<Virtual>>) {
    let left = player.start().0.saturating_sub(tick.0);
    time.set_relative_speed((left as f32 / 10.0).clamp(1.0, HURRY));
}
