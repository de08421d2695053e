//! The environment of a moved body: free objects, which it pushes, and immovable solids.

use std::collections::BTreeSet;

use bevy::prelude::*;
use bevy_rapier3d::{
    parry::bounding_volume::{Aabb, BoundingVolume},
    prelude::*,
};
use tabletop_core::{Joint, JointKind, TICK_SECONDS};

use super::{
    limits::{MARGIN, VICINITY},
    swept_solid::SweptSolid,
};
use crate::geometry::{Nearby, nearby};

/// A free object: one that can be pushed.
pub struct FreeObject {
    /// The object.
    pub object: Entity,
    /// Its solids, in the table's frame.
    pub solids: Vec<SweptSolid<Entity>>,
    /// The box around it.
    pub bounds: Aabb,
    /// The box that it can reach in this tick, with a margin.
    pub vicinity: Aabb,
    /// Velocity of its centre of mass, in units/s.
    pub velocity: Vec3,
    /// True while it sleeps.
    pub is_sleeping: bool,
}

/// The environment of a moved body.
#[derive(Default)]
pub struct Environment {
    /// Solids that nothing passes.
    pub immovable: Vec<SweptSolid<Entity>>,
    /// The free objects, in the order of their creation.
    pub free: Vec<FreeObject>,
    /// Pairs of objects that a joint lets overlap, in both orders.
    pass: BTreeSet<[Entity; 2]>,
}

impl Environment {
    /// The environment in a box.
    pub fn new<'a>(
        colliders: &RapierContextColliders,
        bodies: &RapierRigidBodySet,
        near: Aabb,
        is_met: impl Fn(Entity) -> bool,
        joints: impl Iterator<Item = &'a Joint>,
    ) -> Self {
        let mut environment = Self::default();
        for thing in nearby(colliders, bodies, near.loosened(MARGIN), is_met) {
            let parts = thing.parts().into_iter();
            let solids = parts.map(|part| SweptSolid::resting(part, thing.entity));
            if thing.body.is_dynamic() {
                environment.free.push(FreeObject {
                    object: thing.entity,
                    solids: solids.collect(),
                    bounds: thing.bounds,
                    vicinity: vicinity(&thing),
                    velocity: thing.body.linvel(),
                    is_sleeping: thing.body.is_sleeping(),
                });
            } else {
                environment.immovable.extend(solids);
            }
        }
        environment.pass = environment.pairs_that_pass(joints);
        environment
    }

    fn pairs_that_pass<'a>(
        &self,
        joints: impl Iterator<Item = &'a Joint>,
    ) -> BTreeSet<[Entity; 2]> {
        let free: BTreeSet<_> = self.free.iter().map(|it| it.object).collect();
        let passes = |joint: &&Joint| {
            let is_near = joint.objects.iter().any(|object| free.contains(object));
            is_near && !joint.collides && gives_way(joint.kind)
        };
        let pairs = joints.filter(passes).map(|joint| joint.objects);
        pairs
            .flat_map(|[one, other]| [[one, other], [other, one]])
            .collect()
    }

    /// True if joints let two objects be pushed into each other.
    pub(super) fn pass(&self, one: Entity, other: Entity) -> bool {
        self.pass.contains(&[one, other])
    }
}

/// The box that a body can reach in a tick, with a margin.
fn vicinity(thing: &Nearby) -> Aabb {
    let radius = thing.bounds.half_extents().length();
    let speed = thing.body.linvel().length() + radius * thing.body.angvel().length();
    thing.bounds.loosened(VICINITY + speed * TICK_SECONDS)
}

/// True if the objects of a joint can be pushed into each other: links of a chain, and objects pressed against a spring. With others, as with
/// a lid on its box, one would be pushed through the other.
fn gives_way(kind: JointKind) -> bool {
    match kind {
        JointKind::Ball | JointKind::PushButton { .. } | JointKind::Shears { .. } => true,
        JointKind::Slider { .. } | JointKind::Hinge { .. } | JointKind::Fixed => false,
    }
}
