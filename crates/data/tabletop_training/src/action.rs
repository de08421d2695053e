//! The motions of hands and end effectors between two frames.

use bevy::math::Vec3;
use tabletop_core::{JointRole, LimbId, SimTick};
use tabletop_geometry::Pose;
use tabletop_replay::Replay;
use tabletop_robot::{Articulation, Description, Positions};
use tabletop_task::Demonstration;

use crate::{
    episode::FrameVectors,
    error::EpisodeError,
    hand_track::{HANDS, HandTrack},
};

/// The parts of a motion.
const MOTION: [&str; 6] = ["dx", "dy", "dz", "drx", "dry", "drz"];

/// The motion of each hand from one frame to the next, in the table's frame: along X, Y and Z in units, about them in rad, and 1 if it
/// holds something in the next frame. The last frame has the grips of its own.
pub(crate) fn hand_motions(
    shown: &Demonstration,
    hands: &[HandTrack; 2],
    ticks: &[SimTick],
) -> FrameVectors {
    let parts = || MOTION.into_iter().chain(["grip"]);
    let names = HANDS
        .iter()
        .flat_map(|(hand, _)| parts().map(move |part| format!("{hand}_hand.{part}")));
    let mut signal = FrameVectors::new(names.collect());
    for (frame, tick) in ticks.iter().enumerate() {
        let next = ticks.get(frame + 1).unwrap_or(tick);
        for hand in hands {
            let [from, to] = [tick, next].map(|tick| hand.pose(shown, *tick));
            let keeps = hand.held(*tick).is_some() && hand.held(*tick) == hand.held(*next);
            let [way, turn] = motion(from, to);
            let turn = if keeps { turn } else { Vec3::ZERO };
            signal.values.extend(way.to_array());
            signal.values.extend(turn.to_array());
            signal.values.push(hand.grip(*next));
        }
    }
    signal
}

/// The motion of each end effector from one frame to the next, as for hands, and the opening that its gripper is ordered to have in the next
/// frame, in units. `joints` has the positions of all joints in each frame, `orders` those that they were ordered to have.
pub(crate) fn end_effector_motions(
    replay: &Replay,
    joints: &FrameVectors,
    orders: &FrameVectors,
) -> Result<FrameVectors, EpisodeError> {
    let unfit = |problem: String| EpisodeError::Unfit {
        recording: replay.folder().to_owned(),
        problem,
    };
    let description = replay.robot().description.clone();
    let description = description.map_or_else(Description::baxter, Ok);
    let description = description.map_err(|error| unfit(error.to_string()))?;
    let articulation = Articulation::new(description.model, description.layout);
    let articulation = articulation.map_err(|error| unfit(error.to_string()))?;
    let layout = &articulation.layout;
    let table = replay.recording().session().scene.table.unwrap_or_default();
    let base = layout.base.pose(&table);
    let columns: Option<Vec<_>> = layout
        .joints
        .iter()
        .map(|joint| {
            joints
                .names
                .iter()
                .position(|name| joint.name.as_str() == name)
        })
        .collect();
    let columns = columns.ok_or_else(|| unfit("its joints are not those of its robot".into()))?;
    let openings: Vec<_> = (0..)
        .take(layout.limbs.len())
        .map(|limb| {
            let is_its = |role| role == JointRole::Gripper(LimbId(limb));
            let joint = layout.joints.iter().position(|joint| is_its(joint.role))?;
            columns.get(joint).copied()
        })
        .collect();
    let names = layout
        .limbs
        .iter()
        .zip(&openings)
        .flat_map(|(limb, opening)| {
            let parts = MOTION.into_iter().chain(opening.map(|_| "opening"));
            parts.map(|part| format!("{}.{part}", limb.name))
        });
    let mut signal = FrameVectors::new(names.collect());
    let postures: Vec<_> = joints
        .frames()
        .map(|frame| {
            let positions: Positions = columns.iter().map(|i| f64::from(frame[*i])).collect();
            articulation
                .posture(&positions, base)
                .end_effectors()
                .to_vec()
        })
        .collect();
    let last = postures.len().saturating_sub(1);
    let orders: Vec<_> = orders.frames().collect();
    for (frame, end_effectors) in postures.iter().enumerate() {
        let next = (frame + 1).min(last);
        for ((from, to), opening) in end_effectors.iter().zip(&postures[next]).zip(&openings) {
            let [way, turn] = motion(*from, *to);
            signal.values.extend(way.to_array());
            signal.values.extend(turn.to_array());
            signal
                .values
                .extend(opening.map(|column| orders[next][column]));
        }
    }
    Ok(signal)
}

/// The way from one pose to another, in units, and the turn about X, Y and Z, in rad.
fn motion(from: Pose, to: Pose) -> [Vec3; 2] {
    let turn = (to.rotation * from.rotation.inverse()).to_scaled_axis();
    [to.location - from.location, turn]
}
