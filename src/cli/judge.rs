//! `tabletop benchmark --policy`: how often a policy does tasks with fixed beginnings.

use std::{
    collections::BTreeSet,
    path::{Path, PathBuf},
    process::ExitCode,
    time::Instant,
};

use crate::{
    Collection, TabletopSimPlugins,
    benchmark::{
        BENCHMARK_VERSION, BeginningError, JUDGED_TASKS, JudgedEpisode, JudgedTask, JudgementError,
        JudgementFile, JudgementHeader, NamedTask, PolicyJudgement, TaskBeginning, paired_report,
        report,
    },
    core::{
        CameraCarrier, HeadCamera, RecordingCommand, RobotCommand, RobotLayout, RobotMode,
        SceneCommand, SimTick, StepApp as _, TICKS_PER_SECOND, Table, WriteCommand as _,
    },
    headless_app_with,
    imitation::AppStage,
    multiplication::Fingerprint,
    planner::{PlanFailure, PlanningStage as _, RobotBody},
    policy::{ToldTask, follow_actions, follow_policy},
    recorder::{RecorderPlugin, SessionHeader, UnrecordedPlugin},
    robot::RobotPlugin,
    robot_body, run_episodes,
    storage::{Symlinks, read_regular_file},
    wire::{WireMap, WireValue},
};
use bevy::prelude::*;
use clap::Args;
use serde_json::{Map, Value, json};

use super::{
    Failure, Output,
    acting_policy::{ActingPolicy, PolicyOptions},
    jobs::at_a_time,
    multiply::refused,
    progress::ProgressLine,
    range::NumberRange,
    recorded,
    result_file::{ResultFile, ResultKind, require_outside},
    robot_options::RobotChoice,
    shard::ShardOption,
    wait::WaitOption,
};

const EPISODES: NumberRange<u64> = NumberRange::whole(1, 100_000);
/// Most bytes of a policy's file.
const MOST_BYTES: u64 = 1 << 32;
/// The file with what a folder of recordings is made of.
const MANIFEST: &str = "benchmark.json";
/// Number of ticks after which a scene is at rest.
const SETTLING: u64 = 30;
/// The most moves of a policy that says which object is to be put where, for each step of a task.
const MOVES: usize = 2;

#[derive(Args)]
pub(super) struct JudgeOptions {
    #[command(flatten)]
    policy: PolicyOptions,
    #[command(flatten)]
    robot: RobotChoice,
    /// Number of episodes of each task, from 1 to 100000
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = EPISODES, requires = "policy", allow_negative_numbers = true)]
    episodes: u64,
    #[command(flatten)]
    shard: ShardOption,
    /// Write each episode into this file as soon as it is over, in a line of JSON, with all that is needed to repeat it; those that are there are not repeated
    #[arg(long, value_name = "FILE", requires = "judged")]
    json: Option<PathBuf>,
    /// Record the robot, each episode in a folder of its number below this one
    #[arg(long, value_name = "DIR", requires = "policy")]
    record: Option<PathBuf>,
    /// Judge by the episodes in these files of --json, such as those of shards, together
    #[arg(long, value_name = "FILE", num_args = 1..)]
    merge: Vec<PathBuf>,
    /// Compare with another policy in the episodes of this file of --json that begin alike
    #[arg(long, value_name = "FILE", requires = "judged")]
    beside: Option<PathBuf>,
    #[command(flatten)]
    wait: WaitOption,
}

impl JudgeOptions {
    /// True if a policy is to be judged.
    pub fn is_asked(&self) -> bool {
        self.policy.name().is_some() || !self.merge.is_empty()
    }

    /// Judges a policy in the tasks whose names begin so, and says how often it did them.
    pub fn judge(&self, names: &[String], jobs: Option<usize>) -> Result<ExitCode, Failure> {
        let other = self.beside.as_deref().map(PolicyJudgement::read);
        let other = other.transpose().map_err(Failure::input)?;
        if let Some(file) = &self.json {
            ResultFile::replacing(file, ResultKind::Json)?;
        }
        let merged = PolicyJudgement::merged(&self.merge).map_err(Failure::input)?;
        let (judgement, times) = match (merged, self.policy.name()) {
            (None, Some(policy)) => self.judge_policy(policy, names, jobs)?,
            (Some(merged), _) => (self.merged(merged, names)?, String::new()),
            (None, None) => return Err(Failure::input("name a policy with --policy")),
        };
        let mut text = report(&judgement);
        if let (Some(other), Some(file)) = (&other, &self.beside) {
            let paired = paired_report(&judgement, other);
            let paired =
                paired.map_err(|fault| Failure::input(format!("{}: {fault}", file.display())))?;
            text += &format!("\nBeside {}:\n\n{paired}", file.display());
        }
        Output::tell(&(text + &times))?;
        Ok(ExitCode::SUCCESS)
    }

    fn merged(
        &self,
        merged: PolicyJudgement,
        names: &[String],
    ) -> Result<PolicyJudgement, Failure> {
        if !names.is_empty() {
            return Err(Failure::input(
                "--merge takes all tasks of its files; name none",
            ));
        }
        if let Some((task, episode)) = merged.missing() {
            return Err(Failure::input(format!(
                "{task}, episode {episode}: it is in none of these files"
            )));
        }
        if let Some(file) = &self.json {
            let file = ResultFile::replacing(file, ResultKind::Json)?;
            file.write(merged.lines().as_bytes())?;
        }
        Ok(merged)
    }

    /// The judgement, and in words how long it took.
    fn judge_policy(
        &self,
        name: &Path,
        names: &[String],
        jobs: Option<usize>,
    ) -> Result<(PolicyJudgement, String), Failure> {
        let tasks = tasks_of(names)?;
        let robot = self.robot.plugin()?;
        let policy = self.policy.read(&robot)?;
        let policy = policy.ok_or_else(|| Failure::input("name a policy with --policy"))?;
        let header = self.header(name, &policy, &robot, &tasks)?;
        let storage = self.wait.storage();
        let (mut file, mut judgement) = match &self.json {
            None => (None, PolicyJudgement::new(header.clone())),
            Some(path) => {
                let opened = JudgementFile::open(path, &header, &storage);
                let (file, judgement) = opened.map_err(failure)?;
                (Some(file), judgement)
            }
        };
        let collection = match &self.record {
            None => None,
            Some(folder) => {
                require_outside(folder, &[])?;
                let opened = Collection::open(folder, MANIFEST, &json!(header), &storage);
                Some(opened.map_err(refused)?)
            }
        };
        let table = Table::default();
        let judge = PolicyJudge {
            policy: &policy,
            body: robot_body(&robot, &table).map_err(Failure::run)?,
            carrier: CameraCarrier::from(layout(&robot)),
            robot,
            tasks: &tasks,
            collection: collection.as_ref(),
        };
        let all = tasks.len() as u64 * self.episodes;
        let numbers = self.shard.share_of(0..all);
        let missing: Vec<_> = numbers.filter(|number| !judgement.holds(*number)).collect();
        let mut progress = ProgressLine::new(missing.len() as u64, " episodes");
        let (start, mut done, mut ticks) = (Instant::now(), 0, 0);
        let jobs = at_a_time(jobs, missing.len());
        let judged = run_episodes(
            missing.iter().copied(),
            jobs,
            |number| judge.episode(number),
            |_, episode: JudgedEpisode| {
                done += 1;
                ticks += episode.ticks;
                progress.reach(done, "");
                if let Some(file) = &mut file {
                    file.append(&episode).map_err(failure)?;
                }
                judgement.add(episode).map_err(Failure::run)
            },
        );
        progress.end();
        let finished = file.map_or(Ok(()), |file| file.finish(&judgement).map_err(failure));
        let closed = collection.map_or(Ok(()), |it| it.close().map_err(refused));
        Failure::of_all([judged, finished, closed])?;
        let (simulated, real) = (
            ticks as f64 / f64::from(TICKS_PER_SECOND),
            start.elapsed().as_secs_f64(),
        );
        let times = format!("{done} episodes, {simulated:.0} s simulated in {real:.1} s\n");
        Ok((judgement, times))
    }

    /// All that decides the results.
    fn header(
        &self,
        name: &Path,
        policy: &ActingPolicy,
        robot: &RobotPlugin,
        tasks: &[&JudgedTask],
    ) -> Result<JudgementHeader, Failure> {
        let (about, mapping) = match policy.served() {
            None => {
                let bytes = read_regular_file(name, MOST_BYTES, Symlinks::Followed);
                let bytes = bytes.map_err(|error| Failure::at(name, error))?;
                let fingerprint = Fingerprint::EMPTY.and(&bytes).to_string();
                (json!({ "fingerprint": fingerprint }), None)
            }
            Some(served) => {
                let named = self.policy.mapping().unwrap_or(Path::new("default"));
                let mapping = format!("{:?}", served.mapping());
                let fingerprint = Fingerprint::EMPTY.and(mapping.as_bytes()).to_string();
                let mapping = [named.display().to_string(), fingerprint];
                (json_of(served.metadata()), Some(mapping))
            }
        };
        Ok(JudgementHeader {
            benchmark: BENCHMARK_VERSION.into(),
            program: env!("CARGO_PKG_VERSION").into(),
            robot: layout(robot).name.clone(),
            dynamic: robot.mode == RobotMode::Dynamic,
            policy: name.display().to_string(),
            about,
            mapping,
            tasks: tasks.iter().map(|task| NamedTask::from(*task)).collect(),
        })
    }
}

/// The tasks whose names begin so; all if there are no names.
fn tasks_of(names: &[String]) -> Result<Vec<&'static JudgedTask>, Failure> {
    let is_of = |task: &JudgedTask, name: &String| task.name.starts_with(name.as_str());
    let unknown = names
        .iter()
        .find(|name| !JUDGED_TASKS.iter().any(|task| is_of(task, name)));
    if let Some(name) = unknown {
        let known: BTreeSet<_> = JUDGED_TASKS.iter().map(|task| task.name).collect();
        let known = known.into_iter().collect::<Vec<_>>().join(", ");
        let fault = format!("{name}: no task's name begins so; they are {known}");
        return Err(Failure::input(fault));
    }
    let is_chosen =
        |task: &&JudgedTask| names.is_empty() || names.iter().any(|name| is_of(task, name));
    Ok(JUDGED_TASKS.iter().filter(is_chosen).collect())
}

fn layout(robot: &RobotPlugin) -> &RobotLayout {
    match &robot.description {
        Some(description) => &description.layout,
        None => RobotLayout::baxter(),
    }
}

fn failure(error: JudgementError) -> Failure {
    match error {
        JudgementError::Fault { .. } => Failure::input(error),
        JudgementError::Io { .. } => Failure::run(error),
    }
}

/// What a server says of itself, but the numbers in arrays and bytes.
fn json_of(map: &WireMap) -> Value {
    let value = |value: &WireValue| match value {
        WireValue::Nil => Value::Null,
        WireValue::Boolean(is_so) => json!(is_so),
        WireValue::Integer(number) => json!(number),
        WireValue::Number(number) => json!(number),
        WireValue::Text(text) => json!(text),
        WireValue::Map(map) => json_of(map),
        WireValue::List(list) => {
            let list = (0..).zip(list);
            let map: WireMap = list
                .map(|(number, value): (usize, _)| (number.to_string(), value.clone()))
                .collect();
            json_of(&map)
        }
        WireValue::Bytes(bytes) => json!(Fingerprint::EMPTY.and(bytes).to_string()),
        WireValue::Array(array) => json!(Fingerprint::EMPTY.and(array.bytes()).to_string()),
    };
    let entries = map.iter().map(|(key, it)| (key.clone(), value(it)));
    Value::Object(entries.collect())
}

/// Whoever carries out episodes.
struct PolicyJudge<'a> {
    policy: &'a ActingPolicy,
    body: RobotBody,
    carrier: CameraCarrier,
    robot: RobotPlugin,
    tasks: &'a [&'static JudgedTask],
    collection: Option<&'a Collection>,
}

impl PolicyJudge<'_> {
    /// The episode of a number: one of each task, then another one of each.
    fn episode(&self, number: u64) -> Result<JudgedEpisode, Failure> {
        let count = self.tasks.len() as u64;
        let (task, episode) = (self.tasks[(number % count) as usize], number / count);
        let beginning = task.begin(episode, &self.body, self.carrier);
        let beginning = beginning.map_err(|error| match error {
            BeginningError::NoRoom(..) => Failure::input(error),
            BeginningError::Sentence(..) => Failure::run(error),
        })?;
        // A recording that is whole, and whose episode was not noted any more, stays.
        let is_right = |header: &SessionHeader| {
            header.settings.get("beginning") == Some(&json!(beginning.fingerprint))
        };
        let holds = self.collection.map(|it| it.holds(number, is_right));
        let holds = holds.transpose().map_err(refused)?;
        let recorded = self.collection.filter(|_| holds == Some(false));
        let folder = recorded.map(|collection| collection.part(number));
        let mut app = self.begin(task, episode, &beginning, folder);
        if recorded.is_some() {
            app.world_mut().write_command(RecordingCommand::Start);
        }
        // With and without a recording, as much time passes.
        app.step(1);
        let failure = self.act(&mut app, task, &beginning);
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
        if let Some(lost) = self.policy.served().and_then(|policy| policy.lost()) {
            let task = task.name;
            let fault = format!(
                "{task}, episode {episode}: {lost}; the episodes before it are kept in --json, and the same command goes on"
            );
            return Err(Failure::run(fault));
        }
        if let Some(collection) = recorded {
            collection.keep(number).map_err(refused)?;
        }
        let failure = failure
            .as_ref()
            .map(|failure| (failure.class(), failure.to_string()))
            .or_else(|| (!left.is_empty()).then(|| self.shortfall(task)));
        Ok(JudgedEpisode::new(
            task, episode, &beginning, left, failure, ticks,
        ))
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
    fn begin(
        &self,
        task: &JudgedTask,
        episode: u64,
        beginning: &TaskBeginning,
        folder: Option<PathBuf>,
    ) -> App {
        let plugins = TabletopSimPlugins.build().set(self.robot.clone());
        let plugins = match folder {
            None => plugins.disable::<RecorderPlugin>().add(UnrecordedPlugin),
            Some(folder) => plugins.set(RecorderPlugin {
                folder,
                header: Map::from_iter([
                    ("benchmark".into(), json!(BENCHMARK_VERSION)),
                    ("task".into(), json!(task.name)),
                    ("episode".into(), json!(episode)),
                    ("beginning".into(), json!(beginning.fingerprint)),
                ]),
                ..default()
            }),
        };
        let mut app = headless_app_with(plugins);
        let world = app.world_mut();
        self.policy.resize(&mut world.resource_mut::<HeadCamera>());
        let scene = Box::new(beginning.scene.clone());
        world.write_command(SceneCommand::Set(scene));
        world.write_command(RobotCommand::Show(true));
        app.step(SETTLING);
        app
    }

    /// Lets the policy act until the task is done, it says so, or its time is over.
    fn act(
        &self,
        app: &mut App,
        task: &JudgedTask,
        beginning: &TaskBeginning,
    ) -> Option<PlanFailure> {
        let words = task.sentences.replace('\n', " ");
        let acting = match self.policy {
            ActingPolicy::Motions(policy) => {
                let most = task.seconds * u64::from(TICKS_PER_SECOND);
                let followed = follow_actions(policy, app.world_mut(), &words, most, |now| {
                    beginning.is_done(now)
                });
                return followed.err();
            }
            ActingPolicy::Places(policy) => &**policy,
            ActingPolicy::ServedPlaces(policy) => &**policy,
        };
        let told = ToldTask {
            words: &words,
            objects: beginning.objects(),
        };
        let most = MOVES * beginning.steps;
        let (mut stage, seed) = (AppStage::new(app), beginning.seed);
        let followed = follow_policy(
            acting,
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
