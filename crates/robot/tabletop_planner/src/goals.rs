//! Goals of a step: the poses that its object may take.

use std::collections::BTreeMap;

use bevy::math::{Quat, Vec3};
use tabletop_controller::{SeenObject, Sight};
use tabletop_core::Table;
use tabletop_geometry::{PlacedSolid, Pose};
use tabletop_task::{
    Arrangement, Binding, PlaceRange, Reference, Relation, Symmetry, Task, TaskStep, twist_about,
};

use crate::{
    failure::PlanFailure,
    sight::{Arranged as _, Solids as _, heights, lean},
};

/// A pose that does, and its cost above that of the best.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Candidate {
    pub pose: Pose,
    pub cost: f32,
    pub placement: Placement,
}

/// How an object comes to its goal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Placement {
    /// It stands as before.
    Upright,
    /// It lies on another side.
    Tipped,
    /// It falls from there.
    Dropped,
}

impl Candidate {
    /// A pose in which the object is not tipped.
    pub const fn new(pose: Pose, cost: f32) -> Self {
        Self {
            pose,
            cost,
            placement: Placement::Upright,
        }
    }

    pub fn is_tipped(&self) -> bool {
        self.placement == Placement::Tipped
    }
}

/// Earlier poses of objects.
#[derive(Clone, Debug, Default)]
pub struct Before {
    /// Poses at the beginning, by object.
    pub beginning: BTreeMap<String, Pose>,
    /// Pose of the moved object before this step.
    pub step: Option<Pose>,
}

impl Before {
    /// Before anything is moved.
    pub fn anything(sight: &Sight) -> Self {
        let poses = sight.objects.iter();
        Self {
            beginning: poses
                .map(|(id, object)| (id.clone(), object.pose))
                .collect(),
            step: None,
        }
    }
}

/// Largest distance from its goal, in units, at which an object is there: for goals relative to an object, and to a place.
const NEAR: (f32, f32) = (0.15, 0.3);
/// Largest angle from its goal, in rad.
const TURNED: f32 = 0.14;
/// Largest angle, in rad, by which a place may be farther from the demonstrated side than the best place.
const SIDES: f32 = 0.6;
/// Largest angle by which an upright object may lean, in rad.
const UPRIGHT: f32 = 0.1;

/// The poses of the object that fulfil a step; if a turn about the vertical reaches some of them, only these.
pub(crate) fn candidates(
    step: &TaskStep,
    binding: &Binding,
    sight: &Sight,
    before: &Before,
) -> Result<Vec<Candidate>, PlanFailure> {
    let id = bound(binding, &step.object)?;
    let object = sight
        .objects
        .get(id)
        .ok_or_else(|| PlanFailure::Gone(id.to_owned()))?;
    let mut found = Vec::<Candidate>::new();
    let symmetry = Symmetry::of(&object.shape);
    for exact in exact(step, binding, sight, before)? {
        for variant in symmetry.variants(exact.pose) {
            let turn = variant.rotation * object.pose.rotation.inverse();
            let is_tipped = lean(turn) > UPRIGHT;
            let rotation = match is_tipped {
                true => variant.rotation,
                false => twist_about(turn, Vec3::Z) * object.pose.rotation,
            };
            let pose = Pose::new(variant.location, rotation);
            let is_new = found.iter().all(|known| {
                known.pose.location.distance(pose.location) > 0.01
                    || tabletop_task::angle_between(known.pose.rotation, pose.rotation) > 0.02
            });
            if is_new {
                found.push(Candidate {
                    pose,
                    cost: exact.cost,
                    placement: match is_tipped {
                        true => Placement::Tipped,
                        false => Placement::Upright,
                    },
                });
            }
        }
    }
    if found.iter().any(|candidate| !candidate.is_tipped()) {
        found.retain(|candidate| !candidate.is_tipped());
    } else if is_inside(step) {
        // What fits as it lies now need not be tipped.
        let lying = found.iter().map(|goal| untipped(object, *goal));
        let lying: Vec<_> = lying
            .filter(|goal| fits_inside(step, binding, sight, goal.pose))
            .collect();
        if !lying.is_empty() {
            found = lying;
        }
    }
    let least = found
        .iter()
        .map(|one| one.cost)
        .fold(f32::INFINITY, f32::min);
    found.retain(|one| one.cost < least + SIDES);
    let is_exact = step
        .goal
        .as_ref()
        .is_some_and(|goal| goal.place == PlaceRange::Exact);
    if is_exact || is_on(step) {
        // If the reference has turned, a place may be beside the object's support, or above its neighbour.
        let mut fitting = Vec::new();
        for candidate in &found {
            let arrangement = sight.arrangement_with(id, candidate.pose);
            let is_on_table = object
                .solids_at(candidate.pose)
                .iter()
                .all(|solid| is_over(&sight.table, solid));
            if is_on_table && stands(step, binding, &arrangement, id)? {
                fitting.push(*candidate);
            }
        }
        if !fitting.is_empty() {
            return Ok(fitting);
        }
    }
    Ok(found)
}

/// Whether a step's object may be anywhere inside another one.
pub(crate) fn is_inside(step: &TaskStep) -> bool {
    let goal = step.goal.as_ref();
    goal.is_some_and(|goal| goal.place == PlaceRange::Inside)
}

/// True if a step's object in this pose is in its container, and in none of the walls.
pub(crate) fn fits_inside(step: &TaskStep, binding: &Binding, sight: &Sight, pose: Pose) -> bool {
    let container = step.relations.first().and_then(Relation::object);
    let container = container.and_then(|role| binding.object(role));
    let others = sight.objects.keys().map(String::as_str);
    let others: Vec<_> = others.filter(|other| Some(*other) != container).collect();
    let object = binding.object(&step.object);
    let is_in = |id: &str| {
        let arrangement = sight.arrangement_with(id, pose);
        container.is_some_and(|container| arrangement.containers(id).contains(&container))
    };
    object.is_some_and(|id| sight.occupant(id, pose, &others).is_none() && is_in(id))
}

/// A goal at which an object is no lower, but as it lies now.
fn untipped(object: &SeenObject, goal: Candidate) -> Candidate {
    let here = Pose::new(goal.pose.location, object.pose.rotation);
    let [lowest, own] = [goal.pose, here].map(|pose| heights(&object.solids_at(pose))[0]);
    Candidate {
        pose: Pose::new(here.location + Vec3::Z * (lowest - own), here.rotation),
        placement: Placement::Upright,
        ..goal
    }
}

/// True if no part of a solid reaches beyond the table.
pub(crate) fn is_over(table: &Table, solid: &PlacedSolid) -> bool {
    let reach = |way: Vec3| solid.farthest(way).dot(way);
    reach(Vec3::X).max(reach(Vec3::NEG_X)) < table.xspan / 2.0
        && reach(Vec3::Y).max(reach(Vec3::NEG_Y)) < table.yspan / 2.0
}

/// True if an object stands on, in and around the objects that a step names.
fn stands(
    step: &TaskStep,
    binding: &Binding,
    arrangement: &Arrangement,
    id: &str,
) -> Result<bool, PlanFailure> {
    for relation in &step.relations {
        let is_so = match relation {
            Relation::On { object } => arrangement.supports(id).contains(&bound(binding, object)?),
            Relation::Inside { object } => arrangement
                .containers(id)
                .contains(&bound(binding, object)?),
            Relation::Around { object } => arrangement.posts(id).contains(&bound(binding, object)?),
            Relation::Against { object } => {
                arrangement.props(id).contains(&bound(binding, object)?)
            }
            Relation::OnTable => arrangement.is_on_table(id),
            Relation::Beside { .. }
            | Relation::AlignedWith { .. }
            | Relation::InPlaceOf { .. }
            | Relation::Aside
            | Relation::Slid { .. }
            | Relation::Turned { .. }
            | Relation::LetGo
            | Relation::Destroyed
            | Relation::Held => true,
        };
        if !is_so {
            return Ok(false);
        }
    }
    Ok(true)
}

/// The poses of a step's goal, with the freedom that the symmetry of its reference leaves.
fn exact(
    step: &TaskStep,
    binding: &Binding,
    sight: &Sight,
    before: &Before,
) -> Result<Vec<Candidate>, PlanFailure> {
    let Some(goal) = &step.goal else {
        return Ok(Vec::new());
    };
    let gone = |id: &str| PlanFailure::Gone(id.to_owned());
    let id = bound(binding, &step.object)?;
    let object = sight.objects.get(id).ok_or_else(|| gone(id))?;
    let symmetry = Symmetry::of(&object.shape);
    let frames = match &goal.reference {
        Reference::Table => vec![Pose::IDENTITY],
        Reference::Itself => {
            let frame = before.step.ok_or_else(|| gone(&step.object))?;
            let mut alike = symmetry.variants(frame);
            alike.retain(|frame| is_up(frame.rotation * goal.up));
            match alike.is_empty() {
                true => vec![frame],
                false => alike,
            }
        }
        Reference::Object { object } => {
            let id = bound(binding, object)?;
            let seen = sight.objects.get(id).ok_or_else(|| gone(id))?;
            Symmetry::of(&seen.shape).variants(seen.pose)
        }
        Reference::PlaceOf { object } => {
            let id = bound(binding, object)?;
            let pose = *before.beginning.get(id).ok_or_else(|| gone(id))?;
            let symmetry = sight.objects.get(id).map(|seen| Symmetry::of(&seen.shape));
            symmetry.map_or(vec![pose], |symmetry| symmetry.variants(pose))
        }
    };
    let poses = frames.into_iter().map(|frame| {
        let frame = levelled(frame, goal.up);
        let pose = frame * goal.pose;
        Candidate::new(pose, change_of_side(step, frame, pose))
    });
    let is_above_table = |candidate: &Candidate| (candidate.pose * symmetry.centre).z > 0.0;
    let upright = poses.filter(is_above_table);
    // A reference that looks the same upside down must not turn the goal upside down.
    let shown_height = goal.pose.location.length();
    let mut all: Vec<_> = upright.collect();
    let highest = all
        .iter()
        .map(|one| one.pose.location.z)
        .fold(f32::NEG_INFINITY, f32::max);
    if goal.place == PlaceRange::Exact && shown_height > 0.3 && is_on(step) {
        all.retain(|one| one.pose.location.z > highest - 0.1);
    }
    let above = goal.pose.rotation.inverse() * goal.up;
    let lies_as_shown = |one: &Candidate| {
        let mut alike = symmetry.variants(one.pose).into_iter();
        alike.any(|pose| is_up(pose.rotation * above))
    };
    if all.iter().any(lies_as_shown) {
        all.retain(lies_as_shown);
    }
    all.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    Ok(all)
}

/// Whether a direction is up, rather than to a side.
fn is_up(way: Vec3) -> bool {
    // More than half of the eighth of a turn by which variants of a round object differ.
    way.angle_between(Vec3::Z) < 0.45
}

/// A frame in which this direction is exactly up, if it nearly is.
fn levelled(frame: Pose, up: Vec3) -> Pose {
    let above = frame.rotation * up;
    match is_up(above) {
        true => {
            let turn = Quat::from_rotation_arc(above, Vec3::Z);
            Pose::new(frame.location, turn * frame.rotation)
        }
        false => frame,
    }
}

fn is_on(step: &TaskStep) -> bool {
    step.relations.iter().any(|relation| {
        matches!(
            relation,
            Relation::On { .. } | Relation::Inside { .. } | Relation::Around { .. }
        )
    })
}

/// Angle between a goal and the demonstrated side of its reference, in rad.
fn change_of_side(step: &TaskStep, frame: Pose, pose: Pose) -> f32 {
    let way = (pose.location - frame.location).with_z(0.0);
    match step.relations.first() {
        Some(Relation::Beside { side, .. }) if way.length() > 0.2 => way.angle_between(side.way()),
        _ => 0.0,
    }
}

/// True if the object of a step is where it has to be, and so is what goes along with it.
///
/// # Errors
/// One of the objects, or a reference, is missing.
pub fn is_met(
    step: &TaskStep,
    binding: &Binding,
    sight: &Sight,
    before: &Before,
) -> Result<bool, PlanFailure> {
    for loading in step.loading() {
        if !is_placed(&loading, binding, sight, before)? {
            return Ok(false);
        }
    }
    is_placed(step, binding, sight, before)
}

/// True if the object of a step is where it has to be, whatever goes along with it.
pub(crate) fn is_placed(
    step: &TaskStep,
    binding: &Binding,
    sight: &Sight,
    before: &Before,
) -> Result<bool, PlanFailure> {
    let id = bound(binding, &step.object)?;
    let Some(object) = sight.objects.get(id) else {
        return Ok(matches!(step.relations.first(), Some(Relation::Destroyed)));
    };
    let Some(goal) = &step.goal else {
        return Ok(true);
    };
    if goal.place == PlaceRange::Anywhere {
        return Ok(true);
    }
    if let Some(Relation::Slid { .. }) = step.relations.first() {
        let targets = exact(step, binding, sight, before)?;
        return Ok(targets
            .iter()
            .any(|target| target.pose.location.distance(object.pose.location) < 0.3));
    }
    if !stands(step, binding, &sight.arrangement(), id)? {
        return Ok(false);
    }
    if goal.place == PlaceRange::Inside {
        return Ok(true);
    }
    let near = match goal.reference {
        Reference::Object { .. } => NEAR.0,
        Reference::Table | Reference::PlaceOf { .. } | Reference::Itself => NEAR.1,
    };
    let symmetry = Symmetry::of(&object.shape);
    let targets = exact(step, binding, sight, before)?;
    Ok(targets.iter().any(|target| {
        let (moved, turned) = symmetry.difference(object.pose, target.pose);
        moved < near && turned < TURNED
    }))
}

/// Goals of the task's objects, as far as they are known before the robot begins: the number of the step, the object,
/// and its pose.
pub fn goal_poses(task: &Task, binding: &Binding, sight: &Sight) -> Vec<(usize, String, Pose)> {
    let mut sight = sight.clone();
    let mut before = Before::anything(&sight);
    let mut goals = Vec::new();
    for step in &task.steps {
        let Some(id) = binding.object(&step.object) else {
            continue;
        };
        before.step = sight.objects.get(id).map(|object| object.pose);
        let Ok(found) = candidates(step, binding, &sight, &before) else {
            continue;
        };
        let Some(goal) = found.first().map(|goal| goal.pose) else {
            continue;
        };
        let motion = before.step.map(|from| goal * from.inverse());
        let load = step
            .load
            .iter()
            .filter_map(|load| binding.object(&load.object));
        for moved in load.chain([id]) {
            if let (Some(motion), Some(object)) = (motion, sight.objects.get_mut(moved)) {
                object.pose = motion * object.pose;
                goals.push((step.number, moved.to_owned(), object.pose));
            }
        }
    }
    goals
}

/// The object that takes a role.
pub(crate) fn bound<'b>(binding: &'b Binding, role: &str) -> Result<&'b str, PlanFailure> {
    binding
        .object(role)
        .ok_or_else(|| PlanFailure::Gone(role.to_owned()))
}
