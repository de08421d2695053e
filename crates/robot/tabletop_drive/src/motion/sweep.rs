//! Sweep: the joints go to their targets as far as nothing is in the way (report section 5).

use bevy::prelude::*;
use bevy_rapier3d::parry::bounding_volume::Aabb;
use tabletop_core::LimbId;
use tabletop_geometry::Pose;
use tabletop_physics::{
    SweptSolid, are_near,
    limits::{HALVINGS, LEAST_PART, MOST_SWEEPING_STEPS, SWEEPING_STEP},
};

use tabletop_robot::Positions;

use crate::{
    command::joint_targets::JointTargets, command::joint_targets::Setpoint,
    gripper::alignment::PRESS, gripper::closing::Closing, gripper::closing::Graspable,
    gripper::closing::close, gripper::finger_pad::FingerPad, motion::tick_motion::TickMotion,
    owner::Owner,
};

impl TickMotion<'_> {
    /// Turns the neck.
    pub fn turn_head(&mut self, targets: &JointTargets) {
        let layout = &self.articulation.layout;
        if let Some(neck) = layout.neck {
            let position = &mut self.positions[neck.index()];
            *position = targets.setpoint(layout, neck, *position).position();
        }
    }

    /// Moves the joints of an arm to their setpoints.
    pub fn move_arm(&mut self, limb: LimbId, setpoints: &[Setpoint]) {
        let joints = &self.articulation.layout.limb(limb).joints;
        let mut there = self.positions.clone();
        for (joint, setpoint) in joints.iter().zip(setpoints) {
            there[joint.index()] = setpoint.position();
        }
        if there == self.positions {
            return;
        }
        let jumps = setpoints
            .iter()
            .any(|setpoint| matches!(setpoint, Setpoint::Jump(_)));
        if jumps && self.obstacle(limb, &there).is_none() {
            self.positions = there;
            return;
        }
        let (part, pushed) = self.push(limb, &there);
        self.is_squeezing[limb.index()] = pushed.is_some();
        if part < LEAST_PART {
            self.held_up_by[limb.index()] = pushed;
            return;
        }
        self.blocked_by[limb.index()] = self.sweep(limb, lerp(&self.positions, &there, part));
    }

    /// Opens or closes a gripper, which may be pressing on objects that its fingers touch. Returns the objects found between them while closing.
    pub fn move_fingers(
        &mut self,
        limb: LimbId,
        targets: &JointTargets,
        is_pressing: bool,
    ) -> Closing {
        let layout = &self.articulation.layout;
        let joint = layout.limb(limb).gripper.joint;
        let [least, _] = layout.joint(joint).limits;
        let opening = self.positions[joint.index()];
        let setpoint = targets.setpoint(layout, joint, opening).position();
        let mut closing = Closing::default();
        let mut there = self.positions.clone();
        if setpoint > opening {
            there[joint.index()] = setpoint;
        } else if setpoint < opening && !self.holds[limb.index()] {
            let (end_effector, finger) =
                (self.end_effector(limb), layout.limb(limb).gripper.finger);
            let between = self.between(end_effector, opening as f32, finger);
            closing = close(end_effector, opening as f32, finger, &between);
            let press = if is_pressing { PRESS } else { 0.0 };
            let room = f64::from(closing.room) + press;
            there[joint.index()] = setpoint.max(opening - room).max(least);
        }
        if there == self.positions {
            return closing;
        }
        let (part, _) = self.push(limb, &there);
        if part >= LEAST_PART {
            self.sweep(limb, lerp(&self.positions, &there, part));
        }
        closing
    }

    /// Objects that may be between the fingers of a gripper.
    pub(super) fn between(
        &mut self,
        end_effector: Pose,
        opening: f32,
        finger: Vec3,
    ) -> Vec<Graspable> {
        let [near, at] = [
            FingerPad::space_between(opening, finger),
            end_effector.location,
        ];
        let axes = Mat3::from_quat(end_effector.rotation);
        let reach =
            axes.x_axis.abs() * near.x + axes.y_axis.abs() * near.y + axes.z_axis.abs() * near.z;
        let near = Aabb::new(at - reach, at + reach);
        let things = self.environment.free.iter();
        things
            .filter(|thing| are_near(&thing.bounds, &near))
            .map(|thing| Graspable {
                object: thing.object,
                parts: thing.solids.iter().map(SweptSolid::part).collect(),
            })
            .collect()
    }

    /// Goes towards these positions as far as no obstacle is in the way of an arm. Returns the obstacle.
    fn sweep(&mut self, limb: LimbId, there: Positions) -> Option<Owner> {
        let start = self.positions.clone();
        let between = |part: f64| lerp(&start, &there, part);
        let steps = (self.way(limb, &there) / SWEEPING_STEP)
            .ceil()
            .clamp(1.0, MOST_SWEEPING_STEPS);
        for step in 1..=steps as u32 {
            let ahead = f64::from(step) / f64::from(steps);
            let next = between(ahead);
            let Some(mut obstacle) = self.obstacle(limb, &next) else {
                self.positions = next;
                continue;
            };
            let (mut free, mut blocked) = (f64::from(step - 1) / f64::from(steps), ahead);
            for _ in 0..HALVINGS {
                let middle = (free + blocked) / 2.0;
                match self.obstacle(limb, &between(middle)) {
                    None => free = middle,
                    Some(nearer) => (blocked, obstacle) = (middle, nearer),
                }
            }
            self.positions = between(free);
            return Some(obstacle);
        }
        None
    }

    /// Approximate distance that the bodies of an arm go to some positions, in units.
    fn way(&mut self, limb: LimbId, there: &Positions) -> f32 {
        let (here, there) = (self.here(), self.poses(there));
        self.bodies_of(limb)
            .map(|number| (here.bodies[number], there.bodies[number]))
            .map(|(from, to)| {
                from.location.distance(to.location) + from.rotation.angle_between(to.rotation)
            })
            .fold(0.0, f32::max)
    }
}

/// Positions on the way between others.
fn lerp(from: &Positions, to: &Positions, part: f64) -> Positions {
    if part >= 1.0 {
        return to.clone();
    }
    let ways = from.iter().zip(to);
    ways.map(|(from, to)| from + (to - from) * part).collect()
}
