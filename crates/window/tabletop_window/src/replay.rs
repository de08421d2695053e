//! Recordings in the window.

use bevy::prelude::*;
use tabletop_core::{Playback, Timeline};
use tabletop_user::{Notices, Tone};

pub(super) fn plugin(app: &mut App) {
    app.add_systems(Update, announce_end.run_if(resource_changed::<Playback>));
}

/// Reports that the user can act at the end of an open recording.
fn announce_end(
    playback: Res<Playback>,
    timeline: Res<Timeline>,
    mut was_over: Local<bool>,
    mut notices: ResMut<Notices>,
) {
    let is_over = playback.is_over && !playback.loops;
    if is_over && !std::mem::replace(&mut *was_over, is_over) {
        let folder = timeline.folder.display();
        let over = format!("the replay of {folder} is over; you can go on from here");
        notices.add(Tone::Event, &over);
    }
    *was_over = is_over;
}
