//! Free places on the table.

use bevy::math::{Quat, Vec3};
use tabletop_controller::Sight;
use tabletop_geometry::{PlacedSolid, Pose};

use crate::{
    body::RobotBody,
    sight::{Solids as _, heights},
};

/// How far from others something is put, so that fingers reach it, in units: rather than less.
const ROOMS: [f32; 2] = [0.9, 0.5];
/// How far from the table's edges, in units.
const EDGE: f32 = 0.3;
/// Largest number of places that are found.
const MOST: usize = 10;
/// Distance between the candidate places, in units.
const GRID: f32 = 0.5;

/// Places where an object can be put in this orientation, the nearest to `near` first. `kept` are solids that will be there later.
pub(crate) fn free_spots(
    body: &RobotBody,
    sight: &Sight,
    id: &str,
    rotation: Quat,
    near: Vec3,
    limbs: &[usize],
    kept: &[PlacedSolid],
) -> Vec<Pose> {
    let Some(object) = sight.objects.get(id) else {
        return Vec::new();
    };
    let solids = object.solids_at(Pose::new(Vec3::ZERO, rotation));
    let [lowest, highest] = heights(&solids);
    let reach = |way: Vec3| {
        let all = solids.iter().map(|solid| solid.farthest(way).dot(way));
        all.fold(0.0, f32::max)
    };
    let half = Vec3::new(sight.table.xspan, sight.table.yspan, 0.0) / 2.0 - EDGE;
    let [left, right] = [-half.x + reach(Vec3::NEG_X), half.x - reach(Vec3::X)];
    let [front, back] = [-half.y + reach(Vec3::NEG_Y), half.y - reach(Vec3::Y)];
    let others: Vec<_> = sight
        .objects
        .iter()
        .filter(|(other, _)| *other != id)
        .flat_map(|(_, other)| other.solids())
        .chain(kept.iter().cloned())
        .collect();
    let steps = |from: f32, to: f32| {
        let count = ((to - from) / GRID).max(0.0) as u16;
        (0..=count).map(move |i| from + GRID * f32::from(i))
    };
    let mut spots: Vec<_> = steps(left, right)
        .flat_map(|x| steps(front, back).map(move |y| Vec3::new(x, y, -lowest)))
        .collect();
    let distance = |spot: &Vec3| (*spot - near).truncate().length();
    spots.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    let is_free = |spot: &Vec3, room: f32| {
        let mut placed = solids.iter().map(|solid| solid.moved(*spot));
        placed.all(|solid| {
            others
                .iter()
                .all(|other| solid.gap_from_above(other) > room)
        })
    };
    let is_reached = |spot: &Vec3| {
        limbs.iter().all(|&limb| {
            let home = body.limbs[limb].home;
            let tops = [0.8_f32.max(highest - lowest), 2.5];
            tops.into_iter()
                .all(|z| body.reach(limb, Pose::at(spot.with_z(z)), &home).is_some())
        })
    };
    let found = |room: f32| -> Vec<_> {
        let free = spots.iter().filter(|spot| is_free(spot, room));
        let reached = free.filter(|spot| is_reached(spot)).take(MOST);
        reached.map(|spot| Pose::new(*spot, rotation)).collect()
    };
    let all = ROOMS.into_iter().map(found);
    all.into_iter()
        .find(|spots| !spots.is_empty())
        .unwrap_or_default()
}
