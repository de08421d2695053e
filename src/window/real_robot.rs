//! A real robot that is followed: the reason why it is followed no longer.

use bevy::prelude::*;
use tabletop_core::RestApp as _;
use tabletop_gui::{Notices, Tone};

use crate::real::RealRobot;

pub(super) fn plugin(app: &mut App) {
    // It moves by itself.
    app.wake_while(is_followed).add_systems(Update, note_end);
}

fn is_followed(real: Option<Res<RealRobot>>) -> bool {
    real.is_some_and(|real| real.end().is_none())
}

fn note_end(real: Option<Res<RealRobot>>, mut notices: ResMut<Notices>) {
    if let Some(end) = real.as_ref().and_then(|real| real.end()) {
        notices.add(Tone::Fault, &format!("the real robot: {end}"));
    }
}
