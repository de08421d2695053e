//! Distances of convex solids, for bodies that move without the physics engine.

use bevy::prelude::*;
use bevy_rapier3d::{parry::bounding_volume::BoundingVolume as _, rapier::prelude as rapier};
use tabletop_core::Pose;

use super::contact::contact;

/// A convex solid, with its pose in the frame of the whole that it belongs to.
#[derive(Clone, Debug)]
pub struct Convex {
    /// Pose of its own frame.
    pub pose: Pose,
    /// The solid, in its own frame.
    pub shape: rapier::SharedShape,
}

impl Convex {
    /// True if it is within a distance, in units, of another solid in the same frame.
    pub fn is_near(&self, other: &Self, within: f32) -> bool {
        let [at, other_at] = [self, other].map(|solid| to_rapier(solid.pose));
        let bounds = self.shape.compute_aabb(&at).loosened(within);
        bounds.intersects(&other.shape.compute_aabb(&other_at))
            && contact(&at, &*self.shape, &other_at, &*other.shape, within).is_some()
    }
}

/// The convex parts of a collider's shape.
pub fn convex_parts(pose: Pose, shape: &rapier::SharedShape) -> Vec<Convex> {
    match shape.as_compound() {
        Some(compound) => compound
            .shapes()
            .iter()
            .map(|(place, shape)| Convex {
                pose: pose * Pose::new(place.translation, place.rotation),
                shape: shape.clone(),
            })
            .collect(),
        None => vec![Convex {
            pose,
            shape: shape.clone(),
        }],
    }
}

/// The nearest points of a part of a moving body and an obstacle.
pub struct Nearest {
    /// Their distance; negative inside.
    pub distance: f32,
    /// Direction from the obstacle towards the moving body.
    pub away: Vec3,
}

/// The nearest points of each part of a moving body at a pose and each obstacle within a distance, in units.
pub fn nearest<'a>(
    body: &'a [Convex],
    at: Pose,
    obstacles: &'a [Convex],
    within: f32,
) -> impl Iterator<Item = Nearest> + 'a {
    body.iter().flat_map(move |part| {
        let part_at = to_rapier(at * part.pose);
        obstacles.iter().filter_map(move |obstacle| {
            let obstacle_at = to_rapier(obstacle.pose);
            contact(
                &part_at,
                &*part.shape,
                &obstacle_at,
                &*obstacle.shape,
                within,
            )
            .map(|contact| Nearest {
                distance: contact.dist,
                away: contact.normal2,
            })
        })
    })
}

/// A pose as Rapier has it.
pub fn to_rapier(pose: Pose) -> rapier::Pose {
    rapier::Pose::from_parts(pose.location, pose.rotation)
}
