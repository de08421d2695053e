//! What an arm loses to what it pushes and to what friction draws along.

use crate::dynamics::matrix::{Joints, dot};

/// Something free that an arm touches, as it is along the normal of the contact, which points to it. It is pushed without bouncing.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ContactLoad {
    /// How fast the arm comes nearer to it per rad/s of each joint, in m.
    pub lever: Joints,
    /// Its mass in kg.
    pub mass: f64,
    /// How fast it goes away, in m/s, negative if it comes, at the end of the step if the arm were not there.
    pub speed: f64,
    /// The momentum in N s that friction and what is behind it can take from it in a step.
    pub resistance: f64,
    /// Friction between the two: the largest part of what the arm pushes with that can draw along the surface.
    pub friction: f64,
    /// Directions along the surface.
    pub slides: Vec<FrictionAxis>,
}

/// A direction along the surface of something that an arm touches.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FrictionAxis {
    /// How fast the arm goes this way per rad/s of each joint, in m.
    pub lever: Joints,
    /// How fast the thing goes this way, in m/s.
    pub speed: f64,
    /// The momentum in N s that what else it touches can give it against its motion in a step.
    pub resistance: f64,
}

/// A slide with what can be drawn there.
pub(super) struct FrictionLoad<'a> {
    /// The direction.
    pub slide: &'a FrictionAxis,
    /// Mass of the thing, in kg.
    mass: f64,
    /// Largest momentum in N s.
    most: f64,
}

/// Speed in m/s at which friction is at its full strength.
const CREEP: f64 = 1e-4;

/// Speed in m/s below which something pushed stands.
const STANDSTILL: f64 = 0.005;

/// Most momentum in N s that a touch can take by resistance.
const IMMOVABLE: f64 = 1e3;

impl ContactLoad {
    /// Whether an arm with these velocities pushes it in vain.
    pub fn withstands(&self, velocities: &Joints) -> bool {
        let speed = dot(&self.lever, velocities);
        self.push(speed) > 0.0 && speed < STANDSTILL
    }

    /// What can be drawn along by friction when an arm pushes it as hard as it does with these velocities.
    pub(super) fn draws(&self, velocities: &Joints) -> impl Iterator<Item = FrictionLoad<'_>> {
        let most = self.friction * self.push(dot(&self.lever, velocities));
        let slides = self.slides.iter().filter(move |_| most > 0.0);
        slides.map(move |slide| FrictionLoad {
            slide,
            mass: self.mass,
            most,
        })
    }

    /// The momentum in N s that the arm loses to it if it comes with this speed in m/s.
    pub(super) fn push(&self, speed: f64) -> f64 {
        let slides = ((speed - self.speed.max(0.0)) / CREEP).clamp(0.0, 1.0);
        self.mass * (speed - self.speed).max(0.0) + self.resistance.min(IMMOVABLE) * slides
    }

    /// By how much that grows with the speed, in kg.
    pub(super) fn felt_mass(&self, speed: f64) -> f64 {
        let moves = if speed > self.speed { self.mass } else { 0.0 };
        let from_rest = speed - self.speed.max(0.0);
        let sticks = from_rest > 0.0 && from_rest < CREEP;
        moves
            + if sticks {
                self.resistance.min(IMMOVABLE) / CREEP
            } else {
                0.0
            }
    }
}

impl FrictionLoad<'_> {
    /// The momentum in N s that the arm loses if it goes along with this speed in m/s.
    pub(super) fn push(&self, speed: f64) -> f64 {
        self.needed(speed).clamp(-self.most, self.most)
    }

    /// By how much that grows with the speed, in kg.
    pub(super) fn felt_mass(&self, speed: f64) -> f64 {
        let sticks = speed.abs() < CREEP;
        match self.needed(speed).abs() < self.most {
            true if sticks => self.mass + self.slide.resistance.min(IMMOVABLE) / CREEP,
            true => self.mass,
            false => 0.0,
        }
    }

    /// The momentum that it takes to give the thing this speed.
    fn needed(&self, speed: f64) -> f64 {
        let rubs = (speed / CREEP).clamp(-1.0, 1.0);
        self.mass * (speed - self.slide.speed) + self.slide.resistance.min(IMMOVABLE) * rubs
    }
}
