//! Objects that the robot pushes on its way.

use bevy::prelude::*;
use bevy_rapier3d::parry::bounding_volume::{Aabb, BoundingVolume};
use tabletop_core::LimbId;
use tabletop_physics::{
    SweptSolid, are_near,
    limits::{LEAST_PART, PRESSED},
};

use tabletop_robot::Positions;

use crate::{motion::poses::Poses, motion::tick_motion::TickMotion, owner::Owner};

impl TickMotion<'_> {
    /// The part of the way to these positions that an arm can go in a tick with the objects that it pushes, and the object that it squeezes most.
    pub(super) fn push(&mut self, limb: LimbId, there: &Positions) -> (f64, Option<Entity>) {
        if self.environment.free.is_empty() {
            return (1.0, None);
        }
        let (here, there) = (self.here(), self.poses(there));
        let mut solids = self.solids_of(limb, &here, &there, |number| {
            let way = here.around[number].merged(&there.around[number]);
            let mut free = self.environment.free.iter();
            free.any(|thing| are_near(&way, &thing.bounds))
        });
        solids.retain(|(_, solid)| !self.stands_inside(solid.owner));
        let solids: Vec<_> = solids.into_iter().map(|(_, solid)| solid).collect();
        let (part, most_pushed) = self.environment.part(&solids);
        let least = if most_pushed.is_some() {
            0.0
        } else {
            LEAST_PART
        };
        (f64::from(part).max(least), most_pushed)
    }

    /// True for a body that stands in an object.
    fn stands_inside(&self, owner: Owner) -> bool {
        match owner {
            Owner::Body(number) => self.inside.get(number).copied().unwrap_or(false),
            Owner::Thing(_) => false,
        }
    }

    /// True if a body is deeper in an object than it presses into one that cannot give way.
    pub fn is_inside_object(&self, number: usize, poses: &Poses) -> bool {
        let around = &poses.around[number];
        let parts = &self.articulation.bodies[number].parts;
        let pose = poses.bodies[number];
        let solids: Vec<_> = SweptSolid::moving(parts, Owner::Body(number), pose, pose).collect();
        let is_entered = |thing: &SweptSolid<Entity>| {
            are_near(thing.bounds(), around)
                && solids.iter().any(|solid| solid.depth_in(thing) > PRESSED)
        };
        let environment = &self.environment;
        let mut free = environment.free.iter().flat_map(|thing| &thing.solids);
        environment.immovable.iter().any(is_entered) || free.any(is_entered)
    }

    /// True if a body comes near no free object on its way from some poses to others.
    pub fn is_far(&self, number: usize, from: &Poses, to: &Poses) -> bool {
        if self.environment.free.is_empty() {
            return true;
        }
        let way = from.around[number].merged(&to.around[number]);
        let [from, to] = [from, to].map(|poses| poses.bodies[number]);
        let parts = &self.articulation.bodies[number].parts;
        let free = self.environment.free.iter();
        let mut near = free.filter(|thing| way.intersects(&thing.vicinity));
        near.all(|thing| {
            let mut solids = SweptSolid::moving(parts, Owner::Body(number), from, to);
            solids.all(|solid| !solid.passes(&thing.vicinity))
        })
    }

    /// True if a solid of an arm is near this box at present.
    pub fn is_near(&mut self, limb: LimbId, bounds: &Aabb) -> bool {
        let here = self.here();
        let may_be_near = |number: usize| are_near(&here.around[number], bounds);
        let solids = self.solids_of(limb, &here, &here, may_be_near);
        solids
            .iter()
            .any(|(_, solid)| are_near(solid.bounds(), bounds))
    }
}
