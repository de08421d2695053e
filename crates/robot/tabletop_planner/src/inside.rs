//! Places in a container.

use bevy::math::Vec3;
use tabletop_controller::SeenObject;
use tabletop_geometry::{PlacedSolid, Pose};

use crate::{
    goals::Candidate,
    sight::{Solids as _, heights},
};

/// Distance between places around a goal, in units: rather less, in a small container.
const STEP: f32 = 0.3;
/// Numbers of steps from the goal to these places.
const NEAR: [f32; 5] = [0.0, 1.0, -1.0, 2.0, -2.0];
/// Parts of a container's extent at which it is searched for room, too.
const ACROSS: [f32; 5] = [0.5, 0.3, 0.7, 0.1, 0.9];
/// Height above an object's foot up to which something is its floor, in units.
const FLOOR: f32 = 0.05;

/// The places for an object in a container, around a goal and all over the container.
pub(crate) fn places(
    goal: Candidate,
    object: &SeenObject,
    container: &SeenObject,
) -> Vec<Candidate> {
    let own = object.solids_at(goal.pose);
    let outer = container.solids();
    let frame = container.pose.rotation;
    let level = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| (frame * axis).with_z(0.0));
    let mut ways = level
        .into_iter()
        .filter(|way| way.length() > 0.7)
        .map(Vec3::normalize);
    let ways = [ways.next(), ways.next()].map(|way| way.unwrap_or(Vec3::ZERO));
    let [x, y] = ways.map(|way| shifts(way, &own, &outer));
    let pairs = (0..2).flat_map(|kind| {
        let (x, y) = (x[kind], y[kind]);
        x.into_iter().flat_map(move |x| y.map(|y| (x, y)))
    });
    let places = pairs.map(|(x, y)| {
        let aside = ways[0] * x + ways[1] * y;
        Candidate {
            pose: Pose::new(goal.pose.location + aside, goal.pose.rotation),
            cost: aside.length(),
            ..goal
        }
    });
    places.collect()
}

/// The shifts along a way that keep an object within the outline of its container: small ones, and all across.
fn shifts(way: Vec3, own: &[PlacedSolid], outer: &[PlacedSolid]) -> [[f32; 5]; 2] {
    let [own, outer] = [own, outer].map(|solids| PlacedSolid::extent(solids, way));
    let [from, to] = [outer[0] - own[0], outer[1] - own[1]];
    let step = STEP.min((to - from).max(0.0) / 6.0);
    [
        NEAR.map(|steps| steps * step),
        ACROSS.map(|part| from + (to - from) * part),
    ]
}

/// The least gap, seen from above, between an object and all that is beside it rather than below it.
pub(crate) fn room(own: &[PlacedSolid], others: &[PlacedSolid]) -> f32 {
    let [foot, _] = heights(own);
    let beside = others
        .iter()
        .filter(|other| other.heights()[1] > foot + FLOOR);
    let gaps = beside.flat_map(|other| own.iter().map(|own| own.gap_from_above(other)));
    gaps.fold(f32::INFINITY, f32::min)
}
