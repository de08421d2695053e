//! Poses of the robot at some positions of its joints.

use bevy_rapier3d::parry::bounding_volume::Aabb;
use tabletop_geometry::Pose;

use tabletop_robot::{Articulation, Positions, Posture};

/// Margin of boxes around bodies, in units, for rounding errors.
pub(super) const ROUNDING: f32 = 1e-3;

/// Poses of the robot at some positions of its joints.
pub(crate) struct Poses {
    /// The positions.
    pub positions: Positions,
    /// Its bodies.
    pub bodies: Vec<Pose>,
    /// A box around each body in any orientation.
    pub around: Vec<Aabb>,
    /// Its end effectors, by [`LimbId`](tabletop_core::LimbId).
    pub end_effectors: Vec<Pose>,
}

impl Poses {
    /// The poses at these positions, to which a posture is brought.
    pub fn at(positions: &Positions, articulation: &Articulation, posture: &mut Posture) -> Self {
        articulation.update(posture, positions);
        let bodies = posture.bodies().to_vec();
        let around = bodies.iter().zip(&articulation.bodies);
        let around = around.map(|(at, body)| {
            let radius = body.radius + ROUNDING;
            Aabb::new(at.location - radius, at.location + radius)
        });
        Self {
            positions: positions.clone(),
            around: around.collect(),
            bodies,
            end_effectors: posture.end_effectors().to_vec(),
        }
    }
}
