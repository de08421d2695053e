//! Patterns of objects on the table.

use bevy::math::Vec3;
use tabletop_core::ObjectSpec;
use tabletop_geometry::{PlacedSolid, Pose};

use crate::{
    instruction::Pattern,
    noun::TableSide,
    placement::{GAPS, Room, aligned, on_table, places_on},
    scene::{SceneView, solids_at},
};

/// Gap between the objects of a pattern, in units: an arm's fingers have room in it.
const APART: f32 = 1.0;

/// How far beyond the places of the objects a pattern of them may reach, in units.
const MARGIN: f32 = 1.0;

/// How far objects in a row may be out of line, and how far apart, in units.
const OUT_OF_LINE: f32 = 0.4;
const MOST_APART: f32 = 3.0;

/// The poses of objects in a pattern on the table, as near to a location as there is room.
pub(crate) fn laid_out(
    view: &SceneView,
    objects: &[&ObjectSpec],
    pattern: Pattern,
    near: Vec3,
    side: Option<TableSide>,
) -> Option<Vec<Pose>> {
    let offsets = offsets(objects, pattern);
    let around_origin = objects.iter().zip(offsets);
    let around_origin: Vec<_> = around_origin
        .map(|(object, offset)| on_table(object, offset, aligned(object.pose.rotation)))
        .collect();
    let poses_at = |center: Vec3| -> Vec<Pose> {
        let poses = around_origin.iter();
        poses
            .map(|pose| Pose::new(pose.location + center, pose.rotation))
            .collect()
    };
    let centers = places_on(&view.scene.table, near);
    let fits = |poses: &[Pose], rooms: &[Room], is_near: &dyn Fn(Vec3) -> bool| {
        let is_there =
            |pose: &Pose| side.is_none_or(|side| side.has(pose.location)) && is_near(pose.location);
        let mut all = rooms.iter().zip(poses);
        poses.iter().all(is_there)
            && all.all(|(room, pose)| room.is_on_table(*pose) && room.is_free(*pose, GAPS[1], &[]))
    };
    let ids: Vec<_> = objects.iter().map(|object| object.id.as_str()).collect();
    let locations = || objects.iter().map(|object| object.pose.location);
    let (low, high) = (
        locations().reduce(Vec3::min).unwrap_or(near) - MARGIN,
        locations().reduce(Vec3::max).unwrap_or(near) + MARGIN,
    );
    let is_among = |place: Vec3| place.cmpge(low).all() && place.cmple(high).all();
    // Rather where the objects are, since there they can be reached, and where none has to make room for another one.
    let areas: [&dyn Fn(Vec3) -> bool; 2] = [&is_among, &|_| true];
    areas.into_iter().find_map(|is_near| {
        [&[][..], &ids].into_iter().find_map(|without| {
            let rooms = objects
                .iter()
                .map(|object| Room::new(view, object).without(without));
            let rooms: Vec<_> = rooms.collect();
            let mut all = centers.iter().map(|center| poses_at(*center));
            all.find(|poses| fits(poses, &rooms, is_near))
        })
    })
}

/// The places of objects in a pattern around its centre. Rows go to the right, the next one is nearer to the robot; a column goes away from it.
fn offsets(objects: &[&ObjectSpec], pattern: Pattern) -> Vec<Vec3> {
    let count = objects.len();
    let columns = match pattern {
        Pattern::Row | Pattern::Tower => count,
        Pattern::Column => 1,
        Pattern::Grid(columns) => columns as usize,
    };
    let columns = columns.clamp(1, count.max(1));
    let widest = |axis: Vec3| {
        let extents = objects.iter().map(|object| {
            let pose = Pose::new(Vec3::ZERO, aligned(object.pose.rotation));
            let [low, high] = PlacedSolid::extent(&solids_at(object, pose), axis);
            high - low
        });
        extents.fold(0.0, f32::max)
    };
    let pitch = Vec3::new(widest(Vec3::X) + APART, widest(Vec3::Y) + APART, 0.0);
    let away = match pattern {
        Pattern::Column => 1.0,
        Pattern::Row | Pattern::Tower | Pattern::Grid(_) => -1.0,
    };
    let place =
        |i: usize| Vec3::new((i % columns) as f32, away * (i / columns) as f32, 0.0) * pitch;
    let last = Vec3::new(
        (columns - 1) as f32,
        away * (count.div_ceil(columns).max(1) - 1) as f32,
        0.0,
    );
    (0..count).map(|i| place(i) - last * pitch / 2.0).collect()
}

/// Objects in the order of a pattern in which they are: from below, from left to right, from near to far, row by row.
pub(crate) fn sorted_in_place(view: &SceneView, ids: &[String], pattern: Pattern) -> Vec<String> {
    let mut sorted = ids.to_vec();
    let by = |axis: Vec3| {
        move |a: &String, b: &String| {
            let place = |id: &str| view.location(id).dot(axis);
            place(a).total_cmp(&place(b))
        }
    };
    match pattern {
        Pattern::Tower => sorted.sort_by(by(Vec3::Z)),
        Pattern::Row => sorted.sort_by(by(Vec3::X)),
        Pattern::Column => sorted.sort_by(by(Vec3::Y)),
        Pattern::Grid(columns) => {
            sorted.sort_by(by(Vec3::NEG_Y));
            let rows = sorted.chunks_mut(columns.max(1) as usize);
            rows.for_each(|row| row.sort_by(by(Vec3::X)));
        }
    }
    sorted
}

/// True if objects in this order are in a pattern.
pub(crate) fn is_laid_out(view: &SceneView, ids: &[String], pattern: Pattern) -> bool {
    let columns = match pattern {
        Pattern::Tower => {
            let mut pairs = ids.windows(2);
            return pairs.all(|pair| view.standing.rests_on(&pair[1], &pair[0]));
        }
        Pattern::Row => ids.len(),
        Pattern::Column => 1,
        Pattern::Grid(columns) => columns as usize,
    };
    let columns = columns.max(1);
    let away = match pattern {
        Pattern::Column => Vec3::Y,
        Pattern::Row | Pattern::Tower | Pattern::Grid(_) => Vec3::NEG_Y,
    };
    let is_level = |a: &str, b: &str, axis: Vec3| {
        (view.location(a) - view.location(b)).dot(axis).abs() < OUT_OF_LINE
    };
    let is_next = |before: &str, next: &str, axis: Vec3| {
        let [_, end] = PlacedSolid::extent(&view.solids(before), axis);
        let [begin, _] = PlacedSolid::extent(&view.solids(next), axis);
        (-OUT_OF_LINE..MOST_APART).contains(&(begin - end))
    };
    let is_in_place = |(i, id): (usize, &String)| {
        let left = (i % columns > 0).then(|| &ids[i - 1]);
        let before = i.checked_sub(columns).map(|before| &ids[before]);
        view.standing.is_on_table(id)
            && left.is_none_or(|left| is_next(left, id, Vec3::X) && is_level(left, id, Vec3::Y))
            && before
                .is_none_or(|before| is_next(before, id, away) && is_level(before, id, Vec3::X))
    };
    ids.iter().enumerate().all(is_in_place)
}
