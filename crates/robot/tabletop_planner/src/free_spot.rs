//! Free places on the table.

use bevy::math::{Quat, Vec3};
use tabletop_controller::Sight;
use tabletop_geometry::{PlacedSolid, Pose};

use crate::{
    body::RobotBody,
    sight::{Solids as _, heights},
};

/// How far from others something is put, so that fingers reach it, in units and hand sizes: rather than less.
const ROOMS: [f32; 2] = [0.9, 0.5];
/// How far from the table's edges, in units.
const EDGE: f32 = 0.3;
/// Largest number of places that are found.
const MOST: usize = 10;
/// Distance between the candidate places, in units and hand sizes.
const GRID: f32 = 0.5;
/// Heights, in units and hand sizes, at which an end effector takes and carries what lies there.
const TAKEN: f32 = 0.8;
const CARRIED: f32 = 2.5;

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
    let hand = body.hand_size();
    let steps = |from: f32, to: f32| {
        let grid = GRID * hand;
        let count = ((to - from) / grid).max(0.0) as u16;
        (0..=count).map(move |i| from + grid * f32::from(i))
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
            let tops = [(TAKEN * hand).max(highest - lowest), CARRIED * hand];
            tops.into_iter()
                .all(|z| body.reach(limb, Pose::at(spot.with_z(z)), &home).is_some())
        })
    };
    let found = |room: f32| -> Vec<_> {
        let free = spots.iter().filter(|spot| is_free(spot, room));
        let reached = free.filter(|spot| is_reached(spot)).take(MOST);
        reached.map(|spot| Pose::new(*spot, rotation)).collect()
    };
    let all = ROOMS.into_iter().map(|room| found(room * hand));
    all.into_iter()
        .find(|spots| !spots.is_empty())
        .unwrap_or_default()
}
