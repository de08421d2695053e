//! The one way for bodies that hands and robots move.

use bevy::{ecs::query::QueryData, prelude::*};
use bevy_rapier3d::prelude::*;
use tabletop_geometry::Pose;

use super::limits::JUMP;
use crate::{geometry::to_rapier, workarounds::short_turn::turn_to};

/// A body that a hand or a robot moves.
#[derive(QueryData)]
#[query_data(mutable)]
pub struct MovedBody {
    handle: Option<&'static RapierRigidBodyHandle>,
    transform: &'static mut Transform,
}

impl MovedBodyItem<'_, '_> {
    /// Its pose before the step.
    pub fn pose(&self) -> Pose {
        Pose::from(&*self.transform)
    }

    /// Sends it to a pose in the next step, pushing free objects in its way, unless it jumps. Its [`Transform`] follows after the step; it goes at
    /// once where Rapier does not move the body yet, because it was only just taken, is hidden or has no solids.
    pub fn send(&mut self, bodies: &mut Mut<RapierRigidBodySet>, pose: Pose) {
        if self.transform.translation.distance(pose.location) > JUMP {
            self.place(bodies, pose);
        }
        let moved = self.handle.filter(|handle| {
            let body = bodies.bodies.get(handle.0);
            body.is_some_and(|body| body.is_kinematic() && body.is_enabled())
        });
        match moved {
            Some(handle) => turn_to(bodies, handle.0, to_rapier(pose)),
            None => {
                self.transform.set_if_neq(pose.into());
            }
        }
    }

    /// Puts it at a pose at once, without pushing anything on the way.
    pub fn jump(&mut self, bodies: &mut Mut<RapierRigidBodySet>, pose: Pose) {
        self.transform.set_if_neq(pose.into());
        self.place(bodies, pose);
    }

    /// Puts it at a pose, asleep, if it meets nothing: Rapier leaves it out of its step.
    pub fn put_asleep(&mut self, bodies: &mut Mut<RapierRigidBodySet>, pose: Pose) {
        let Some(handle) = self.handle else {
            self.transform.set_if_neq(pose.into());
            return;
        };
        if let Some(body) = bodies.bodies.get_mut(handle.0) {
            body.set_position(to_rapier(pose), false);
            body.sleep();
        }
    }

    fn place(&self, bodies: &mut Mut<RapierRigidBodySet>, pose: Pose) {
        if let Some(handle) = self.handle
            && let Some(body) = bodies.bodies.get_mut(handle.0)
        {
            body.set_position(to_rapier(pose), true);
            body.set_next_kinematic_position(to_rapier(pose));
        }
    }
}
