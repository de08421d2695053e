//! What the robot pushes on its way.

use bevy::prelude::*;
use bevy_rapier3d::parry::bounding_volume::{Aabb, BoundingVolume};
use tabletop_core::LimbId;

use crate::{
    articulation::tree::Positions,
    clearance::{Owner, PRESSED, SweptSolid, are_near, part_left},
    motion::{environment::FreeObject, poses::Poses, tick_motion::TickMotion},
};

/// Least part of a tick's way that is made.
pub(super) const LEAST_PUSH: f64 = 0.05;

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
        let (mut part, mut most_pushed) = (1.0, None);
        for (i, thing) in self.environment.free.iter().enumerate() {
            let approaches = solids
                .iter()
                .filter(|(_, solid)| solid.passes(&thing.bounds))
                .flat_map(|(_, solid)| thing.solids().filter_map(|thing| solid.approach(&thing)));
            let mut can_go = 1.0_f32;
            let mut pushes = Vec::new();
            for approach in approaches {
                can_go = can_go.min(approach.part());
                pushes.extend(approach.is_push().then_some(approach));
            }
            let is_pushed = !pushes.is_empty();
            if is_pushed {
                let squeeze = self.environment.squeeze(i);
                can_go = can_go.min(part_left(squeeze));
                for push in pushes {
                    if self.environment.is_stopped(i, push.direction) {
                        can_go = can_go.min(push.part_pressing(squeeze));
                    }
                }
            }
            if can_go < part {
                (part, most_pushed) = (can_go, is_pushed.then_some(thing.object));
            }
        }
        let least = if most_pushed.is_some() {
            0.0
        } else {
            LEAST_PUSH
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
        let is_entered = |thing: &SweptSolid| {
            are_near(thing.bounds(), around)
                && solids.iter().any(|solid| solid.depth_in(thing) > PRESSED)
        };
        let environment = &self.environment;
        let mut free = environment.free.iter().flat_map(FreeObject::solids);
        environment.immovable.iter().any(is_entered) || free.any(|thing| is_entered(&thing))
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
