//! `tabletop tell`: a task in words, done by the hand or by the robot.

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
    process::ExitCode,
};

use crate::{
    TabletopSimPlugins, final_state, headless_app_with,
    imitation::scattered,
    planner::RobotBody,
    program::{ProgramRun, SCHEMA, TableScene, TaskProgram},
    recorder::{RecorderPlugin, RecordingReport, UnrecordedPlugin, whole_recording},
    robot::RobotPlugin,
    robot_body, run_episodes,
    scene::{IdAllocator, assemble},
    shipped::{read_faultless_task, read_text},
    storage::{InnerPath, Storage},
    telling::{ProgramActor, Told, carry_out},
};
use bevy::prelude::*;
use clap::Args;
use tabletop_core::{
    RecordingCommand, RobotCommand, SceneCommand, SceneSpec, StepApp as _, WriteCommand as _,
};

use super::{
    Failure, Output,
    allowed_paths::AllowedPaths,
    counted::counted,
    range::{NumberRange, SEEDS},
    recorded::{self, say_moved_aside},
    result_file::{ResultKind, require_outside},
    robot_options::RobotChoice,
    run::DEFAULT_SETUP,
    terminal::{say, show_warnings},
};

const TRIALS: NumberRange<u64> = NumberRange::whole(1, 100_000);

/// Number of ticks after which a scene is at rest.
const SETTLING: u64 = 30;

#[derive(Args)]
pub(super) struct TellArgs {
    /// The sentences (docs/task-programs.md), such as "Put every red block into the blue box."
    #[arg(value_name = "SENTENCES", required_unless_present_any = ["program", "schema"])]
    sentences: Option<String>,
    /// A file with the sentences, or with a program in JSON
    #[arg(long, value_name = "FILE", conflicts_with = "sentences")]
    program: Option<PathBuf>,
    /// Print the sentences as they are understood, and the program in JSON; exit code 2 if they are not
    #[arg(long, conflicts_with_all = ["dry_run", "imitate", "seed", "trials", "record", "final_state"])]
    check: bool,
    /// Print the JSON schema of programs
    #[arg(long, conflicts_with_all = ["sentences", "program", "check", "dry_run", "imitate", "seed", "trials", "record", "final_state"])]
    schema: bool,
    /// The task file [default: tablesetup/default.xml]
    #[arg(long, value_name = "FILE")]
    setup: Option<PathBuf>,
    #[command(flatten)]
    allowed: AllowedPaths,
    /// Only print the steps that the program comes to, if each leads where it should; exit code 1 if it cannot be done
    #[arg(long, conflicts_with_all = ["imitate", "trials", "record", "final_state"])]
    dry_run: bool,
    /// Let the robot do it, not the hand
    #[arg(long)]
    imitate: bool,
    /// Put everything at random places, which this number from 0 to 18446744073709551615 decides; the robot reaches them
    #[arg(long, value_name = "N", value_parser = SEEDS, allow_negative_numbers = true)]
    seed: Option<u64>,
    /// Do this many trials, from 1 to 100000, with random places by the seeds from `--seed` (or 0) on, and print their results
    #[arg(long, value_name = "N", value_parser = TRIALS, allow_negative_numbers = true, conflicts_with = "final_state")]
    trials: Option<u64>,
    #[command(flatten)]
    robot: RobotChoice,
    /// Record it; several trials get a folder each below this one
    #[arg(long, value_name = "DIR")]
    record: Option<PathBuf>,
    /// Write the final pose of every object as CSV (`id,x,y,z,rx,ry,rz`); `-` for standard output
    #[arg(long, value_name = "FILE|-")]
    final_state: Option<Output>,
}

/// Does what sentences say, once or several times. Exit code 1 if it has failed.
pub(super) fn tell(args: &TellArgs) -> Result<ExitCode, Failure> {
    show_warnings();
    if args.schema {
        Output::Stdout.write(SCHEMA.as_bytes())?;
        return Ok(ExitCode::SUCCESS);
    }
    let program = args.read_program()?;
    if args.check {
        Output::tell(&format!("{program}\n"))?;
        Output::Stdout.write(format!("{}\n", program.to_json()).as_bytes())?;
        return Ok(ExitCode::SUCCESS);
    }
    let setup = args.setup.as_deref().unwrap_or(Path::new(DEFAULT_SETUP));
    let scene = read_faultless_task(setup, &args.allowed.folders).map_err(Failure::input)?;
    if args.dry_run {
        return rehearse(&program, &args.scene(scene)?);
    }
    args.check_outputs()?;
    let robot = args.robot.plugin()?;
    let body = match args.imitate {
        true => Some(robot_body(&robot, &scene.table).map_err(Failure::run)?),
        false => None,
    };
    let attempt = |number: u64| {
        let seed = match args.trials {
            None => args.seed,
            Some(_) => Some(args.seed.unwrap_or(0).wrapping_add(number)),
        };
        let folder = args
            .record
            .as_ref()
            .map(|folder| match (seed, args.trials) {
                (Some(seed), Some(_)) => InnerPath::numbered("", seed, "").below(folder),
                (Some(_) | None, Some(_) | None) => folder.clone(),
            });
        let attempt = Telling {
            program: &program,
            scene: &scene,
            robot: &robot,
            body: body.as_ref(),
            seed,
            is_reported: args.trials.is_none(),
            final_state: args.final_state.as_ref(),
        };
        attempt.make_whole(folder.as_deref())
    };
    let mut trials = Vec::new();
    run_episodes(
        0..args.trials.unwrap_or(1),
        1,
        attempt,
        |_, trial: ToldTrial| {
            if args.trials.is_some()
                && let Some(failure) = trial.told.as_ref().and_then(|told| told.failure.as_ref())
            {
                let seed = trial.seed.unwrap_or(0);
                say(format_args!("tabletop: seed {seed}: {failure}"));
            }
            trials.push(trial);
            Ok(())
        },
    )?;
    let is_done = |trial: &ToldTrial| {
        trial
            .told
            .as_ref()
            .is_some_and(|told| told.failure.is_none())
    };
    let text = match (&trials[..], args.trials) {
        ([trial], None) => single(trial),
        _ => table(&trials),
    };
    match args.final_state {
        Some(Output::Stdout) => say(text.trim_end()),
        Some(Output::File(_)) | None => Output::tell(&text)?,
    }
    trials
        .iter()
        .for_each(|trial| say_moved_aside(&trial.report.moved_aside));
    Ok(ExitCode::from(u8::from(!trials.iter().all(is_done))))
}

impl TellArgs {
    fn read_program(&self) -> Result<TaskProgram, Failure> {
        match (&self.program, &self.sentences) {
            (Some(file), _) => {
                let text = read_text(file)
                    .map_err(|error| Failure::input(format!("{}: {error}", file.display())))?;
                let read = TaskProgram::read(&text);
                read.map_err(|fault| Failure::input(format!("{}: {fault}", file.display())))
            }
            (None, sentences) => {
                let text = sentences.as_deref().unwrap_or_default();
                TaskProgram::read(text).map_err(Failure::input)
            }
        }
    }

    /// The scene with its objects where they were asked for.
    fn scene(&self, scene: SceneSpec) -> Result<SceneSpec, Failure> {
        let Some(seed) = self.seed else {
            return Ok(scene);
        };
        let moved = scattered(&scene, &[], None, seed);
        moved.ok_or_else(|| Failure::run("there is no room for everything"))
    }

    fn check_outputs(&self) -> Result<(), Failure> {
        if let Some(folder) = &self.record {
            require_outside(folder, &[])?;
        }
        let Some(output) = &self.final_state else {
            return Ok(());
        };
        output.check(ResultKind::Table)?;
        if let (Output::File(path), Some(folder)) = (output, &self.record) {
            require_outside(path, &[folder])?;
        }
        Ok(())
    }
}

/// Prints the steps of a program on the table of a scene.
fn rehearse(program: &TaskProgram, scene: &SceneSpec) -> Result<ExitCode, Failure> {
    let assembly = assemble(scene, &mut IdAllocator::default());
    let mut table = TableScene {
        table: scene.table,
        objects: assembly.objects,
        joints: assembly.joints,
    };
    let (steps, _, impossible) = ProgramRun::rehearsed(program, &table);
    let mut text = String::new();
    for (i, step) in steps.iter().enumerate() {
        text += &format!("{}. {}\n", i + 1, step.sentence(&table));
        table = table.after(step);
    }
    if steps.is_empty() && impossible.is_none() {
        text += "There is nothing to do.\n";
    }
    Output::tell(&text)?;
    impossible.map_or(Ok(ExitCode::SUCCESS), |reason| Err(Failure::run(reason)))
}

struct Telling<'a> {
    program: &'a TaskProgram,
    scene: &'a SceneSpec,
    robot: &'a RobotPlugin,
    /// The robot's body, if the robot does it.
    body: Option<&'a RobotBody>,
    seed: Option<u64>,
    is_reported: bool,
    final_state: Option<&'a Output>,
}

/// The result of a trial.
struct ToldTrial {
    seed: Option<u64>,
    /// `None` if there was no room for everything.
    told: Option<Told>,
    report: RecordingReport,
}

impl Telling<'_> {
    /// Makes it. Its recording appears whole.
    fn make_whole(&self, folder: Option<&Path>) -> Result<ToldTrial, Failure> {
        let Some(folder) = folder else {
            return self.make(None);
        };
        let make = |draft: &Path| self.make(Some(draft));
        let (mut trial, moved_aside) = whole_recording(folder, &Storage::default(), make)?;
        trial.report.moved_aside.extend(moved_aside);
        Ok(trial)
    }

    fn make(&self, folder: Option<&Path>) -> Result<ToldTrial, Failure> {
        let scene = match self.seed {
            Some(seed) => scattered(self.scene, &[], self.body, seed),
            None => Some(self.scene.clone()),
        };
        let Some(scene) = scene else {
            return Ok(ToldTrial {
                seed: self.seed,
                told: None,
                report: RecordingReport::default(),
            });
        };
        let objects = assemble(&scene, &mut IdAllocator::default()).objects;
        let plugins = TabletopSimPlugins.build().set(self.robot.clone());
        let plugins = match folder {
            Some(folder) => plugins.set(RecorderPlugin {
                folder: folder.to_owned(),
                ..default()
            }),
            None => plugins.disable::<RecorderPlugin>().add(UnrecordedPlugin),
        };
        let mut app = headless_app_with(plugins);
        let world = app.world_mut();
        world.write_command(SceneCommand::Set(Box::new(scene)));
        if self.body.is_some() {
            world.write_command(RobotCommand::Show(true));
        }
        app.step(SETTLING);
        if folder.is_some() {
            app.world_mut().write_command(RecordingCommand::Start);
            app.step(1);
        }
        let performer = match self.body {
            Some(body) => ProgramActor::Robot {
                body,
                seed: self.seed.unwrap_or(0),
            },
            None => ProgramActor::Hand,
        };
        let told = carry_out(
            &mut app,
            self.program,
            &objects,
            performer,
            |number, sentence| {
                if self.is_reported {
                    say(format_args!("{number}. {sentence}"));
                }
            },
        );
        app.step(SETTLING);
        let report = recorded::finish(&mut app)?;
        if let Some(output) = self.final_state {
            let mut csv = Vec::new();
            final_state::write_state(app.world(), &mut csv).map_err(Failure::run)?;
            output.write(&csv)?;
        }
        Ok(ToldTrial {
            seed: self.seed,
            told: Some(told),
            report,
        })
    }
}

fn single(trial: &ToldTrial) -> String {
    let Some(told) = &trial.told else {
        return "There is no room for everything.\n".into();
    };
    let (steps, corrections) = (counted(told.steps.len(), "step"), told.corrections);
    match &told.failure {
        None => format!("Done: {steps}, {}.\n", counted(corrections, "correction")),
        Some(failure) => format!("Failed after {steps}: {failure}\n"),
    }
}

/// The results of several trials.
fn table(trials: &[ToldTrial]) -> String {
    let tried: Vec<_> = trials
        .iter()
        .filter_map(|trial| Some((trial, trial.told.as_ref()?)))
        .collect();
    let mut failures = BTreeMap::<&str, Vec<String>>::new();
    for (trial, told) in &tried {
        if let Some(failure) = &told.failure {
            let seed = trial.seed.unwrap_or(0).to_string();
            failures.entry(failure.class()).or_default().push(seed);
        }
    }
    let failed: usize = failures.values().map(Vec::len).sum();
    let mut lines = vec![format!(
        "{:<14}{:>5} of {}",
        "done",
        tried.len() - failed,
        tried.len()
    )];
    for (class, seeds) in failures {
        lines.push(format!(
            "{class:<14}{:>5}  seeds {}",
            seeds.len(),
            seeds.join(", ")
        ));
    }
    let without_room = trials.len() - tried.len();
    if without_room > 0 {
        lines.push(format!("{:<14}{without_room:>5}  not tried", "no room"));
    }
    lines.join("\n") + "\n"
}
