//! Supports: the heights at which an object may stand.

use crate::known::{KnownObject, StandingPose, StandingSolid};

/// Largest gap, seen from above and in units, between solids that may stand on each other: estimates are not exact.
const BESIDE: f32 = 0.06;
/// Heights nearer to each other than this, in units, are the same.
const SAME_HEIGHT: f32 = 1e-3;

/// The heights of an object's origin at which it would stand on the table or on one of the others, at this place, from the lowest on. Of two that a
/// picture hardly tells apart, as on the floor of a box and on the table below it, the upper one.
pub(crate) fn heights<'o>(
    object: &KnownObject,
    placement: &StandingPose,
    others: impl IntoIterator<Item = (&'o KnownObject, &'o StandingPose)>,
) -> Vec<f32> {
    let stance = object.stance(placement);
    let mut heights = vec![-stance.low];
    if object.is_fixed() {
        return heights;
    }
    let own = object.touched(placement);
    let mut floors = Vec::new();
    for (other, at) in others {
        let between = at.location.truncate() - placement.location.truncate();
        if between.length() > stance.radius + other.stance(at).radius + BESIDE {
            continue;
        }
        for below in other.touched(at) {
            for solid in &own {
                let height = below.heights[1] - (solid.heights[0] - placement.location.z);
                let is_new = heights
                    .iter()
                    .all(|known| (known - height).abs() > SAME_HEIGHT);
                if is_new && gap_from_above(solid, &below) < BESIDE {
                    heights.push(height);
                }
                if is_over(solid, &below) {
                    floors.push(height);
                }
            }
        }
    }
    heights.retain(|height| {
        let is_in = |floor: &f32| (floor - DEEP..floor - SAME_HEIGHT).contains(height);
        !floors.iter().any(is_in)
    });
    heights.sort_by(f32::total_cmp);
    heights
}

/// The heights, from those of supports and of piles on them that are hidden. A pile does not reach the next support: that would be in it.
pub(crate) fn heights_over(supports: &[f32], piles: &[f32]) -> Vec<f32> {
    let next = supports.iter().skip(1).copied().chain([f32::INFINITY]);
    let over = supports.iter().zip(next).flat_map(|(support, next)| {
        let heights = piles.iter().map(move |pile| support + pile);
        heights.filter(move |height| *height < next)
    });
    over.collect()
}

/// True if an object stands on the table or on one of the others.
pub(crate) fn stands<'o>(
    object: &KnownObject,
    placement: &StandingPose,
    others: impl IntoIterator<Item = (&'o KnownObject, &'o StandingPose)>,
) -> bool {
    heights(object, placement, others)
        .iter()
        .any(|height| (height - placement.location.z).abs() < SAME_HEIGHT)
}

/// The gap between two solids, seen from above, or less if it is large.
fn gap_from_above(one: &StandingSolid, other: &StandingSolid) -> f32 {
    let [a, b] = [one, other].map(|it| it.center.truncate());
    let least = a.distance(b) - one.radius - other.radius;
    match least > BESIDE {
        true => least,
        false => one.solid.gap_from_above(&other.solid),
    }
}

/// The heights, from the lowest on and up to a largest one, at which piles of these objects may end on which another one stands.
pub(crate) fn pile_heights<'o>(
    objects: impl IntoIterator<Item = &'o KnownObject>,
    highest: f32,
) -> Vec<f32> {
    /// Heights nearer to each other than this, in units, are tried once.
    const ALIKE: f32 = 0.02;
    const MOST: usize = 40;
    let mut heights = vec![0.0];
    let add = |heights: &mut Vec<f32>, height: f32| {
        let is_new = heights.iter().all(|known| (known - height).abs() > ALIKE);
        if is_new && height <= highest && heights.len() < MOST {
            heights.push(height);
        }
    };
    let (fixed, movable): (Vec<_>, Vec<_>) = objects.into_iter().partition(|it| it.is_fixed());
    // What is fixed stands on the table itself.
    for seat in fixed.iter().flat_map(|object| object.seats()) {
        add(&mut heights, seat);
    }
    for object in movable {
        for below in heights.clone() {
            for seat in object.seats() {
                add(&mut heights, below + seat);
            }
        }
    }
    heights.sort_by(f32::total_cmp);
    heights
}

/// How deep solids may be in each other, in units, as estimates are not exact.
pub(crate) const DEEP: f32 = 0.15;

/// True if an object at a placement shares no more room with solids than estimates that are not exact may; `deep` is how far it may be below their tops, in units.
pub(crate) fn has_room(
    object: &KnownObject,
    placement: &StandingPose,
    others: &[StandingSolid],
    deep: f32,
) -> bool {
    let own = object.touched(placement);
    own.iter().all(|solid| {
        let is_beside = |other: &StandingSolid| {
            let common =
                solid.heights[1].min(other.heights[1]) - solid.heights[0].max(other.heights[0]);
            common < deep || !is_over(solid, other)
        };
        others.iter().all(is_beside)
    })
}

/// True if a solid shares more room with another, seen from above, than estimates that are not exact may.
fn is_over(one: &StandingSolid, other: &StandingSolid) -> bool {
    let [a, b] = [one, other].map(|it| it.center.truncate());
    let way = (a - b).normalize_or_zero().extend(0.0);
    a.distance(b) <= one.radius + other.radius
        && one.solid.moved(way * DEEP).gap_from_above(&other.solid) <= 0.0
}

#[cfg(test)]
mod tests {
    use bevy::math::Vec3;
    use tabletop_core::Shape;
    use tabletop_geometry::{Pose, Rgb};

    use super::*;

    /// The heights at which a ball may stand, this far from the middle of a box with a floor of 0.1.
    fn heights_at_a_box(aside: f32) -> Vec<f32> {
        let ball = KnownObject::of(&Shape::Sphere {
            radius: 0.5,
            color: Rgb::RED,
        });
        let container = KnownObject::of(&Shape::Box {
            span: Vec3::new(4.0, 4.0, 1.4),
            thickness: 0.1,
            color: Rgb::GRAY,
        });
        let [here, there] = [(&ball, aside, 0.5), (&container, 0.0, 0.7)]
            .map(|(object, x, z)| object.placement(Pose::at(Vec3::new(x, 0.0, z))));
        heights(&ball, &here, [(&container, &there)])
    }

    #[test]
    fn the_floor_of_a_box_hides_the_table_below_it() {
        let is_near = |one: f32, other: f32| (one - other).abs() < 1e-4;
        let inside = heights_at_a_box(1.0);
        assert!(is_near(inside[0], 0.6), "{inside:?}");
        let beside = heights_at_a_box(3.0);
        assert!(beside.len() == 1 && is_near(beside[0], 0.5), "{beside:?}");
    }

    #[test]
    fn a_hidden_pile_ends_below_the_next_support() {
        let heights = heights_over(&[0.2, 1.0], &[0.0, 0.4, 0.9]);
        assert_eq!(heights, [0.2, 0.2 + 0.4, 1.0, 1.4, 1.9]);
    }
}
