//! Evaluation: a policy acts in scenes that it has not seen, until it says that the task is done. Nothing moves but what it moves, and that exactly as it
//! decides.

use std::fmt;

use bevy::math::Quat;
use tabletop_camera::Rasterizer;
use tabletop_core::ObjectSpec;
use tabletop_episodes::{StillScene, multiplication::VariedBeginning};
use tabletop_geometry::{Pose, turn_about_z};
use tabletop_task::{Arrangement, Binding, Symmetry, Task};

use crate::{
    curriculum::Curriculum,
    error::PolicyError,
    heading::heading,
    policy::{Decision, ObjectPlace, Policy},
};

/// The result of some scenes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Evaluation {
    /// Numbers of the scenes in which the task was done.
    pub done: Vec<u64>,
    /// The failure of each other scene.
    pub failed: Vec<(u64, PolicyFailure)>,
    /// The distance, in units, of every place at which an object was taken from its origin.
    pub pick_errors: Vec<f32>,
    /// Number of moves.
    pub moves: usize,
}

/// The failure of a policy in a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PolicyFailure {
    /// It wanted to take something where nothing is.
    TookNothing,
    /// It said after so many moves that the task is done, and it is not.
    NotDone(usize),
    /// It went on for ever.
    Endless,
}

impl fmt::Display for PolicyFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TookNothing => f.write_str("the policy took something where nothing is"),
            Self::NotDone(moves) => write!(
                f,
                "the policy said after {moves} moves that the task is done, and it is not"
            ),
            Self::Endless => {
                f.write_str("the policy went on after twice as many moves as were shown")
            }
        }
    }
}

/// The largest distance, in units, between an object's origin and the place where a hand that takes it should find it.
pub(crate) const GRASP: f32 = 0.5;
/// The largest distance, in units, between where an object is in the end and where it should be: within a quarter of a block's width, a block stands on another.
const TOLERANCE: f32 = 0.25;
/// Most objects that look alike whose roles are exchanged.
const MOST_ALIKE: usize = 4;

impl Policy {
    /// Does the task in `count` scenes of a curriculum that it has not learned from.
    ///
    /// # Errors
    /// There are no such scenes.
    pub fn evaluate(&self, curriculum: &Curriculum, count: u64) -> Result<Evaluation, PolicyError> {
        let mut evaluation = Evaluation::default();
        let mut rasterizer = Rasterizer::alone();
        for number in curriculum.count()..curriculum.count() + count {
            let (beginning, scene) = curriculum.begin(number)?;
            let result = self.act(
                curriculum.task(),
                &beginning,
                scene,
                &mut rasterizer,
                &mut evaluation,
            );
            match result {
                Ok(()) => evaluation.done.push(number),
                Err(failure) => evaluation.failed.push((number, failure)),
            }
        }
        Ok(evaluation)
    }

    fn act(
        &self,
        task: &Task,
        beginning: &VariedBeginning,
        mut scene: StillScene,
        rasterizer: &mut Rasterizer,
        evaluation: &mut Evaluation,
    ) -> Result<(), PolicyFailure> {
        let bindings = bindings(task, &beginning.binding, &beginning.objects);
        for moves in 0..=2 * task.steps.len() {
            let picture = scene.picture(rasterizer);
            match self.decide(&picture, &scene.camera) {
                Decision::Move { pick, place } => {
                    let (id, pose, off) = taken(&scene, pick).ok_or(PolicyFailure::TookNothing)?;
                    let object = scene.objects.iter().find(|object| object.id == id);
                    let symmetry = object.map(|object| Symmetry::of(&object.shape));
                    let symmetry = symmetry.unwrap_or_else(Symmetry::none);
                    scene.put(&id, pose_at(&symmetry, pose, place));
                    evaluation.pick_errors.push(off);
                    evaluation.moves += 1;
                }
                Decision::Done => {
                    let mut bindings = bindings.iter();
                    let is_done = bindings.any(|binding| scene.shows(task, binding, TOLERANCE));
                    return is_done.then_some(()).ok_or(PolicyFailure::NotDone(moves));
                }
            }
        }
        Err(PolicyFailure::Endless)
    }
}

/// The object that is taken at a place, its pose, and how far its origin is from there.
fn taken(scene: &StillScene, pick: ObjectPlace) -> Option<(String, Pose, f32)> {
    let movable = scene.objects.iter().filter(|object| !object.is_fixed());
    let distances = movable.map(|object| {
        let off = object.pose.location.distance(pick.location);
        (object.id.clone(), object.pose, off)
    });
    let nearest = distances.min_by(|one, other| one.2.total_cmp(&other.2));
    nearest.filter(|(.., off)| *off <= GRASP)
}

/// The pose of an object that is brought to a place: turned as little as makes it look as it should.
pub(crate) fn pose_at(symmetry: &Symmetry, pose: Pose, place: ObjectPlace) -> Pose {
    let turn = heading(symmetry, pose).yaw().zip(place.yaw);
    let turn = turn.map_or(0.0, |(now, wanted)| now.turn_to(wanted));
    let turn: Quat = turn_about_z(f64::from(turn)).as_quat();
    Pose::new(place.location, (turn * pose.rotation).normalize())
}

/// The ways in which objects can take the roles: those that look alike, and carry nothing at first, can take each other's.
pub(crate) fn bindings(task: &Task, binding: &Binding, objects: &[ObjectSpec]) -> Vec<Binding> {
    let object = |id: &str| objects.iter().find(|object| object.id == id);
    let arrangement = objects.iter();
    let arrangement = Arrangement::new(
        arrangement.map(|object| (object.id.as_str(), &object.shape, object.pose)),
    );
    let free = |id: &str| arrangement.standing_on(id).is_empty();
    let mut bindings = vec![binding.clone()];
    for (i, role) in task.roles.iter().enumerate() {
        let later = task.roles[i + 1..].iter().take(MOST_ALIKE);
        for other in later {
            let pair = [&role.id, &other.id].map(|role| binding.object(role));
            let [Some(one), Some(two)] = pair else {
                continue;
            };
            let shapes = [one, two].map(|id| object(id).map(|object| &object.shape));
            if shapes[0] == shapes[1] && free(one) && free(two) {
                for binding in bindings.clone() {
                    let mut exchanged = binding.clone();
                    let ids = [&role.id, &other.id].map(|role| binding.0[role].clone());
                    let [of_role, of_other] = ids;
                    exchanged.0.insert(role.id.clone(), of_other);
                    exchanged.0.insert(other.id.clone(), of_role);
                    bindings.push(exchanged);
                }
            }
        }
    }
    bindings
}

impl Evaluation {
    /// The mean distance of places where objects were taken from their origins, in units.
    pub fn mean_pick_error(&self) -> f32 {
        self.pick_errors.iter().sum::<f32>() / self.pick_errors.len().max(1) as f32
    }
}
