//! Obstacles, which the robot cannot pass.

use bevy_rapier3d::parry::bounding_volume::BoundingVolume;
use tabletop_core::LimbId;
use tabletop_physics::{SweptSolid, are_near, limits::MARGIN};

use tabletop_robot::Positions;

use crate::{
    motion::poses::Poses, motion::poses::ROUNDING, motion::tick_motion::TickMotion,
    motion::tick_motion::is_of, owner::Owner,
};

impl TickMotion<'_> {
    /// An obstacle that an arm is inside of.
    pub fn is_inside(&mut self, limb: LimbId) -> Option<Owner> {
        let solids = self.solids(limb);
        let mut immovable = self.environment.immovable.iter();
        immovable
            .find(|obstacle| {
                solids
                    .iter()
                    .any(|(_, solid)| solid.depth_in(obstacle) > 0.0)
            })
            .map(|obstacle| Owner::Thing(obstacle.owner))
    }

    /// The obstacle in the way of an arm to some positions.
    pub(super) fn obstacle(&mut self, limb: LimbId, there: &Positions) -> Option<Owner> {
        if !self.is_shown {
            return None;
        }
        let (here, there) = (self.here(), self.poses(there));
        let solids = self.solids_of(limb, &here, &there, |number| {
            self.may_collide(limb, number, &here, &there)
        });
        let outside = solids.iter().find_map(|(_, solid)| {
            let mut immovable = self.environment.immovable.iter();
            immovable
                .find(|obstacle| solid.collides_with(obstacle, solid.owner.give()))
                .map(|obstacle| Owner::Thing(obstacle.owner))
        });
        outside.or_else(|| self.own_body(limb, &solids, &here))
    }

    /// True if a body of an arm, or an object it holds, may come near an obstacle on this way.
    fn may_collide(&self, limb: LimbId, number: usize, here: &Poses, there: &Poses) -> bool {
        if !self.carried[limb.index()].is_empty() {
            return true;
        }
        let around = &there.around[number];
        let mut immovable = self.environment.immovable.iter();
        let mut partners = self.self_collisions.partners(number).iter();
        immovable.any(|obstacle| are_near(obstacle.bounds(), around))
            || partners.any(|&other| {
                let bodies = &self.articulation.bodies;
                let poses = if is_of(&bodies[other], limb) {
                    there
                } else {
                    here
                };
                let reach = bodies[number].radius + bodies[other].radius + MARGIN + ROUNDING;
                let [at, other_at] = [there.bodies[number], poses.bodies[other]];
                at.location.distance_squared(other_at.location) < reach * reach
            })
    }

    /// The body of the robot that solids of an arm would collide with.
    fn own_body(
        &self,
        limb: LimbId,
        solids: &[(usize, SweptSolid<Owner>)],
        here: &Poses,
    ) -> Option<Owner> {
        for (i, (a, solid)) in solids.iter().enumerate() {
            let met = solids[..i].iter().find(|(b, other)| {
                self.self_collisions.can_meet(*a, *b) && solid.collides_with(other, 0.0)
            });
            if let Some((_, other)) = met {
                return Some(other.owner);
            }
        }
        let bounds = solids.iter().map(|(_, solid)| *solid.bounds());
        let bounds = bounds.reduce(|one, other| one.merged(&other))?;
        for (number, body) in self.articulation.bodies.iter().enumerate() {
            let around = &here.around[number];
            if is_of(body, limb) || !are_near(&bounds, around) {
                continue;
            }
            let may_meet = |(a, solid): &(usize, SweptSolid<Owner>)| {
                self.self_collisions.can_meet(*a, number) && are_near(solid.bounds(), around)
            };
            if !solids.iter().any(may_meet) {
                continue;
            }
            let pose = here.bodies[number];
            for other in SweptSolid::moving(&body.parts, Owner::Body(number), pose, pose) {
                let is_met = solids.iter().any(|(a, solid)| {
                    self.self_collisions.can_meet(*a, number) && solid.collides_with(&other, 0.0)
                });
                if is_met {
                    return Some(other.owner);
                }
            }
        }
        None
    }
}
