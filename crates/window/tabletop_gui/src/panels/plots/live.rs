//! The curves of the world as it goes on.

use std::collections::BTreeMap;

use bevy::prelude::*;
use tabletop_core::{Idle, ObjectIndex, ObjectSpec, Robot, RobotLayout, SimTick, TICKS_PER_SECOND};
use tabletop_geometry::{Pose, Twist};
use tabletop_user::{Curves, Quantity};

use crate::panels::{Panel, Panels};

/// The time that is kept, in seconds.
const SPAN: f64 = 60.0;

/// The most objects of which curves are kept.
const MOST_OBJECTS: usize = 100;

/// The curves of the last minute, as long as the window is open.
#[derive(Resource, Default)]
pub(super) struct LiveCurves {
    curves: Curves,
    /// The tick that was sampled last.
    last: SimTick,
}

impl LiveCurves {
    pub fn curves(&self) -> &Curves {
        &self.curves
    }
}

/// Takes in the state after the last tick, once a frame. No system of a tick does this: a world at rest would run for it.
pub(super) fn sample(
    mut live: ResMut<LiveCurves>,
    panels: Res<Panels>,
    tick: Res<SimTick>,
    idle: Res<Idle>,
    index: Res<ObjectIndex>,
    objects: Query<(&ObjectSpec, &Transform, Option<&Twist>)>,
    robot: Option<Res<Robot>>,
    layout: Option<Res<RobotLayout>>,
) {
    if !panels.is_open(Panel::Plots) {
        if live.last != SimTick::default() {
            *live = LiveCurves::default();
        }
        return;
    }
    // At rest all stays as it was; the next sample says so.
    let has_samples = live.last != SimTick::default();
    if *tick == live.last || (has_samples && *idle != Idle(0)) {
        return;
    }
    let LiveCurves { curves, last } = &mut *live;
    if *tick < *last {
        // Undo, or another world.
        *curves = Curves::default();
    }
    let seconds = |tick: u64| tick as f64 / f64::from(TICKS_PER_SECOND);
    let (hold, now) = (seconds(last.0), seconds(tick.0));
    *last = *tick;
    let mut add = |quantity, name: &str, value: f64| {
        curves.add(quantity, name, hold, [now, value]);
    };
    for id in index.ids().take(MOST_OBJECTS) {
        let Some((_, place, twist)) = index.get(id).and_then(|object| objects.get(object).ok())
        else {
            continue;
        };
        add_pose(&mut add, id, Pose::from(place));
        let speed = twist.map_or(0.0, |twist| twist.linear.length());
        add(Quantity::Speeds, id, speed.into());
    }
    if let (Some(robot), Some(layout)) = (robot, layout)
        && robot.is_shown
    {
        add_robot(&mut add, &robot, &layout);
        let id_of = |thing| objects.get(thing).ok().map(|(spec, ..)| spec.id.clone());
        for (thing, impulse) in impulses(&robot, id_of) {
            add(Quantity::Contacts, &thing, impulse);
        }
    }
    curves.forget_before(now - SPAN);
}

fn add_pose(add: &mut impl FnMut(Quantity, &str, f64), id: &str, pose: Pose) {
    let values = [
        (Quantity::Places, pose.location),
        (Quantity::Angles, pose.degrees()),
    ];
    for (quantity, vector) in values {
        for (axis, value) in ["X", "Y", "Z"].into_iter().zip(vector.to_array()) {
            add(quantity, &format!("{id} {axis}"), value.into());
        }
    }
}

fn add_robot(add: &mut impl FnMut(Quantity, &str, f64), robot: &Robot, layout: &RobotLayout) {
    for (joint, state) in layout.joints.iter().zip(&robot.joints) {
        let name = joint.name.to_string();
        if joint.is_gripper() {
            add(Quantity::Grippers, &name, state.position);
            continue;
        }
        add(Quantity::Joints, &name, state.position);
        add(Quantity::JointVelocities, &name, state.velocity);
        add(Quantity::Torques, &name, state.torque);
    }
}

/// The impulses of the robot on each thing that it touches, by name.
fn impulses(robot: &Robot, id_of: impl Fn(Entity) -> Option<String>) -> BTreeMap<String, f64> {
    let mut impulses = BTreeMap::new();
    for contact in &robot.contacts {
        let thing = id_of(contact.thing).unwrap_or_else(|| "the table".into());
        *impulses.entry(thing).or_default() += f64::from(contact.impulse);
    }
    impulses
}
