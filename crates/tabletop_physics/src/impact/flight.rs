//! Flights: motions of bodies in a step up to the moment at which they meet something.

use bevy::math::DVec3;
use bevy_rapier3d::rapier::prelude::RigidBody;
use tabletop_core::TICK_SECONDS;

use super::graph::Velocity;
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
}

impl Flight {
    pub fn of(body: &RigidBody, velocity: Velocity, gravity: DVec3) -> Self {
        Self {
            velocity,
            acceleration: gravity * f64::from(body.gravity_scale()),
            until: f64::INFINITY,
            substep: TICK / substeps(body) as f64,
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

    /// Difference between the true velocity and Rapier's, in units/s. Its sub-steps accelerate a body before they move it, so its velocities are those of
    /// half a sub-step earlier.
    pub fn lag(self) -> DVec3 {
        match self.meets() {
            true => self.acceleration * (0.5 * self.substep),
            false => DVec3::ZERO,
        }
    }

    fn meets(self) -> bool {
        self.until > 0.0 && self.until <= TICK + self.substep
    }
}

/// The first time, in s, at which `gap = speed * time + acceleration * time² / 2`; infinite if there is none.
pub(super) fn time_to_close(gap: f64, speed: f64, acceleration: f64) -> f64 {
    if gap <= 0.0 && speed >= 0.0 {
        return 0.0;
    }
    let square = speed * speed + 2.0 * acceleration * gap;
    let sum = speed + square.max(0.0).sqrt();
    match square >= 0.0 && sum > 0.0 {
        true => 2.0 * gap / sum,
        false if acceleration > 0.0 => -2.0 * speed / acceleration,
        false => f64::INFINITY,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gap_closes_when_the_way_is_as_long() {
        for (gap, speed, acceleration) in [
            (1.0, 3.0, 0.0),
            (1.0, 0.0, 8.0),
            (0.2, -1.0, 9.0),
            (0.0, -2.0, 10.0),
        ] {
            let time = time_to_close(gap, speed, acceleration);
            let way = speed * time + 0.5 * acceleration * time * time;
            assert!(
                (way - gap).abs() < 1e-9 && time > 0.0,
                "{gap} {speed} {acceleration}"
            );
        }
        assert_eq!(time_to_close(0.0, 1.0, 0.0), 0.0);
        assert_eq!(time_to_close(1.0, -1.0, 0.0), f64::INFINITY);
    }
}
