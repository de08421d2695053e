//! The motion of a tick: its bodies and their poses.

use std::rc::Rc;

use bevy::prelude::*;
use bevy_rapier3d::parry::bounding_volume::{Aabb, BoundingVolume};
use tabletop_core::LimbId;
use tabletop_geometry::Pose;
use tabletop_physics::{Convex, Environment, SweptSolid, limits::REACH};

use tabletop_robot::{Articulation, Body, Carrier, Positions, Posture, TreePosition};

use crate::{motion::poses::Poses, owner::Owner, self_collision::SelfCollisionMatrix};

/// Number of answers that are remembered.
const MOST_ASKED: usize = 4;

/// An object in a gripper, as the arm carries it.
pub(crate) struct Carried {
    /// The object.
    pub object: Entity,
    /// Its pose in the end effector's frame.
    pub pose: Pose,
    /// Its mass in kg.
    pub mass: f64,
    /// Its convex parts, in its own frame.
    pub parts: Vec<Convex>,
}

/// The motion of a tick.
pub(crate) struct TickMotion<'a> {
    /// The robot.
    pub articulation: &'a Articulation,
    /// The pairs of its bodies that can collide.
    pub self_collisions: &'a SelfCollisionMatrix,
    /// Pose of its torso.
    pub base: Pose,
    /// Its surroundings.
    pub environment: Environment,
    /// True for each gripper that holds anything.
    pub holds: Vec<bool>,
    /// The objects that its grippers hold rigidly.
    pub carried: Vec<Vec<Carried>>,
    /// Positions of the joints, by [`JointId`](tabletop_core::JointId).
    pub positions: Positions,
    /// The obstacle that stopped each arm in this tick.
    pub blocked_by: Vec<Option<Owner>>,
    /// The object that each arm has squeezed so much in this tick that it waited.
    pub held_up_by: Vec<Option<Entity>>,
    /// True for each arm that was slowed in this tick by squeezing a free object.
    pub is_squeezing: Vec<bool>,
    /// True for each body that stands in an object, and pushes nothing.
    pub inside: Vec<bool>,
    /// True if it can meet anything.
    pub is_shown: bool,
    /// The last poses that were asked for.
    pub asked: Vec<Rc<Poses>>,
    /// Scratch space for a posture.
    pub scratch: Posture,
}

impl TickMotion<'_> {
    /// Pose of an end effector.
    pub fn end_effector(&mut self, limb: LimbId) -> Pose {
        self.here().end_effectors[limb.index()]
    }

    /// Poses of the robot at its present positions.
    pub fn here(&mut self) -> Rc<Poses> {
        let positions = std::mem::take(&mut self.positions);
        let here = self.poses(&positions);
        self.positions = positions;
        here
    }

    /// Poses of the robot. The last few answers are remembered, because most are asked for several times.
    pub fn poses(&mut self, positions: &Positions) -> Rc<Poses> {
        let is_asked = |poses: &&Rc<Poses>| poses.positions == *positions;
        if let Some(poses) = self.asked.iter().find(is_asked) {
            return Rc::clone(poses);
        }
        let poses = Rc::new(Poses::at(positions, self.articulation, &mut self.scratch));
        if self.asked.len() == MOST_ASKED {
            self.asked.remove(0);
        }
        self.asked.push(Rc::clone(&poses));
        poses
    }

    /// The numbers of the bodies of an arm.
    pub(super) fn bodies_of(&self, limb: LimbId) -> impl Iterator<Item = usize> {
        let bodies = self.articulation.bodies.iter().enumerate();
        bodies
            .filter(move |(_, body)| is_of(body, limb))
            .map(|(number, _)| number)
    }

    /// The solids of an arm and of the objects it holds where they are, each with the number of the body by which it meets things.
    pub fn solids(&mut self, limb: LimbId) -> Vec<(usize, SweptSolid<Owner>)> {
        let here = self.here();
        self.solids_of(limb, &here, &here, |_| true)
    }

    /// The solids of the needed bodies of an arm, and of the objects it holds.
    pub(super) fn solids_of(
        &self,
        limb: LimbId,
        from: &Poses,
        to: &Poses,
        is_needed: impl Fn(usize) -> bool,
    ) -> Vec<(usize, SweptSolid<Owner>)> {
        let mut solids = Vec::with_capacity(self.articulation.bodies.len());
        for number in self.bodies_of(limb).filter(|number| is_needed(*number)) {
            let parts = &self.articulation.bodies[number].parts;
            let [from, to] = [from, to].map(|poses| poses.bodies[number]);
            let moving = SweptSolid::moving(parts, Owner::Body(number), from, to);
            solids.extend(moving.map(|solid| (number, solid)));
        }
        let finger = self.finger(limb);
        for carried in &self.carried[limb.index()] {
            let [from, to] =
                [from, to].map(|poses| poses.end_effectors[limb.index()] * carried.pose);
            let moving = SweptSolid::moving(&carried.parts, Owner::Thing(carried.object), from, to);
            solids.extend(moving.map(|solid| (finger, solid)));
        }
        solids
    }

    /// The number of a finger of an arm.
    fn finger(&self, limb: LimbId) -> usize {
        let is_finger = |body: &Body| matches!(body.carrier, Carrier::Gripper(of, _) if of == limb);
        self.articulation
            .bodies
            .iter()
            .position(is_finger)
            .unwrap_or(0)
    }
}

/// A box around everything that the arms may meet in a tick.
pub(crate) fn reach(poses: impl Iterator<Item = Vec3>) -> Aabb {
    let mut bounds: Option<Aabb> = None;
    for at in poses {
        let around = Aabb::new(at - REACH, at + REACH);
        bounds = Some(bounds.map_or(around, |bounds| bounds.merged(&around)));
    }
    bounds.unwrap_or_else(Aabb::new_invalid)
}

/// True for a body of an arm.
pub(super) fn is_of(body: &Body, limb: LimbId) -> bool {
    matches!(body.place, TreePosition::Limb(of, _) if of == limb)
}
