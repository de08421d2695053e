//! Curricula: samples of what a demonstration shows, without end.

use bevy::math::{Quat, Vec2};
use tabletop_camera::Rasterizer;
use tabletop_core::Random;
use tabletop_episodes::{
    StillScene,
    multiplication::{Multiplication, VariedBeginning},
};
use tabletop_geometry::{Pose, turn_about_z};
use tabletop_task::{Role, Task, TaskStep};

use crate::{
    error::PolicyError,
    heading::heading,
    label::{HeatMark, Label, MOST_LEVELS},
    planes::Planes,
    table_view::{pixel_behind, view_of},
};

/// Heights of a task that differ by less, in units, are one.
const SAME_HEIGHT: f32 = 0.05;
/// How far, in units along X and Y and in rad, objects have been put from where they belong: what a policy does must not confuse it.
const CARELESS: (f32, f32) = (0.12, 0.1);
/// Attempts at a scene in which the camera sees everything.
const TRIES: u64 = 20;
/// Mixes indices and seeds.
const MIXER: u64 = 0xd6e8_feb8_6659_fd93;

/// What there is to learn: scenes in which a task begins, drawn from one demonstration.
#[derive(Debug)]
pub struct Curriculum<'a> {
    multiplication: &'a Multiplication,
    /// The heights at which objects are taken and put, in units, ascending.
    levels: Vec<f32>,
    count: u64,
}

/// A view, and what is to be done.
pub(crate) struct Sample {
    pub view: Planes,
    pub label: Label,
}

impl<'a> Curriculum<'a> {
    /// The curriculum of the first `count` scenes.
    ///
    /// # Errors
    /// The task has steps that a policy cannot do, or too many heights.
    pub fn new(multiplication: &'a Multiplication, count: u64) -> Result<Self, PolicyError> {
        let task = multiplication.task();
        if let Some(step) = task.steps.iter().find(|step| step.goal.is_none()) {
            return Err(PolicyError::NoPlace(step.number));
        }
        let mut curriculum = Self {
            multiplication,
            levels: Vec::new(),
            count: count.max(1),
        };
        curriculum.levels = curriculum.heights()?;
        match curriculum.levels.len() {
            0..=MOST_LEVELS => Ok(curriculum),
            more => Err(PolicyError::TooManyLevels(more)),
        }
    }

    /// The task.
    pub fn task(&self) -> &Task {
        self.multiplication.task()
    }

    /// The number of its scenes; those from here on are unseen.
    pub fn count(&self) -> u64 {
        self.count
    }

    pub(crate) fn levels(&self) -> &[f32] {
        &self.levels
    }

    /// Of all that decides its samples.
    pub(crate) fn fingerprint(&self) -> String {
        let of = self.multiplication;
        let (fingerprint, variation) = (of.fingerprint(), of.variation());
        format!(
            "{fingerprint}, seed {}, {} of {variation:?}",
            of.seed(),
            self.count
        )
    }

    fn heights(&self) -> Result<Vec<f32>, PolicyError> {
        let (beginning, mut scene) = self.begin(0)?;
        let mut heights = Vec::new();
        for step in &self.task().steps {
            let (id, _, goal) = handled(self.task(), step, &scene, &beginning)?;
            heights.extend(scene.pose(&id).map(|pose| pose.location.z));
            heights.push(goal.location.z);
            scene.carry(step, &beginning.binding, goal);
        }
        heights.sort_by(f32::total_cmp);
        heights.dedup_by(|one, other| (*one - *other).abs() < SAME_HEIGHT);
        Ok(heights)
    }

    /// A scene in which the camera sees all that the task moves, from beginning to end.
    pub(crate) fn begin(&self, number: u64) -> Result<(VariedBeginning, StillScene), PolicyError> {
        for attempt in 0..TRIES {
            if let Ok(beginning) = self.multiplication.beginning(number, attempt)? {
                let scene = beginning.still_scene();
                if scene.keeps_in_view(self.task(), &beginning.binding) {
                    return Ok((beginning, scene));
                }
            }
        }
        Err(PolicyError::NothingSeen)
    }

    /// The sample of this number: of a scene in which some steps have been done, not quite exactly.
    pub(crate) fn sample(
        &self,
        number: u64,
        rasterizer: &mut Rasterizer,
    ) -> Result<Sample, PolicyError> {
        let random = &mut Random::new(number.wrapping_mul(MIXER));
        let steps = &self.task().steps;
        let (beginning, mut scene) = self.begin(random.bits() % self.count)?;
        let done = (random.bits() % (steps.len() as u64 + 1)) as usize;
        for step in &steps[..done] {
            let (_, _, goal) = handled(self.task(), step, &scene, &beginning)?;
            scene.carry(step, &beginning.binding, carelessly(goal, random));
        }
        let view = view_of(&scene.picture(rasterizer), &scene.camera);
        let Some(step) = steps.get(done) else {
            let label = Label::Done;
            return Ok(Sample { view, label });
        };
        let (id, role, goal) = handled(self.task(), step, &scene, &beginning)?;
        let from = scene.pose(&id).unwrap_or_default();
        let [pick, place] = [from, goal].map(|pose| HeatMark {
            at: pixel_behind(scene.camera.pose.location, pose.location),
            level: self.level_of(pose.location.z),
            heading: heading(&role.symmetry, pose),
        });
        let label = Label::Move { pick, place };
        Ok(Sample { view, label })
    }

    fn level_of(&self, height: f32) -> usize {
        let off = |level: &usize| (self.levels[*level] - height).abs();
        let levels = 0..self.levels.len();
        let nearest = levels.min_by(|one, other| off(one).total_cmp(&off(other)));
        nearest.unwrap_or(0)
    }
}

/// The object that a step moves, its role and the pose to which the step brings it.
fn handled<'a>(
    task: &'a Task,
    step: &TaskStep,
    scene: &StillScene,
    beginning: &VariedBeginning,
) -> Result<(String, &'a Role, Pose), PolicyError> {
    let id = beginning.binding.object(&step.object);
    let id = id.filter(|id| scene.pose(id).is_some());
    let goal = scene.goal(step, &beginning.binding);
    let all = id.zip(task.role(&step.object)).zip(goal);
    let ((id, role), goal) = all.ok_or(PolicyError::NoPlace(step.number))?;
    Ok((id.to_owned(), role, goal))
}

fn carelessly(goal: Pose, random: &mut Random) -> Pose {
    let (length, angle) = CARELESS;
    let [x, y, turn] = [length, length, angle].map(|most| random.between((-most, most)));
    let turn: Quat = turn_about_z(f64::from(turn)).as_quat();
    Pose::new(
        goal.location + Vec2::new(x, y).extend(0.0),
        (turn * goal.rotation).normalize(),
    )
}
