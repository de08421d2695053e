//! Momentum that an arm loses to objects that it pushes or drags along by friction.

use crate::dynamics::matrix::{Joints, dot};

/// A free object that an arm touches, along the normal of the contact, which points to it. It is pushed without bouncing.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ContactLoad {
    /// Speed of the arm towards it per rad/s of each joint, in m.
    pub lever: Joints,
    /// Its mass in kg.
    pub mass: f64,
    /// Its speed away from the arm, in m/s, negative towards it, at the end of the step if the arm were not there.
    pub speed: f64,
    /// The momentum, in N s, that friction and the things behind it can take from it in a step.
    pub resistance: f64,
    /// Friction between the two: the largest share of the pushing force that can act along the surface.
    pub friction: f64,
    /// Directions along the surface.
    pub slides: Vec<FrictionAxis>,
}

/// A direction along the surface of a touched object.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FrictionAxis {
    /// Speed of the arm in this direction per rad/s of each joint, in m.
    pub lever: Joints,
    /// Speed of the object in this direction, in m/s.
    pub speed: f64,
    /// The momentum, in N s, that its other contacts can give it against its motion in a step.
    pub resistance: f64,
}

/// The load of friction in a direction along the surface.
pub(super) struct FrictionLoad<'a> {
    /// The direction.
    pub slide: &'a FrictionAxis,
    /// Mass of the thing, in kg.
    mass: f64,
    /// Largest momentum in N s.
    most: f64,
}

/// Speed, in m/s, at which friction has its full strength.
const CREEP: f64 = 1e-4;

/// Speed, in m/s, below which a pushed object stands still.
const STANDSTILL: f64 = 0.005;

/// Largest momentum, in N s, that resistance of a contact can take.
const IMMOVABLE: f64 = 1e3;

impl ContactLoad {
    /// True if an arm with these velocities pushes it in vain.
    pub fn withstands(&self, velocities: &Joints) -> bool {
        let speed = dot(&self.lever, velocities);
        self.push(speed) > 0.0 && speed < STANDSTILL
    }

    /// The loads of friction when an arm pushes it as hard as it does with these velocities.
    pub(super) fn draws(&self, velocities: &Joints) -> impl Iterator<Item = FrictionLoad<'_>> {
        let most = self.friction * self.push(dot(&self.lever, velocities));
        let slides = self.slides.iter().filter(move |_| most > 0.0);
        slides.map(move |slide| FrictionLoad {
            slide,
            mass: self.mass,
            most,
        })
    }

    /// The momentum, in N s, that the arm loses to it if it approaches at this speed, in m/s.
    pub(super) fn push(&self, speed: f64) -> f64 {
        let slides = ((speed - self.speed.max(0.0)) / CREEP).clamp(0.0, 1.0);
        self.mass * (speed - self.speed).max(0.0) + self.resistance.min(IMMOVABLE) * slides
    }

    /// Increase of that momentum with the speed, in kg.
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
    /// The momentum, in N s, that the arm loses if it moves along at this speed, in m/s.
    pub(super) fn push(&self, speed: f64) -> f64 {
        self.needed(speed).clamp(-self.most, self.most)
    }

    /// Increase of that momentum with the speed, in kg.
    pub(super) fn felt_mass(&self, speed: f64) -> f64 {
        let sticks = speed.abs() < CREEP;
        match self.needed(speed).abs() < self.most {
            true if sticks => self.mass + self.slide.resistance.min(IMMOVABLE) / CREEP,
            true => self.mass,
            false => 0.0,
        }
    }

    /// The momentum that gives the object this speed.
    fn needed(&self, speed: f64) -> f64 {
        let rubs = (speed / CREEP).clamp(-1.0, 1.0);
        self.mass * (speed - self.slide.speed) + self.slide.resistance.min(IMMOVABLE) * rubs
    }
}
