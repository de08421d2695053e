//! Contacts: the nearest points of two solids.

use std::iter;

use bevy::prelude::*;
use bevy_rapier3d::{
    parry::query::{
        self, Contact,
        details::contact_support_map_support_map_with_params,
        gjk::{CsoPoint, GJKResult, VoronoiSimplex},
    },
    rapier::parry::shape::SupportMap,
    rapier::prelude as rapier,
};

/// Directions in which the search is repeated.
const DIRECTIONS: [Vec3; 6] = [
    Vec3::X,
    Vec3::Y,
    Vec3::Z,
    Vec3::NEG_X,
    Vec3::NEG_Y,
    Vec3::NEG_Z,
];

/// The nearest points of two solids at these poses, if they are no farther apart than `most`, in units.
///
/// This is what Parry's `contact` finds. But its search, from one direction, gives up on about one in ten thousand solids
/// that touch a slab near its edge, and takes them for far apart. Where it has not found a plane between them, other
/// directions are tried.
pub fn contact(
    at: &rapier::Pose,
    solid: &dyn rapier::Shape,
    other_at: &rapier::Pose,
    other: &dyn rapier::Shape,
    most: f32,
) -> Option<Contact> {
    let has_exact_formula = solid.as_ball().is_some() || other.as_ball().is_some();
    match (solid.as_support_map(), other.as_support_map()) {
        (Some(solid), Some(other)) if !has_exact_formula => {
            let mut contact = search(&at.inv_mul(other_at), solid, other, most)?;
            contact.transform_by_mut(at, other_at);
            Some(contact)
        }
        _ => query::contact(at, solid, other_at, other, most)
            .ok()
            .flatten(),
    }
}

/// The nearest points of two solids, each in its solid's frame. The second one's pose is given in the frame of the first.
fn search(
    other_at: &rapier::Pose,
    solid: &dyn SupportMap,
    other: &dyn SupportMap,
    most: f32,
) -> Option<Contact> {
    let gap = |direction: Vec3| {
        -direction.dot(CsoPoint::from_shapes(other_at, solid, other, direction).point)
    };
    for start in iter::once(None).chain(DIRECTIONS.map(Some)) {
        let found = contact_support_map_support_map_with_params(
            other_at,
            solid,
            other,
            most,
            &mut VoronoiSimplex::new(),
            start,
        );
        match found {
            GJKResult::ClosestPoints(own, others, normal) => {
                return Some(Contact::new(
                    own,
                    other_at.inverse_transform_point(others),
                    normal,
                    other_at.rotation.inverse() * -normal,
                    (others - own).dot(normal),
                ));
            }
            GJKResult::NoIntersection(direction) if gap(direction) > most => return None,
            GJKResult::Intersection | GJKResult::Proximity(_) | GJKResult::NoIntersection(_) => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use std::f32::consts::TAU;

    use super::*;

    const HALF_HEIGHT: f32 = 1.0;
    const RADIUS: f32 = 0.6;
    const SLAB: Vec3 = Vec3::new(10.0, 6.0, 2.0);

    /// The distance between the slab and the nearest of some points of a cylinder's rims.
    fn distance(at: &rapier::Pose) -> f32 {
        let points = (0..128).map(|i| {
            let (z, x) = (TAU * (i / 2) as f32 / 64.0).sin_cos();
            let y = if i % 2 == 0 {
                HALF_HEIGHT
            } else {
                -HALF_HEIGHT
            };
            *at * Vec3::new(RADIUS * x, y, RADIUS * z)
        });
        let distances = points.map(|point| (point.abs() - SLAB).max(Vec3::ZERO).length());
        distances.fold(f32::INFINITY, f32::min)
    }

    #[test]
    fn what_is_near_the_edge_of_a_slab_is_found() {
        let slab = rapier::SharedShape::cuboid(SLAB.x, SLAB.y, SLAB.z);
        let cylinder = rapier::SharedShape::cylinder(HALF_HEIGHT, RADIUS);
        let mut near = 0;
        for i in 0..150_000 {
            // Kronecker's sequence: as even as chance, and the same every time.
            let [a, b, c, x, y, z] = [2.0_f64, 3.0, 5.0, 7.0, 11.0, 13.0]
                .map(|prime| (f64::from(i) * prime.sqrt()).fract() as f32);
            let turned = Quat::from_euler(EulerRot::XYZ, TAU * a, TAU * b, TAU * c);
            let place = Vec3::new(20.0 * x - 10.0, 2.0 * y - 7.0, 1.2 * z + 2.0);
            let at = rapier::Pose::from_parts(place, turned);
            if distance(&at) > 0.09 {
                continue;
            }
            near += 1;
            let found = contact(&at, &*cylinder, &rapier::Pose::IDENTITY, &*slab, 0.1);
            assert!(found.is_some(), "{at:?}");
        }
        assert!(near > 20_000, "{near}");
    }
}
