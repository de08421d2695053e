//! Whoever lets a policy do an episode, and says what became of it.

use std::path::PathBuf;

use crate::{
    Collection, TabletopSimPlugins,
    benchmark::{
        BENCHMARK_VERSION, BeginningError, JudgedEpisode, JudgedTask, JudgementHeader,
        TaskBeginning,
    },
    core::{
        CameraCarrier, HeadCamera, RecordingCommand, RobotCommand, SceneCommand, SimTick,
        StepApp as _, TICKS_PER_SECOND, Table, WriteCommand as _,
    },
    headless_app_with,
    imitation::AppStage,
    planner::{PlanFailure, PlanningStage as _, RobotBody},
    policy::{ActingPolicy, DrivenTask, ThinkingTime, ToldTask, follow_actions, follow_policy},
    recorder::{RecorderPlugin, SessionHeader, UnrecordedPlugin},
    robot::RobotPlugin,
    robot_body,
};
use bevy::prelude::*;
use serde_json::{Map, Value, json};

use crate::cli::{Failure, multiply::refused, recorded};

/// Number of ticks after which a scene is at rest.
const SETTLING: u64 = 30;
/// The most moves of a policy that says which object is to be put where, for each step of a task.
const MOVES: usize = 2;

/// Whoever lets a policy do episodes.
pub(super) struct PolicyJudge<'a> {
    policy: &'a ActingPolicy,
    thinking: ThinkingTime,
    robot: RobotPlugin,
    body: RobotBody,
    carrier: CameraCarrier,
    header: &'a JudgementHeader,
    collection: Option<&'a Collection>,
}

impl<'a> PolicyJudge<'a> {
    /// Who lets a policy do the episodes of a judgement, with a robot, and records them in a collection if there is one.
    pub fn new(
        policy: &'a ActingPolicy,
        thinking: ThinkingTime,
        robot: RobotPlugin,
        header: &'a JudgementHeader,
        collection: Option<&'a Collection>,
    ) -> Result<Self, Failure> {
        Ok(Self {
            policy,
            thinking,
            body: robot_body(&robot, &Table::default()).map_err(Failure::run)?,
            carrier: CameraCarrier::from(robot.layout()),
            robot,
            header,
            collection,
        })
    }

    /// The episode of a number.
    pub fn episode(&self, number: u64) -> Result<JudgedEpisode, Failure> {
        let beginning = self.beginning(number)?;
        // A recording that is whole, and whose episode was not noted any more, stays.
        let is_right = |header: &SessionHeader| {
            header.settings.get("beginning") == Some(&json!(beginning.fingerprint))
        };
        let holds = self.collection.map(|it| it.holds(number, is_right));
        let holds = holds.transpose().map_err(refused)?;
        let recorded = self.collection.filter(|_| holds == Some(false));
        let folder = recorded.map(|collection| collection.part(number));
        let mut app = self.begin(&beginning, folder);
        if recorded.is_some() {
            app.world_mut().write_command(RecordingCommand::Start);
        }
        // With and without a recording, as much time passes.
        app.step(1);
        let failure = self.act(&mut app, &beginning);
        app.step(SETTLING);
        let left = {
            let stage = AppStage::new(&mut app);
            match beginning.is_done(stage.sight()) {
                true => Vec::new(),
                false => beginning.left(stage.sight()),
            }
        };
        // Before the tick in which the recording ends.
        let ticks = app.world().resource::<SimTick>().0;
        recorded::finish(&mut app)?;
        let failure = failure
            .as_ref()
            .map(|failure| (failure.class(), failure.to_string()))
            .or_else(|| (!left.is_empty()).then(|| self.shortfall(&beginning.task)));
        let episode = JudgedEpisode::new(&beginning, left, failure, ticks);
        if let Some(lost) = self.policy.served().and_then(|policy| policy.lost()) {
            let fault = format!(
                "{}: {lost}; the episodes before it are kept in --json, and the same command goes on",
                episode.name()
            );
            return Err(Failure::run(fault));
        }
        if let Some(collection) = recorded {
            collection.keep(number).map_err(refused)?;
        }
        Ok(episode)
    }

    fn beginning(&self, number: u64) -> Result<TaskBeginning, Failure> {
        let episode = self.header.episode(number);
        let known = episode.and_then(|(task, episode, perturbation)| {
            Some((JudgedTask::named(&task.name)?, episode, perturbation))
        });
        let (task, episode, perturbation) =
            known.ok_or_else(|| Failure::run(format!("episode {number} is of no task")))?;
        let begun = task.begin(episode, &self.body, self.carrier);
        let begun = begun.and_then(|begun| match perturbation {
            None => Ok(begun),
            Some(perturbation) => begun.perturbed(perturbation, &self.body, self.carrier),
        });
        begun.map_err(|error| match error {
            BeginningError::NoRoom(..) | BeginningError::Unperturbed(..) => Failure::input(error),
            BeginningError::Sentence(..) => Failure::run(error),
        })
    }

    /// What a policy failed by that did nothing wrong, and yet not all, as a class and in words.
    fn shortfall(&self, task: &JudgedTask) -> (&'static str, String) {
        match self.policy {
            ActingPolicy::Motions(_) => ("late", format!("{} s were over", task.seconds)),
            ActingPolicy::Places(_) | ActingPolicy::ServedPlaces(_) => {
                ("premature", "the policy said that all was done".into())
            }
        }
    }

    /// A world that begins so, with the robot at the table, and recorded in a folder if there is one.
    fn begin(&self, beginning: &TaskBeginning, folder: Option<PathBuf>) -> App {
        let plugins = TabletopSimPlugins.build().set(self.robot.clone());
        let plugins = match folder {
            None => plugins.disable::<RecorderPlugin>().add(UnrecordedPlugin),
            Some(folder) => plugins.set(RecorderPlugin {
                folder,
                header: described(beginning),
                ..default()
            }),
        };
        let mut app = headless_app_with(plugins);
        let world = app.world_mut();
        let mut head = world.resource_mut::<HeadCamera>();
        self.policy.resize(&mut head);
        head.light = beginning.light;
        let usual = head.pose(&beginning.scene.table);
        head.mount = beginning
            .displacement
            .map(|displacement| displacement.of(usual));
        let scene = Box::new(beginning.scene.clone());
        world.write_command(SceneCommand::Set(scene));
        world.write_command(RobotCommand::Show(true));
        app.step(SETTLING);
        app
    }

    /// Lets the policy act until the task is done, it says so, or its time is over.
    fn act(&self, app: &mut App, beginning: &TaskBeginning) -> Option<PlanFailure> {
        let acting = match self.policy {
            ActingPolicy::Motions(policy) => {
                let driven = DrivenTask {
                    prompt: &beginning.words,
                    most: beginning.task.seconds * u64::from(TICKS_PER_SECOND),
                    thinking: self.thinking,
                    displacement: beginning.displacement,
                };
                let is_done = |now: &_| beginning.is_done(now);
                return follow_actions(policy, app.world_mut(), &driven, is_done).err();
            }
            ActingPolicy::Places(policy) => &**policy,
            ActingPolicy::ServedPlaces(policy) => &**policy,
        };
        let told = ToldTask {
            words: &beginning.words,
            objects: beginning.objects(),
        };
        let most = MOVES * beginning.step_count();
        let (mut stage, seed) = (AppStage::new(app), beginning.seed);
        let followed = follow_policy(
            acting,
            self.thinking,
            &mut stage,
            &self.body,
            &told,
            most,
            seed,
            |_, _, _| {},
        );
        followed.failure.map(|(_, failure)| failure)
    }
}

/// What a recording says of the episode that it shows.
fn described(beginning: &TaskBeginning) -> Map<String, Value> {
    let perturbation = beginning.perturbation.map(|it| ("perturbation", json!(it)));
    let always = [
        ("benchmark", json!(BENCHMARK_VERSION)),
        ("task", json!(beginning.task.name)),
        ("episode", json!(beginning.episode)),
        ("beginning", json!(beginning.fingerprint)),
    ];
    let all = always.into_iter().chain(perturbation);
    all.map(|(key, value)| (key.into(), value)).collect()
}
