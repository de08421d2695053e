//! Whether a task can be done at all where things are.

use std::collections::BTreeMap;

use tabletop_controller::Sight;
use tabletop_geometry::{PlacedSolid, Pose};
use tabletop_task::{Binding, PlaceRange, Relation, Task};

use crate::{
    goals::{goal_poses, is_over},
    sight::Solids as _,
};

/// How deep solids may be in each other, in units.
const PLAY: f32 = 0.02;

/// True if all objects with exact goals are on the table in the end, and penetrate neither each other nor an immovable object. No robot could
/// do the task otherwise.
pub fn is_feasible(task: &Task, binding: &Binding, sight: &Sight) -> bool {
    let mut last = BTreeMap::new();
    for (number, id, pose) in goal_poses(task, binding, sight) {
        last.insert(id, (number, pose));
    }
    let is_exact = |number: usize| {
        task.step(number).is_some_and(|step| {
            let slides = matches!(step.relations.first(), Some(Relation::Slid { .. }));
            let goal = step.goal.as_ref();
            goal.is_some_and(|goal| goal.place == PlaceRange::Exact) && !slides
        })
    };
    last.retain(|_, (number, _)| is_exact(*number));
    let solids = |id: &str, pose: Pose| {
        let object = sight.objects.get(id);
        object.map_or_else(Vec::new, |object| object.solids_at(pose))
    };
    let fixed = sight.objects.values().filter(|object| object.is_fixed);
    let mut placed: Vec<PlacedSolid> = fixed.flat_map(|object| object.solids()).collect();
    for (id, (_, pose)) in &last {
        let own = solids(id, *pose);
        let is_free = own.iter().all(|solid| {
            let solid = solid.shrunk(PLAY);
            is_over(&sight.table, &solid)
                && placed.iter().all(|other| !solid.is_within(1e-3, other))
        });
        if !is_free {
            return false;
        }
        placed.extend(own);
    }
    true
}
