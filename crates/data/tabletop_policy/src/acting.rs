//! Acting: a robot does what a policy decides after each look, until it decides that the task is done.

use bevy::math::Vec3;
use tabletop_controller::{SeenObject, Sight};
use tabletop_core::{ObjectSpec, SimTick};
use tabletop_episodes::imitation::HeadCameraStage;
use tabletop_planner::{Before, Imitation, PlanFailure, RobotBody, imitate, undone};
use tabletop_task::{
    Arrangement, Binding, Freedom, Goal, PlaceRange, Reference, Relation, Role, Symmetry, Task,
    TaskStep,
};

use crate::{
    evaluation::{GRASP, bindings, pose_at},
    known_table::ToldTask,
    picture_policy::PicturePolicy,
    policy::{Decision, ObjectPlace},
    thinking_time::ThinkingTime,
};

/// Lets a robot act as a policy decides: at most as many moves as given. The policy sees the picture of the head camera; the shape of what it takes, and
/// where that is exactly, the stage tells. Of the task it sees what its mapping says. `seed` decides all random trials; `tell` is called before each move, with its number, the object and where it is put, in units.
pub fn follow_policy(
    policy: &dyn PicturePolicy,
    thinking: ThinkingTime,
    stage: &mut impl HeadCameraStage,
    body: &RobotBody,
    told: &ToldTask,
    most: usize,
    seed: u64,
    mut tell: impl FnMut(usize, &str, Vec3),
) -> Imitation {
    let mut all = Imitation::default();
    // Without a step, the arms leave the picture.
    let mut next = Task::without_steps(stage.sight().table);
    let mut binding = Binding::default();
    for number in 1..=most + 1 {
        let moved = imitate(stage, body, &next, &binding, seed, |_| ());
        all.corrections += moved.corrections;
        all.steps_done += moved.steps_done;
        // What is misplaced is for the policy to see.
        let failure = moved.failure.map(|(_, failure)| failure);
        if let Some(failure) = failure.filter(|it| !matches!(it, PlanFailure::Misplaced(_))) {
            all.failure = Some((number - 1, failure));
            return all;
        }
        let Some(seen) = stage.head_picture() else {
            all.failure = Some((number, PlanFailure::Stopped));
            return all;
        };
        let (decision, ticks) =
            thinking.of(|| policy.decide_told(&seen.picture, &seen.camera, told, stage.sight()));
        let (pick, place) = match decision {
            Ok(Decision::Move { pick, place }) => (pick, place),
            Ok(Decision::Done) => return all,
            Err(error) => {
                all.failure = Some((number, PlanFailure::Undecided(error.to_string())));
                return all;
            }
        };
        if (0..ticks).any(|_| stage.tick(&[]).is_err()) {
            all.failure = Some((number, PlanFailure::Stopped));
            return all;
        }
        let Some((id, object)) = taken(stage.sight(), pick) else {
            all.failure = Some((number, PlanFailure::NothingThere));
            return all;
        };
        tell(number, id, place.location);
        next = to_put(id, object, place, stage.sight());
        let own = |id: &String| (id.clone(), id.clone());
        binding.0 = stage.sight().objects.keys().map(own).collect();
    }
    all.failure = Some((most, PlanFailure::Endless));
    all
}

/// The failure of a task that counts as done in a world that began with these objects and is now so: as the task demands it of these objects, or of others that
/// look the same.
pub fn left_undone(
    task: &Task,
    binding: &Binding,
    objects: &[ObjectSpec],
    before: &Before,
    now: &Sight,
) -> Option<(usize, PlanFailure)> {
    let bindings = bindings(task, binding, objects);
    let mut failures = bindings
        .iter()
        .map(|binding| undone(task, binding, now, before));
    failures
        .next()
        .flatten()
        .filter(|_| failures.all(|it| it.is_some()))
}

/// The movable object whose origin is nearest to a place, if it is within a grasp's reach.
fn taken(sight: &Sight, pick: ObjectPlace) -> Option<(&str, &SeenObject)> {
    let movable = sight.objects.iter().filter(|(_, object)| !object.is_fixed);
    let off = |object: &SeenObject| object.pose.location.distance(pick.location);
    let near = movable.filter(|(_, object)| off(object) <= GRASP);
    let nearest = near.min_by(|one, other| off(one.1).total_cmp(&off(other.1)));
    nearest.map(|(id, object)| (id.as_str(), object))
}

/// The task to put an object at a place.
fn to_put(id: &str, object: &SeenObject, place: ObjectPlace, sight: &Sight) -> Task {
    let symmetry = Symmetry::of(&object.shape);
    let pose = pose_at(&symmetry, object.pose, place);
    let others = sight.objects.iter().filter(|(other, _)| *other != id);
    let others = others.map(|(other, object)| (other.as_str(), &object.shape, object.pose));
    let there = Arrangement::new(others.chain([(id, &object.shape, pose)]));
    let supports = there.supports(id);
    let goal = Goal {
        reference: Reference::Table,
        pose,
        up: Vec3::Z,
        freedom: Freedom::from(&symmetry),
        place: PlaceRange::Exact,
    };
    let step = TaskStep {
        number: 1,
        sentence: String::new(),
        object: id.to_owned(),
        hands: Vec::new(),
        load: Vec::new(),
        spilled: None,
        grasp: SimTick(0),
        release: SimTick(0),
        meanwhile: false,
        relations: supports
            .iter()
            .map(|&object| Relation::On {
                object: object.to_owned(),
            })
            .collect(),
        goal: Some(goal),
        tipping: None,
        after: Vec::new(),
    };
    let role = Role {
        id: id.to_owned(),
        noun: id.to_owned(),
        shown: ObjectSpec::new(id.to_owned(), object.pose, 1.0, object.shape.clone()),
        symmetry,
    };
    Task {
        roles: vec![role],
        joints: sight.joints.clone(),
        steps: vec![step],
        ..Task::without_steps(sight.table)
    }
}
