//! Seams of fixed objects that lie flush beside each other.
//!
//! Rapier looks at one pair at a time. A body that slides over a seam seems to it to run into the side of the next object, which is covered by the one
//! before: it is stopped, and hops. Such contacts are left out.

use std::collections::BTreeMap;

use bevy::{ecs::query::QueryData, prelude::*};
use bevy_rapier3d::{parry::query::intersection_test, prelude::*, rapier::prelude as rapier};

/// Distance, in units, within which faces lie flush, and points in a face.
const SLOP: f32 = 0.01;

/// Way, in units, on which a surface has to go on beyond a seam.
const BEYOND: f32 = 0.05;

/// Cosine of the angle, some 1°, within which directions are the same.
const SAME: f32 = 0.9998;

/// A cuboid of a fixed object, in the frame of the world.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Slab {
    at: rapier::Pose,
    half: Vec3,
}

impl Slab {
    /// Those of a collider.
    fn all_of(collider: &rapier::Collider) -> Vec<Self> {
        let at = *collider.position();
        let slab = |at, shape: &dyn rapier::Shape| {
            let half = shape.as_cuboid()?.half_extents;
            Some(Self { at, half })
        };
        match collider.shape().as_compound() {
            Some(parts) => {
                let parts = parts.shapes().iter();
                let slabs = parts.filter_map(|(place, shape)| slab(at * *place, &**shape));
                slabs.collect()
            }
            None => slab(at, collider.shape()).into_iter().collect(),
        }
    }

    /// The outward normals of its faces, and a point of each.
    fn faces(&self) -> [(Vec3, Vec3); 6] {
        let sides = [1.0, -1.0].into_iter();
        let normals = sides.flat_map(|side| Vec3::AXES.map(|axis| side * axis));
        let mut faces = [(Vec3::ZERO, Vec3::ZERO); 6];
        for (face, normal) in faces.iter_mut().zip(normals) {
            let normal_here = self.at.rotation * normal;
            *face = (normal_here, self.at * (normal * self.half));
        }
        faces
    }

    fn contains(&self, point: Vec3) -> bool {
        let point = self.at.inverse_transform_point(point);
        point.abs().cmple(self.half + SLOP).all()
    }

    fn touches(&self, other: &Self) -> bool {
        let wide = rapier::Cuboid::new(self.half + SLOP);
        let narrow = rapier::Cuboid::new(other.half);
        intersection_test(&self.at, &wide, &other.at, &narrow).unwrap_or(false)
    }

    /// True if it touches another one, and a face of the one continues a face of the other.
    fn is_flush_with(&self, other: &Self) -> bool {
        let continues = |(normal, point): (Vec3, Vec3)| {
            other.faces().iter().any(|(other, at)| {
                normal.dot(*other) > SAME && (point - at).dot(normal).abs() <= SLOP
            })
        };
        self.touches(other) && self.faces().into_iter().any(continues)
    }

    /// True if its surface goes on past a point in which something is pushed in a direction: so nothing can be there that is pushed.
    fn covers(&self, point: Vec3, push: Vec3) -> bool {
        self.faces().into_iter().any(|(normal, at)| {
            let along = push.reject_from(normal);
            (point - at).dot(normal).abs() <= SLOP
                && push.dot(normal) < SAME
                && self.contains(point)
                && along.length() > 1.0 - SAME
                && self.contains(point + BEYOND * along.normalize())
        })
    }
}

/// The seams of the fixed objects.
#[derive(Resource, Clone, Default)]
pub(crate) struct Seams {
    fixed: Vec<(rapier::ColliderHandle, Vec<Slab>)>,
    /// The slabs that lie flush beside those of a collider, by the number of its handle.
    beside: BTreeMap<u32, Vec<Slab>>,
}

#[derive(QueryData)]
#[query_data(mutable)]
pub(crate) struct FixedBodies {
    bodies: &'static RapierRigidBodySet,
    colliders: &'static mut RapierContextColliders,
}

/// Finds the seams anew if a fixed object has come, gone or moved, and lets Rapier ask about the contacts of those that have one.
pub(crate) fn find_seams(mut contexts: Query<FixedBodies>, mut seams: ResMut<Seams>) {
    let Ok(mut context) = contexts.single_mut() else {
        return;
    };
    let bodies = &context.bodies.bodies;
    let is_fixed = |collider: &rapier::Collider| {
        let body = collider.parent().and_then(|body| bodies.get(body));
        collider.is_enabled() && body.is_some_and(|body| body.is_fixed() && body.is_enabled())
    };
    let all = context.colliders.colliders.iter();
    let fixed = all.filter(|(_, collider)| is_fixed(collider));
    let fixed: Vec<_> = fixed
        .map(|(handle, collider)| (handle, Slab::all_of(collider)))
        .collect();
    if fixed == seams.fixed {
        return;
    }
    let before = std::mem::take(&mut seams.beside);
    for (handle, slabs) in &fixed {
        let others = fixed.iter().filter(|(other, _)| other != handle);
        let others = others.flat_map(|(_, others)| others);
        let flush = others.filter(|other| slabs.iter().any(|slab| slab.is_flush_with(other)));
        let flush: Vec<_> = flush.copied().collect();
        if !flush.is_empty() {
            seams.beside.insert(handle.into_raw_parts().0, flush);
        }
    }
    for (handle, _) in seams.fixed.iter().chain(&fixed) {
        let number = handle.into_raw_parts().0;
        let has_seams = seams.beside.contains_key(&number);
        if before.contains_key(&number) != has_seams
            && let Some(collider) = context.colliders.colliders.get_mut(*handle)
        {
            collider.set_active_hooks(match has_seams {
                true => rapier::ActiveHooks::MODIFY_SOLVER_CONTACTS,
                false => rapier::ActiveHooks::empty(),
            });
        }
    }
    seams.fixed = fixed;
}

impl Seams {
    /// True if all contacts are with the covered sides of seams.
    pub(crate) fn cover(&self, contacts: &rapier::ContactModificationContext) -> bool {
        let sides = [(contacts.collider1, 1.0), (contacts.collider2, -1.0)];
        let mut sides = sides.into_iter().enumerate();
        sides.any(|(side, (collider, sign))| {
            let beside = self.beside.get(&collider.into_raw_parts().0);
            beside.is_some_and(|beside| {
                let push = sign * *contacts.normal;
                contacts.solver_contacts.iter().all(|contact| {
                    let point = [contact.anchor1, contact.anchor2][side];
                    beside.iter().any(|slab| slab.covers(point, push))
                })
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slab(at: Vec3, half: Vec3) -> Slab {
        Slab {
            at: rapier::Pose::from_translation(at),
            half,
        }
    }

    #[test]
    fn tiles_side_by_side_are_flush() {
        let tile = slab(Vec3::ZERO, Vec3::new(1.0, 1.0, 0.2));
        assert!(tile.is_flush_with(&slab(Vec3::X * 2.0, tile.half)));
        assert!(!tile.is_flush_with(&slab(Vec3::X * 2.1, tile.half)));
        let on_it = slab(Vec3::Z * 0.4, Vec3::new(0.5, 0.5, 0.2));
        assert!(!tile.is_flush_with(&on_it));
    }

    #[test]
    fn a_tile_covers_the_side_of_its_neighbour_and_not_its_top() {
        let tile = slab(Vec3::new(-1.0, 0.0, -0.2), Vec3::new(1.0, 1.0, 0.2));
        assert!(tile.covers(Vec3::ZERO, Vec3::NEG_X));
        assert!(tile.covers(Vec3::ZERO, Vec3::new(-0.6, 0.0, 0.8)));
        assert!(!tile.covers(Vec3::ZERO, Vec3::Z));
        assert!(!tile.covers(Vec3::Z * 0.1, Vec3::NEG_X));
        assert!(!tile.covers(Vec3::X * 0.1, Vec3::NEG_X));
    }
}
