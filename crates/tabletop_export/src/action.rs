//! The motions of hands between two frames.

use bevy::math::Vec3;
use tabletop_core::SimTick;
use tabletop_task::Demonstration;

use crate::{
    episode::FrameVectors,
    hand_track::{HANDS, HandTrack},
};

/// The motion of each hand from one frame to the next, in the table's frame: along X, Y and Z in units, about them in rad, and 1 if it
/// holds something in the next frame. The last frame has the grips of its own.
pub(crate) fn hand_motions(
    shown: &Demonstration,
    hands: &[HandTrack; 2],
    ticks: &[SimTick],
) -> FrameVectors {
    let parts = ["dx", "dy", "dz", "drx", "dry", "drz", "grip"];
    let names = HANDS
        .iter()
        .flat_map(|(hand, _)| parts.map(|part| format!("{hand}_hand.{part}")));
    let mut signal = FrameVectors::new(names.collect());
    for (frame, tick) in ticks.iter().enumerate() {
        let next = ticks.get(frame + 1).unwrap_or(tick);
        for hand in hands {
            let [from, to] = [tick, next].map(|tick| hand.pose(shown, *tick));
            let way = to.location - from.location;
            let keeps = hand.held(*tick).is_some() && hand.held(*tick) == hand.held(*next);
            let turn = match keeps {
                true => (to.rotation * from.rotation.inverse()).to_scaled_axis(),
                false => Vec3::ZERO,
            };
            signal.values.extend(way.to_array());
            signal.values.extend(turn.to_array());
            signal.values.push(hand.grip(*next));
        }
    }
    signal
}
