//! Flights: motions of bodies in a step up to the moment at which they meet something.

use bevy::math::DVec3;
use bevy_rapier3d::rapier::prelude::RigidBody;
use tabletop_core::TICK_SECONDS;

use super::striker::Velocity;
use crate::effort::substeps;

/// Duration of a tick, in s.
pub(super) const TICK: f64 = TICK_SECONDS as f64;

/// The flight of a body in a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flight {
    /// Velocity at the beginning of the step.
    pub velocity: Velocity,
    /// In units/s².
    pub acceleration: DVec3,
    /// Time, in s, until the body meets something; 0 if it touches something.
    pub until: f64,
    /// Duration of a sub-step, in s.
    pub substep: f64,
    /// True if joints hold the body.
    pub is_jointed: bool,
}

impl Flight {
    pub fn of(body: &RigidBody, velocity: Velocity, gravity: DVec3, is_jointed: bool) -> Self {
        Self {
            velocity,
            acceleration: gravity * f64::from(body.gravity_scale()),
            until: f64::INFINITY,
            substep: TICK / substeps(body) as f64,
            is_jointed,
        }
    }

    /// Velocity at the moment of meeting.
    pub fn last(self) -> Velocity {
        let Velocity { linear, angular } = self.velocity;
        let gained = match self.meets() {
            true => self.acceleration * self.until + self.lag(),
            false => DVec3::ZERO,
        };
        Velocity {
            linear: linear + gained,
            angular,
        }
    }

    /// Difference between the true velocity and Rapier's, in units/s, if the body meets something.
    pub fn lag(self) -> DVec3 {
        match self.meets() {
            true => self.lag_of_free(),
            false => DVec3::ZERO,
        }
    }

    /// The same of a body that touches nothing. Rapier's sub-steps accelerate a body before they move it, so its velocities are those of half a sub-step
    /// earlier.
    pub fn lag_of_free(self) -> DVec3 {
        self.acceleration * (0.5 * self.substep)
    }

    /// True if the body touches nothing at first, and meets something in the step.
    pub fn meets(self) -> bool {
        self.until > 0.0 && self.until <= TICK + self.substep
    }
}
