//! The surroundings of the robot.

use std::collections::BTreeSet;

use bevy::prelude::*;
use bevy_rapier3d::{
    parry::bounding_volume::{Aabb, BoundingVolume},
    prelude::*,
};
use tabletop_core::{Joint, JointKind};
use tabletop_physics::{Convex, nearby};

use crate::{
    articulation::link_entities::RobotLink,
    clearance::{MARGIN, Owner, SweptSolid, are_near},
};

/// A free object that the robot can push or take.
pub(crate) struct FreeObject {
    /// The object.
    pub object: Entity,
    /// Its convex parts, in the table's frame.
    pub parts: Vec<Convex>,
    /// The box around it.
    pub bounds: Aabb,
    /// True while it sleeps.
    pub is_sleeping: bool,
}

impl FreeObject {
    /// Its solids at their present place.
    pub fn solids(&self) -> impl Iterator<Item = SweptSolid> {
        let parts = self.parts.iter().cloned();
        parts.map(|part| SweptSolid::resting(part, Owner::Thing(self.object)))
    }
}

/// The surroundings of the robot, as far as they are near.
pub(crate) struct Environment {
    /// Solids that it cannot pass.
    pub immovable: Vec<SweptSolid>,
    /// Objects that it pushes, in the order of their creation.
    pub free: Vec<FreeObject>,
    /// Pairs of objects that joints let be pushed into each other; in both orders.
    pub pass: BTreeSet<[Entity; 2]>,
}

impl Environment {
    /// The surroundings in this box. A hidden robot meets nothing.
    pub fn new(
        rapier: &RapierContextMut,
        near: &Aabb,
        is_robot: &Query<(), With<RobotLink>>,
        held: &BTreeSet<Entity>,
        joints: &Query<&Joint>,
        is_shown: bool,
    ) -> Self {
        let mut environment = Self {
            immovable: Vec::new(),
            free: Vec::new(),
            pass: BTreeSet::new(),
        };
        if !is_shown {
            return environment;
        }
        for joint in joints {
            let [one, other] = joint.objects;
            if !joint.collides && gives_way(joint.kind) {
                environment.pass.extend([[one, other], [other, one]]);
            }
        }
        let near = near.loosened(MARGIN);
        let is_met = |object| !is_robot.contains(object) && !held.contains(&object);
        for thing in nearby(&rapier.colliders, &rapier.rigidbody_set, near, is_met) {
            let object = thing.entity;
            let parts = thing.parts();
            if thing.body.is_dynamic() {
                environment.free.push(FreeObject {
                    object,
                    parts,
                    bounds: thing.bounds,
                    is_sleeping: thing.body.is_sleeping(),
                });
            } else {
                let solids = parts
                    .into_iter()
                    .map(|part| SweptSolid::resting(part, Owner::Thing(object)));
                environment.immovable.extend(solids);
            }
        }
        environment
    }
}

impl Environment {
    /// Depth, in units, to which a free object, given by its number, and the objects that it pushes in turn, are squeezed into each other
    /// and into immovable solids.
    pub fn squeeze(&self, pushed: usize) -> f32 {
        let mut deepest = 0.0_f32;
        let mut cluster = vec![pushed];
        let mut next = 0;
        while let Some(&thing) = cluster.get(next) {
            next += 1;
            let FreeObject { object, bounds, .. } = &self.free[thing];
            for solid in self.free[thing].solids() {
                let immovable = self.immovable.iter();
                deepest = immovable
                    .filter(|obstacle| are_near(obstacle.bounds(), bounds))
                    .filter(|obstacle| match obstacle.owner {
                        Owner::Thing(other) => !self.pass.contains(&[*object, other]),
                        Owner::Body(_) => true,
                    })
                    .map(|obstacle| solid.depth_in(obstacle))
                    .fold(deepest, f32::max);
            }
            for (other, neighbour) in self.free.iter().enumerate() {
                if !cluster.contains(&other) && are_near(&neighbour.bounds, bounds) {
                    if !self.pass.contains(&[*object, neighbour.object]) {
                        let depth = depth_between(&self.free[thing], neighbour);
                        deepest = deepest.max(depth);
                    }
                    cluster.push(other);
                }
            }
        }
        deepest
    }
}

fn depth_between(one: &FreeObject, other: &FreeObject) -> f32 {
    one.solids()
        .flat_map(|one| other.solids().map(move |other| one.depth_in(&other)))
        .fold(0.0, f32::max)
}

/// True if the objects of a joint can be pushed into each other: links of a chain, and what is pressed against a spring. With others, as with
/// a lid on its box, one would be pushed through the other.
fn gives_way(kind: JointKind) -> bool {
    match kind {
        JointKind::Ball | JointKind::PushButton { .. } | JointKind::Shears { .. } => true,
        JointKind::Slider { .. } | JointKind::Hinge { .. } | JointKind::Fixed => false,
    }
}
