//! `tabletop imitate`: the robot imitates a recording.

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
    process::ExitCode,
    time::{Duration, Instant},
};

use crate::{
    TabletopSimPlugins, headless_app_with,
    planner::{Execution, Imitation},
    policy::{ActingPolicy, Attempt, AttemptProgress},
    real::{RealRobotPlugin, execute},
    recorder::{
        HandPictures, RecorderPlugin, RecordingReader, RecordingReport, UnrecordedPlugin,
        read_original, whole_recording,
    },
    robot_body, run_episodes,
    scene::{IdAllocator, assemble},
    scene_at_beginning,
    shipped::read_faultless_task,
    storage::{InnerPath, Storage},
    task::{Binding, Task},
};
use bevy::prelude::*;
use clap::Args;
use tabletop_controller::RobotController;
use tabletop_core::{
    HeadCamera, RecordingCommand, RobotCommand, SceneCommand, SceneSpec, SimTick, StepApp as _,
    TICKS_PER_SECOND, WriteCommand as _,
};

use super::{
    Failure, Output,
    acting_policy::PolicyOptions,
    allowed_paths::AllowedPaths,
    counted::counted,
    explain::{furniture, read},
    hand_cameras::HandCameraOption,
    range::{NumberRange, SEEDS},
    real::{self, DrivenOptions},
    recorded::{self, say_moved_aside},
    result_file::require_outside,
    robot_options::RobotChoice,
    shard::ShardOption,
    terminal::{say, show_warnings},
    watch::read_watched,
};

const TRIALS: NumberRange<u64> = NumberRange::whole(1, 100_000);

#[derive(Args)]
#[command(mut_group("HandCameraOption", |options| options.requires("record")))]
#[command(mut_group("ShardOption", |options| options.requires("trials")))]
#[command(mut_arg("real", |real| real.requires("setup").conflicts_with_all(["trials", "seed", "exchange_colors", "eyes", "policy", "dynamic", "hand_cameras"])))]
pub(super) struct ImitateArgs {
    /// The recording's folder
    #[arg(value_name = "DIR")]
    recording: PathBuf,
    /// The task file to do it with [default: the scene of the recording]
    #[arg(long, value_name = "FILE")]
    setup: Option<PathBuf>,
    #[command(flatten)]
    allowed: AllowedPaths,
    /// Put everything at random places within reach, which this number from 0 to 18446744073709551615 decides
    #[arg(long, value_name = "N", value_parser = SEEDS, allow_negative_numbers = true)]
    seed: Option<u64>,
    /// Do this many trials, from 1 to 100000, with random places by the seeds from `--seed` (or 0) on, and print their results
    #[arg(long, value_name = "N", value_parser = TRIALS, allow_negative_numbers = true)]
    trials: Option<u64>,
    #[command(flatten)]
    shard: ShardOption,
    /// Exchange the colours of objects, as the seed decides
    #[arg(long)]
    exchange_colors: bool,
    /// Let the robot see for itself: it is told shapes and colours, and finds the poses in the pictures of its head camera
    #[arg(long)]
    eyes: bool,
    /// Learn the task from the recording's pictures alone, too
    #[arg(long, requires = "eyes")]
    watch: bool,
    #[command(flatten)]
    policy: PolicyOptions,
    #[command(flatten)]
    robot: RobotChoice,
    #[command(flatten)]
    real: DrivenOptions,
    /// Record the robot; several trials get a folder each below this one
    #[arg(long, value_name = "DIR")]
    record: Option<PathBuf>,
    #[command(flatten)]
    hand_cameras: HandCameraOption,
}

/// The result of a trial.
struct Trial {
    seed: Option<u64>,
    /// `None` if there was no room for everything.
    imitation: Option<Imitation>,
    report: RecordingReport,
    simulated: f64,
    real: f64,
}

/// Lets the robot do the task, once or several times. Exit code 1 if it has failed, or could not be tried for lack of room.
pub(super) fn run(args: &ImitateArgs) -> Result<ExitCode, Failure> {
    show_warnings();
    if let Some(folder) = &args.record {
        require_outside(folder, &[&args.recording])?;
    }
    let scene = match &args.setup {
        Some(setup) => read_faultless_task(setup, &args.allowed.folders).map_err(Failure::input)?,
        None => scene_of(&args.recording)?,
    };
    let (task, requirements) = match args.watch {
        true => read_watched(&args.recording)?,
        false => read(&args.recording, &furniture(&scene))?,
    };
    if task.steps.is_empty() {
        let reason = "the recording moves nothing for good, so there is nothing to imitate";
        return Err(Failure::input(reason));
    }
    let robot = args.real.body(args.robot.plugin()?)?;
    let policy = args.policy.read(&robot)?;
    if let (Some(ActingPolicy::Motions(_)), true) = (&policy, args.eyes) {
        let reason =
            "--eyes finds what is to be grasped, and the actions of this policy move joints";
        return Err(Failure::input(reason));
    }
    let hand_pictures = args.hand_cameras.of(&robot)?;
    let body = robot_body(&robot, &scene.table).map_err(Failure::run)?;
    let first = args.seed.unwrap_or(0);
    let is_single = args.trials.is_none();
    let attempt = |number: u64| {
        let seed = match is_single {
            true => args.seed,
            false => Some(first.wrapping_add(number)),
        };
        let folder = args.record.as_ref().map(|folder| match (seed, is_single) {
            (Some(seed), false) => InnerPath::numbered("", seed, "").below(folder),
            _ => folder.clone(),
        });
        let recorded = RecordedAttempt {
            attempt: Attempt {
                task: &task,
                requirements: &requirements,
                scene: &scene,
                robot: &robot,
                body: &body,
                exchanges_colors: args.exchange_colors,
                has_eyes: args.eyes,
                policy: policy.as_ref(),
                thinking: args.policy.thinking(),
                seed,
            },
            hand_pictures: &hand_pictures,
            real: &args.real,
            folder,
        };
        recorded.make_whole(is_single)
    };
    let mut trials = Vec::new();
    run_episodes(
        args.shard.share_of(0..args.trials.unwrap_or(1)),
        1,
        attempt,
        |_, trial: Trial| {
            if let (false, Some((step, failure))) = (
                is_single,
                trial.imitation.as_ref().and_then(|it| it.failure.as_ref()),
            ) {
                let seed = trial.seed.unwrap_or(0);
                say(format_args!(
                    "tabletop: seed {seed}: step {step}: {failure}"
                ));
            }
            trials.push(trial);
            Ok(())
        },
    )?;
    let is_done = trials.iter().all(|trial| {
        let imitation = trial.imitation.as_ref();
        imitation.is_some_and(|it| it.failure.is_none())
    });
    let text = match (&trials[..], is_single) {
        ([trial], true) => single(&task, trial),
        _ => table(&trials),
    };
    Output::tell(&text)?;
    trials
        .iter()
        .for_each(|trial| say_moved_aside(&trial.report.moved_aside));
    Ok(ExitCode::from(u8::from(!is_done)))
}

/// The scene with which a recording begins.
fn scene_of(recording: &Path) -> Result<SceneSpec, Failure> {
    let unknown = || {
        Failure::input(
            "the recording does not say which scene it began with; name one with --setup",
        )
    };
    let original = read_original(recording).map_err(Failure::input)?;
    if original.is_some() {
        return Err(unknown());
    }
    let recording = RecordingReader::open(recording).map_err(Failure::input)?;
    scene_at_beginning(recording.session()).ok_or_else(unknown)
}

/// An attempt, and what becomes of it.
struct RecordedAttempt<'a> {
    attempt: Attempt<'a>,
    hand_pictures: &'a HandPictures,
    real: &'a DrivenOptions,
    folder: Option<PathBuf>,
}

impl RecordedAttempt<'_> {
    /// Makes it. Its recording appears whole; that of a real robot from its beginning, so that a kill costs nothing of it.
    fn make_whole(&self, is_reported: bool) -> Result<Trial, Failure> {
        let Some(folder) = self
            .folder
            .as_deref()
            .filter(|_| self.real.address().is_none())
        else {
            return self.make(self.folder.as_deref(), is_reported);
        };
        let make = |draft: &Path| self.make(Some(draft), is_reported);
        let (mut trial, moved_aside) = whole_recording(folder, &Storage::default(), make)?;
        trial.report.moved_aside.extend(moved_aside);
        Ok(trial)
    }

    fn make(&self, folder: Option<&Path>, is_reported: bool) -> Result<Trial, Failure> {
        let start = Instant::now();
        let attempt = &self.attempt;
        let Some(scene) = attempt.beginning() else {
            return Ok(Trial {
                seed: attempt.seed,
                imitation: None,
                report: RecordingReport::default(),
                simulated: 0.0,
                real: 0.0,
            });
        };
        let objects = assemble(&scene, &mut IdAllocator::default()).objects;
        let binding = attempt
            .task
            .bind(attempt.requirements, &objects)
            .map_err(Failure::run)?;
        let plugins = TabletopSimPlugins.build().set(attempt.robot.clone());
        let plugins = match folder {
            Some(folder) => plugins.set(RecorderPlugin {
                folder: folder.to_owned(),
                header: self.real.header(),
                hand_pictures: self.hand_pictures.clone(),
                ..default()
            }),
            None => plugins.disable::<RecorderPlugin>().add(UnrecordedPlugin),
        };
        let real = self.real.connect(attempt.robot, &scene.table)?;
        let is_real = real.is_some();
        let mut app = headless_app_with(match is_real {
            true => plugins.add(RealRobotPlugin { is_paced: true }),
            false => plugins,
        });
        if let Some(real) = real {
            real::stand_in(&mut app, real);
        }
        if let Some(policy) = attempt.policy {
            policy.resize(&mut app.world_mut().resource_mut::<HeadCamera>());
        }
        app.world_mut()
            .write_command(SceneCommand::Set(Box::new(scene)));
        app.world_mut().write_command(RobotCommand::Show(true));
        app.step(30);
        if folder.is_some() {
            app.world_mut().write_command(RecordingCommand::Start);
            app.step(1);
        }
        let imitation = match is_real {
            true => self.imitate_for_real(&mut app, &binding),
            false => {
                let mut tell = |progress: AttemptProgress<'_>| {
                    if is_reported {
                        tell(attempt.task, progress);
                    }
                };
                Ok(attempt.perform(&mut app, &binding, &objects, &mut tell))
            }
        };
        let recorded = recorded::finish(&mut app);
        real::release(&mut app);
        let (imitation, report) = (imitation?, recorded?);
        let ticks = app.world().resource::<SimTick>().0;
        Ok(Trial {
            seed: attempt.seed,
            imitation: Some(imitation),
            report,
            simulated: ticks as f64 / f64::from(TICKS_PER_SECOND),
            real: start.elapsed().as_secs_f64(),
        })
    }

    /// Lets the real robot do it at the pace of the wall clock. The simulated objects go with what the simulated grippers hold.
    fn imitate_for_real(&self, app: &mut App, binding: &Binding) -> Result<Imitation, Failure> {
        let Attempt { task, body, .. } = self.attempt;
        let (all, bound) = (task.clone(), binding.clone());
        let begun = execute(app.world_mut(), body.clone(), all, bound, 0, Duration::ZERO);
        begun.map_err(|error| Failure::run(format!("planner: {error}")))?;
        let mut told = None;
        loop {
            app.step(1);
            real::check(app)?;
            let controller = app.world().resource::<RobotController>();
            let Some(execution) = controller.get::<Execution>() else {
                return Err(Failure::run("the planner was stopped"));
            };
            let doing = execution.doing().filter(|doing| Some(*doing) != told);
            if let Some(doing) = doing {
                tell(task, AttemptProgress::Step(doing));
                told = Some(doing);
            }
            if let Some(imitation) = execution.result() {
                return Ok(imitation.clone());
            }
        }
    }
}

/// Says what is being done.
fn tell(task: &Task, progress: AttemptProgress<'_>) {
    match progress {
        AttemptProgress::Step(doing) => {
            let again = if doing.tries > 0 { " (again)" } else { "" };
            let step = task.step(doing.step);
            let sentence = step.map_or("", |step| step.sentence.as_str());
            say(format_args!("{}. {sentence}{again}", doing.step));
        }
        AttemptProgress::Move(number, object, to) => {
            let [x, y, z] = to.to_array();
            say(format_args!(
                "{number}. Put {object} at ({x:.2}, {y:.2}, {z:.2})."
            ));
        }
    }
}

fn single(task: &Task, trial: &Trial) -> String {
    let Some(imitation) = &trial.imitation else {
        return "There is no room for everything within the robot's reach.\n".into();
    };
    let times = format!("{:.1} s simulated in {:.2} s", trial.simulated, trial.real);
    match &imitation.failure {
        None => format!(
            "Done: {}, {}; {times}.\n",
            counted(imitation.steps_done, "step"),
            counted(imitation.corrections, "correction")
        ),
        Some((step, failure)) => {
            let sentence = task.step(*step).map_or("", |step| step.sentence.as_str());
            format!("Step {step} failed ({sentence}): {failure}; {times}.\n")
        }
    }
}

/// The results of several trials.
fn table(trials: &[Trial]) -> String {
    let made: Vec<_> = trials
        .iter()
        .filter_map(|trial| Some((trial, trial.imitation.as_ref()?)))
        .collect();
    let mut failures = BTreeMap::<&str, Vec<String>>::new();
    for (trial, imitation) in &made {
        if let Some((_, failure)) = &imitation.failure {
            let seed = trial.seed.unwrap_or(0).to_string();
            failures.entry(failure.class()).or_default().push(seed);
        }
    }
    let failed: usize = failures.values().map(Vec::len).sum();
    let corrected = made
        .iter()
        .filter(|(_, imitation)| imitation.corrections > 0)
        .count();
    let mean = |time: fn(&Trial) -> f64| {
        made.iter().map(|(trial, _)| time(trial)).sum::<f64>() / made.len() as f64
    };
    let mut lines = vec![
        format!("{:<14}{:>5} of {}", "done", made.len() - failed, made.len()),
        format!("{:<14}{corrected:>5}", "corrected"),
    ];
    for (class, seeds) in failures {
        lines.push(format!(
            "{class:<14}{:>5}  seeds {}",
            seeds.len(),
            seeds.join(", ")
        ));
    }
    let without_room = trials.len() - made.len();
    if without_room > 0 {
        lines.push(format!("{:<14}{without_room:>5}  not tried", "no room"));
    }
    if !made.is_empty() {
        lines.push(format!(
            "{:.1} s simulated and {:.2} s real on average",
            mean(|trial| trial.simulated),
            mean(|trial| trial.real)
        ));
    }
    lines.join("\n") + "\n"
}
