//! The surroundings of the robot.

use std::collections::BTreeSet;

use bevy::prelude::*;
use bevy_rapier3d::{
    parry::bounding_volume::{Aabb, BoundingVolume},
    prelude::*,
};
use tabletop_core::{Joint, JointKind, TICK_SECONDS};
use tabletop_physics::{Convex, Nearby, nearby};

use crate::{
    articulation::link_entities::RobotLink,
    clearance::{MARGIN, Owner, SQUEEZE, SweptSolid, are_near},
};

/// Distance, in units, at which something is near: more than that at which the engine looks for contacts.
const VICINITY: f32 = 0.5;

/// Distance, in units, by which it is tried whether a free object can be pushed.
const PROBE: f32 = 0.05;

/// Least increase of a depth, in units, with which that meets anything.
const LEAST_STOP: f32 = 0.01;

/// A free object that the robot can push or take.
pub(crate) struct FreeObject {
    /// The object.
    pub object: Entity,
    /// Its convex parts, in the table's frame.
    pub parts: Vec<Convex>,
    /// The box around it.
    pub bounds: Aabb,
    /// The box of everything that it may come near in this tick.
    pub vicinity: Aabb,
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
                    vicinity: vicinity(&thing),
                    is_sleeping: thing.body.is_sleeping(),
                });
            } else {
                let solids = parts
                    .into_iter()
                    .map(|part| SweptSolid::resting(part, Owner::Thing(object)));
                environment.immovable.extend(solids);
            }
        }
        environment.pass = environment.pairs_that_pass(joints);
        environment
    }

    fn pairs_that_pass(&self, joints: &Query<&Joint>) -> BTreeSet<[Entity; 2]> {
        if joints.is_empty() || self.free.is_empty() {
            return BTreeSet::new();
        }
        let free: BTreeSet<_> = self.free.iter().map(|thing| thing.object).collect();
        let passes = |joint: &&Joint| {
            let is_near = joint.objects.iter().any(|object| free.contains(object));
            is_near && !joint.collides && gives_way(joint.kind)
        };
        let pairs = joints.iter().filter(passes).map(|joint| joint.objects);
        pairs
            .flat_map(|[one, other]| [[one, other], [other, one]])
            .collect()
    }

    /// Depth, in units, to which a free object, given by its number, and the objects that it pushes in turn, are squeezed into each other
    /// and into immovable solids.
    pub fn squeeze(&self, pushed: usize) -> f32 {
        let mut deepest = 0.0_f32;
        let mut cluster = vec![pushed];
        let mut next = 0;
        while let Some(&thing) = cluster.get(next) {
            next += 1;
            let thing = &self.free[thing];
            deepest = deepest.max(self.depth(thing, Vec3::ZERO));
            for (other, neighbour) in self.free.iter().enumerate() {
                if !cluster.contains(&other) && are_near(&neighbour.bounds, &thing.bounds) {
                    if !self.pass.contains(&[thing.object, neighbour.object]) {
                        deepest = deepest.max(depth_between(thing, Vec3::ZERO, neighbour));
                    }
                    cluster.push(other);
                }
            }
        }
        deepest
    }

    /// True if a free object, or what it is pressed against in turn, is squeezed more than a push may.
    pub fn is_crushed(&self, object: Entity) -> bool {
        let number = self.free.iter().position(|thing| thing.object == object);
        number.is_some_and(|number| self.squeeze(number) > SQUEEZE)
    }

    /// True if a free object, given by its number, cannot be pushed in a direction: it, or what it pushes in turn, would go into an immovable solid.
    pub fn is_stopped(&self, pushed: usize, direction: Vec3) -> bool {
        let by = direction * PROBE;
        let mut cluster = vec![pushed];
        let mut next = 0;
        while let Some(&thing) = cluster.get(next) {
            next += 1;
            let thing = &self.free[thing];
            if self.depth(thing, by) - self.depth(thing, Vec3::ZERO) > LEAST_STOP {
                return true;
            }
            for (other, neighbour) in self.free.iter().enumerate() {
                let is_pushed = !cluster.contains(&other)
                    && !self.pass.contains(&[thing.object, neighbour.object])
                    && depth_between(thing, by, neighbour)
                        > depth_between(thing, Vec3::ZERO, neighbour) + LEAST_STOP;
                if is_pushed {
                    cluster.push(other);
                }
            }
        }
        false
    }

    /// Depth, in units, of a shifted free object in immovable solids.
    fn depth(&self, thing: &FreeObject, by: Vec3) -> f32 {
        let passes = |obstacle: &SweptSolid| match obstacle.owner {
            Owner::Thing(other) => self.pass.contains(&[thing.object, other]),
            Owner::Body(_) => false,
        };
        let solids = thing.solids().map(|solid| solid.shifted(by));
        let depths = solids.flat_map(|solid| {
            let immovable = self.immovable.iter();
            immovable
                .filter(|obstacle| !passes(obstacle))
                .filter(|obstacle| are_near(obstacle.bounds(), solid.bounds()))
                .map(|obstacle| solid.depth_in(obstacle))
                .collect::<Vec<_>>()
        });
        depths.fold(0.0, f32::max)
    }
}

/// The box of everything that a body may come near in a tick.
fn vicinity(thing: &Nearby) -> Aabb {
    let radius = thing.bounds.half_extents().length();
    let speed = thing.body.linvel().length() + radius * thing.body.angvel().length();
    thing.bounds.loosened(VICINITY + speed * TICK_SECONDS)
}

/// Depth, in units, of a shifted free object in another.
fn depth_between(one: &FreeObject, by: Vec3, other: &FreeObject) -> f32 {
    let solids = one.solids().map(|one| one.shifted(by));
    solids
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
