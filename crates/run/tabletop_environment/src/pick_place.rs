//! A whole motion as one step: take what is at a place of the table, and put it down at another.

use std::f32::consts::PI;

use tabletop_core::step_world;
use tabletop_geometry::Bounds;

use crate::table_world::{TableObject, TableWorld};

/// Number of ticks of a step that takes nothing.
const TICKS_OF_NOTHING: u64 = 30;

/// Height, in units, above everything at which an object is carried.
const ABOVE: f32 = 0.5;

/// Height, in units, above its support at which an object is let go.
const DROP: f32 = 0.02;

/// Does what an action of [`PickPlace`](crate::ActionSpace::PickPlace) says. If something is in the way, the object stays where that stops it.
pub(crate) fn pick_and_place(world: &mut TableWorld, action: &[f32]) {
    let &[x, y, to_x, to_y, turn] = action else {
        return;
    };
    let table = world.table();
    let at = [x * table.xspan / 2.0, y * table.yspan / 2.0];
    let to = [to_x * table.xspan / 2.0, to_y * table.yspan / 2.0];
    let objects = world.objects();
    let Some(taken) = highest_at(&objects, at) else {
        step_world(world.world_mut(), TICKS_OF_NOTHING);
        return;
    };
    let steps = steps(taken, &objects, to, turn);
    // What fails on the way, such as a grasp that is refused, ends the motion.
    let done = world.perform(&steps);
    if done.is_err() {
        step_world(world.world_mut(), TICKS_OF_NOTHING);
    }
}

fn bounds(object: &TableObject) -> Bounds {
    object.spec.shape.bounds(object.pose)
}

fn covers(bounds: &Bounds, [x, y]: [f32; 2]) -> bool {
    (bounds.low.x..=bounds.high.x).contains(&x) && (bounds.low.y..=bounds.high.y).contains(&y)
}

/// The highest object over a place that can be moved.
fn highest_at(objects: &[TableObject], at: [f32; 2]) -> Option<&TableObject> {
    let movable = objects.iter().filter(|object| !object.spec.is_fixed());
    let there = movable.filter(|object| covers(&bounds(object), at));
    there.max_by(|one, other| bounds(one).high.z.total_cmp(&bounds(other).high.z))
}

/// The steps that carry an object to a place.
fn steps(taken: &TableObject, objects: &[TableObject], [x, y]: [f32; 2], turn: f32) -> String {
    let others = objects
        .iter()
        .filter(|other| other.spec.id != taken.spec.id);
    let others: Vec<_> = others.map(bounds).collect();
    let own = bounds(taken);
    let origin = taken.pose.location;
    let half = ((own.high - own.low) / 2.0).truncate();
    let below = others.iter().filter(|other| {
        let is_beside = |low: f32, high: f32, center: f32, half: f32| {
            high <= center - half || low >= center + half
        };
        !is_beside(other.low.x, other.high.x, x, half.x)
            && !is_beside(other.low.y, other.high.y, y, half.y)
    });
    let support = below.map(|other| other.high.z).fold(0.0, f32::max);
    let highest = others
        .iter()
        .map(|other| other.high.z)
        .fold(support, f32::max);
    let rise = origin.z - own.low.z;
    let (carried, put) = (highest + ABOVE + rise, support + DROP + rise);
    let degrees = (turn * PI).to_degrees();
    let id = &taken.spec.id;
    format!(
        "With(Any, Grasp({id:?})), With(Any, Glide(to: ({ox:?}, {oy:?}, {carried:?}), seconds: 0.5)), \
         With(Any, Turn(axis: Z, degrees: {degrees:?})), \
         With(Any, Glide(to: ({x:?}, {y:?}, {carried:?}), seconds: 1)), \
         With(Any, Glide(to: ({x:?}, {y:?}, {put:?}), seconds: 0.5)), With(Any, Release), WaitUntilRest(3)",
        ox = origin.x,
        oy = origin.y,
    )
}
