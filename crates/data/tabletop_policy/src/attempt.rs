//! Attempts: a robot does a demonstrated task once, as its planner or a policy decides.

use bevy::{math::Vec3, prelude::App};
use tabletop_camera::Camera;
use tabletop_core::{CameraCarrier, HeadCamera, ObjectSpec, SceneSpec, TICKS_PER_SECOND, Table};
use tabletop_episodes::{
    imitation::{AppStage, HeadCameraStage, SeeingStage, imitate_seeing, scattered_for},
    multiplication::with_colors_exchanged,
};
use tabletop_planner::{Before, Doing, Imitation, PlanningStage as _, RobotBody, imitate};
use tabletop_robot::RobotPlugin;
use tabletop_task::{Binding, Requirements, Task};

use crate::{
    acting::{follow_policy, left_undone},
    acting_policy::ActingPolicy,
    driven_task::DrivenTask,
    driving::follow_actions,
    known_table::ToldTask,
    picture_policy::PicturePolicy,
    remote_policy::RemotePolicy,
    thinking_time::ThinkingTime,
};

/// Simulated time, in s, that a policy which moves joints has for each step of a task.
const SECONDS_PER_STEP: u64 = 30;
/// The most moves of a policy that says which object is to be put where, for each step of a task.
const MOVES_PER_STEP: usize = 2;

/// How a robot does a demonstrated task once.
#[derive(Clone, Copy)]
pub struct Attempt<'a> {
    /// The task.
    pub task: &'a Task,
    /// What it requires of its objects.
    pub requirements: &'a Requirements,
    /// The scene that it begins with, unless a seed changes it.
    pub scene: &'a SceneSpec,
    /// The robot.
    pub robot: &'a RobotPlugin,
    /// Its body, at the scene's table.
    pub body: &'a RobotBody,
    /// True if colours are exchanged, as the seed decides.
    pub exchanges_colors: bool,
    /// True if the robot is not told where objects are.
    pub has_eyes: bool,
    /// The policy that decides; `None` for the planner.
    pub policy: Option<&'a ActingPolicy>,
    /// What the simulation does while the policy thinks.
    pub thinking: ThinkingTime,
    /// Where everything is put; `None` for the places of the scene.
    pub seed: Option<u64>,
}

/// What the robot does in an attempt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AttemptProgress<'a> {
    /// A step of the task.
    Step(Doing),
    /// A move that a policy has decided on, by its number: the object, and where it is put, in units.
    Move(usize, &'a str, Vec3),
}

impl Attempt<'_> {
    /// The scene that it begins with; `None` if there is no room for everything.
    pub fn beginning(&self) -> Option<SceneSpec> {
        let scene = match self.exchanges_colors {
            true => with_colors_exchanged(self.scene.clone(), self.seed.unwrap_or(0)),
            false => self.scene.clone(),
        };
        let Some(seed) = self.seed else {
            return Some(scene);
        };
        let table = &scene.table;
        let camera = self.policy.and_then(|policy| self.camera_of(policy, table));
        scattered_for(
            self.task,
            self.requirements,
            &scene,
            self.body,
            camera,
            seed,
        )
    }

    /// The camera by whose pictures a policy decides.
    fn camera_of(&self, policy: &ActingPolicy, table: &Table) -> Option<Camera> {
        policy.picture_policy()?;
        let mut head = HeadCamera::default();
        policy.resize(&mut head);
        head.carrier = CameraCarrier::from(self.robot.layout());
        Some(Camera::of_head(&head, table))
    }

    /// Lets the robot of a world do it with these objects, to which the task is bound.
    pub fn perform(
        &self,
        app: &mut App,
        binding: &Binding,
        objects: &[ObjectSpec],
        tell: &mut dyn FnMut(AttemptProgress<'_>),
    ) -> Imitation {
        match self.policy {
            None => self.plan(app, binding, objects, tell),
            Some(ActingPolicy::Motions(policy)) => self.drive(policy, app, binding, objects),
            Some(ActingPolicy::Places(policy)) => self.look(&**policy, app, binding, objects, tell),
            Some(ActingPolicy::ServedPlaces(policy)) => {
                self.look(&**policy, app, binding, objects, tell)
            }
        }
    }

    /// The planner decides.
    fn plan(
        &self,
        app: &mut App,
        binding: &Binding,
        objects: &[ObjectSpec],
        tell: &mut dyn FnMut(AttemptProgress<'_>),
    ) -> Imitation {
        let (task, seed) = (self.task, self.seed.unwrap_or(0));
        let tell = |doing| tell(AttemptProgress::Step(doing));
        match self.has_eyes {
            true => imitate_seeing(app, self.body, task, binding, objects, seed, tell),
            false => {
                let mut stage = AppStage::new(app);
                imitate(&mut stage, self.body, task, binding, seed, tell)
            }
        }
    }

    /// A policy decides by pictures which object is to be put where.
    fn look(
        &self,
        policy: &dyn PicturePolicy,
        app: &mut App,
        binding: &Binding,
        objects: &[ObjectSpec],
        tell: &mut dyn FnMut(AttemptProgress<'_>),
    ) -> Imitation {
        let before = Before::anything(AppStage::new(app).sight());
        let mut imitation = match self.has_eyes {
            true => {
                let stage = SeeingStage::of_task(app, self.body, self.task, binding, objects);
                self.follow(policy, stage, objects, tell)
            }
            false => self.follow(policy, AppStage::new(app), objects, tell),
        };
        if imitation.failure.is_none() {
            let stage = AppStage::new(app);
            imitation.failure = left_undone(self.task, binding, objects, &before, stage.sight());
        }
        imitation
    }

    fn follow(
        &self,
        policy: &dyn PicturePolicy,
        mut stage: impl HeadCameraStage,
        objects: &[ObjectSpec],
        tell: &mut dyn FnMut(AttemptProgress<'_>),
    ) -> Imitation {
        let words = words_of(self.task);
        let told = ToldTask {
            words: &words,
            objects,
        };
        follow_policy(
            policy,
            self.thinking,
            &mut stage,
            self.body,
            &told,
            MOVES_PER_STEP * self.task.steps.len(),
            self.seed.unwrap_or(0),
            |number, object, to| tell(AttemptProgress::Move(number, object, to)),
        )
    }

    /// A policy moves the robot's joints.
    fn drive(
        &self,
        policy: &RemotePolicy,
        app: &mut App,
        binding: &Binding,
        objects: &[ObjectSpec],
    ) -> Imitation {
        let task = self.task;
        let before = Before::anything(AppStage::new(app).sight());
        let left = |now: &_| left_undone(task, binding, objects, &before, now);
        let seconds = task.steps.len() as u64 * SECONDS_PER_STEP;
        let driven = DrivenTask {
            prompt: &words_of(task),
            most: seconds * u64::from(TICKS_PER_SECOND),
            thinking: self.thinking,
            displacement: None,
        };
        let is_done = |now: &_| left(now).is_none();
        let failure = match follow_actions(policy, app.world_mut(), &driven, is_done) {
            Ok(()) => left(AppStage::new(app).sight()),
            Err(failure) => Some((1, failure)),
        };
        Imitation {
            steps_done: match failure {
                Some((step, _)) => step.saturating_sub(1),
                None => task.steps.len(),
            },
            corrections: 0,
            failure,
        }
    }
}

/// A task in words.
fn words_of(task: &Task) -> String {
    let sentences: Vec<_> = task.steps.iter().map(|step| &*step.sentence).collect();
    sentences.join(" ")
}
