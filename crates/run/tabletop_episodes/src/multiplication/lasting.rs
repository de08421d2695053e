//! What lasts: objects stay where a demonstration has put them.

use bevy::prelude::*;
use tabletop_controller::Sight;
use tabletop_core::StepApp as _;
use tabletop_planner::{Before, PlanFailure, undone};
use tabletop_task::{Binding, PlaceRange, Symmetry, Task, TaskStep};

/// Number of ticks after the end for which objects must stay.
const LASTING: u64 = 180;
/// Largest displacement meanwhile, in units.
const STILL_LENGTH: f32 = 0.05;
/// Largest turn meanwhile, in rad.
const STILL_ANGLE: f32 = 0.05;

/// Lets time pass after the end of a demonstration. An error names the first step whose object moves by itself, or is no longer where it belongs.
pub(super) fn lasts(
    app: &mut App,
    task: &Task,
    binding: &Binding,
    before: &Before,
) -> Result<(), (usize, PlanFailure)> {
    let ended = Sight::of(app.world_mut());
    app.step(LASTING);
    let later = Sight::of(app.world_mut());
    let stays = |id: &str| match (ended.objects.get(id), later.objects.get(id)) {
        (Some(one), Some(other)) => {
            let (moved, turned) = Symmetry::of(&one.shape).difference(one.pose, other.pose);
            moved < STILL_LENGTH && turned < STILL_ANGLE
        }
        (None, None) => true,
        (Some(_), None) | (None, Some(_)) => false,
    };
    // What rolls in a bowl is still in it.
    let has_place = |step: &&TaskStep| {
        let goal = step.goal.as_ref();
        goal.is_some_and(|goal| goal.place != PlaceRange::Inside)
    };
    let placed = task.steps.iter().filter(has_place);
    let mut placed = placed.filter_map(|step| Some((step.number, binding.object(&step.object)?)));
    if let Some((number, id)) = placed.find(|(_, id)| !stays(id)) {
        return Err((number, PlanFailure::Misplaced(id.to_owned())));
    }
    undone(task, binding, &later, before).map_or(Ok(()), Err)
}
