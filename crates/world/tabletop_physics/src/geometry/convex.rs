//! Distances of convex solids, for bodies that move without Rapier.

use bevy::prelude::*;
use bevy_rapier3d::{
    parry::bounding_volume::{Aabb, BoundingVolume as _},
    rapier::prelude as rapier,
};
use tabletop_geometry::Pose;

use crate::workarounds::contact::contact;

/// Number of pushes after which a body is left where it is: the obstacles that it is in leave no room.
const MOST_PUSHES: usize = 12;

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
        let near = self.bounds_at(self.pose).loosened(within);
        near.intersects(&other.bounds_at(other.pose))
            && contact(&at, &*self.shape, &other_at, &*other.shape, within).is_some()
    }

    /// The box around it if its own frame has this pose.
    pub fn bounds_at(&self, pose: Pose) -> Aabb {
        match self.shape.as_cylinder() {
            Some(cylinder) => bounds_of_cylinder(cylinder, pose),
            None => self.shape.compute_aabb(&to_rapier(pose)),
        }
    }
}

/// The box around a cylinder. Parry asks for six of its outermost points, which takes ten times as long.
fn bounds_of_cylinder(cylinder: &rapier::Cylinder, pose: Pose) -> Aabb {
    let axis = pose.rotation * Vec3::Y;
    let across = (Vec3::ONE - axis * axis).max(Vec3::ZERO).map(f32::sqrt);
    let half = cylinder.half_height * axis.abs() + cylinder.radius * across;
    Aabb::new(pose.location - half, pose.location + half)
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

/// The convex parts of a collider where it is, in the table's frame.
pub(crate) fn placed_parts(collider: &rapier::Collider) -> Vec<Convex> {
    let at = collider.position();
    convex_parts(
        Pose::new(at.translation, at.rotation),
        collider.shared_shape(),
    )
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

/// Depth of a body at a pose in obstacles, in units: that of its deepest part; 0 if it touches none.
pub fn depth(body: &[Convex], at: Pose, obstacles: &[Convex]) -> f32 {
    let depths = nearest(body, at, obstacles, 0.0).map(|nearest| -nearest.distance);
    depths.fold(0.0, f32::max)
}

/// The pose of a body that is pushed out of obstacles, each along the shortest way, where it is deeper in them than `deepest`, until it is
/// `left` deep, in units. `None` if there is no way out. Every direction of a push is added to `pushed`.
pub fn pushed_out(
    body: &[Convex],
    mut at: Pose,
    obstacles: &[Convex],
    [deepest, left]: [f32; 2],
    pushed: &mut Vec<Vec3>,
) -> Option<Pose> {
    for _ in 0..MOST_PUSHES {
        let deep = nearest(body, at, obstacles, 0.0)
            .min_by(|one, other| one.distance.total_cmp(&other.distance))
            .filter(|nearest| nearest.distance < -deepest);
        let Some(deep) = deep else {
            return Some(at);
        };
        at.location += deep.away * (-left - deep.distance);
        pushed.push(deep.away);
    }
    None
}

/// A pose as Rapier has it.
pub fn to_rapier(pose: Pose) -> rapier::Pose {
    rapier::Pose::from_parts(pose.location, pose.rotation)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_box_of_a_cylinder_is_the_one_that_parry_finds() {
        let part = Convex {
            pose: Pose::IDENTITY,
            shape: rapier::SharedShape::cylinder(1.5, 0.4),
        };
        for degrees in [Vec3::ZERO, Vec3::X * 90.0, Vec3::new(20.0, -35.0, 130.0)] {
            let pose = Pose::from_degrees(Vec3::new(1.0, -2.0, 3.0), degrees);
            let (bounds, parrys) = (
                part.bounds_at(pose),
                part.shape.compute_aabb(&to_rapier(pose)),
            );
            assert!(bounds.mins.distance(parrys.mins) < 1e-5, "{bounds:?}");
            assert!(bounds.maxs.distance(parrys.maxs) < 1e-5, "{bounds:?}");
        }
    }
}
