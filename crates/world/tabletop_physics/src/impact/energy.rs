//! Kinetic energy of bodies in an impact.

use bevy::math::DMat3;

use super::striker::{Striker, Velocity};

/// The kinetic energy of bodies with these velocities, in kg units²/s².
pub(super) fn energy(bodies: &[Striker], velocities: &[Velocity]) -> f64 {
    0.5 * product(bodies, velocities, velocities)
}

/// Brings velocities towards others with less energy until the bodies have no more than this.
pub(super) fn limit_energy(
    bodies: &[Striker],
    least: &[Velocity],
    velocities: &mut [Velocity],
    most: f64,
) {
    let ways = velocities.iter().zip(least);
    let ways: Vec<_> = ways
        .map(|(velocity, least)| Velocity {
            linear: velocity.linear - least.linear,
            angular: velocity.angular - least.angular,
        })
        .collect();
    let square = 0.5 * product(bodies, &ways, &ways);
    let half = 0.5 * product(bodies, least, &ways);
    let spare = most - energy(bodies, least);
    // square share² + 2 half share = spare
    let root = (half * half + square * spare).max(0.0).sqrt();
    let share = match square > 0.0 {
        true => ((root - half) / square).clamp(0.0, 1.0),
        false => 1.0,
    };
    for ((velocity, least), way) in velocities.iter_mut().zip(least).zip(ways) {
        *velocity = Velocity {
            linear: least.linear + way.linear * share,
            angular: least.angular + way.angular * share,
        };
    }
}

fn product(bodies: &[Striker], one: &[Velocity], other: &[Velocity]) -> f64 {
    let pairs = one.iter().zip(other);
    let products = bodies.iter().zip(pairs).map(|(body, (one, other))| {
        let inertia = match body.inverse_inertia.determinant() > 0.0 {
            true => body.inverse_inertia.inverse(),
            false => DMat3::ZERO,
        };
        let mass = if body.inverse_mass > 0.0 {
            body.inverse_mass.recip()
        } else {
            0.0
        };
        mass * one.linear.dot(other.linear) + one.angular.dot(inertia * other.angular)
    });
    products.sum()
}
