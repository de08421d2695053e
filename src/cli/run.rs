//! `tabletop run`: the simulation without a window.

use std::{
    collections::BTreeSet,
    path::{Path, PathBuf},
    process::ExitCode,
    time::Instant,
};

use crate::{
    TabletopSimPlugins,
    assembly::{IdAllocator, assemble},
    core::{
        RecordingCommand, RestingSystems, RobotFact, SceneCommand, SceneSpec, SimFact, SimTick,
        StepApp as _, TICKS_PER_SECOND, Table, WriteCommand as _, seen_from,
    },
    final_state, headless_app_with,
    script::shut_down,
    shipped::{task_reader, true_path},
    shown_task::shown_task,
    task::Furniture,
    task_files::save_task,
};
use bevy::prelude::*;
use tabletop_scenario::{Outcome, Scenario, ScenarioRun, Step};

use super::{
    Failure, Output, WRONG_INPUT,
    duration::{pass, ticks},
    explain::read,
    real,
    recorded::{self, say_moved_aside},
    run_arguments::RunArgs,
    script::Script,
    seeds,
    terminal::{say, show_warnings},
};

/// The task file that is loaded unless one is named.
pub(super) const DEFAULT_SETUP: &str = "tablesetup/default.xml";

pub(super) fn run(args: &RunArgs) -> Result<ExitCode, Failure> {
    show_warnings();
    args.check_ends()?;
    let seconds = args.seconds;
    match &args.scenario {
        Some(scenario) if let Some(seeds) = &args.seeds => {
            seeds::perform(scenario, seeds.clone(), args)
        }
        Some(scenario) => perform(scenario, args),
        None => {
            let setup = args.setup.as_deref();
            let setup = setup.unwrap_or(Path::new(DEFAULT_SETUP));
            let robot = args.robot.plugin()?;
            let hand_pictures = args.hand_cameras.of(&robot)?;
            let (scene, result) = scene_of(setup, &args.allowed.folders)?;
            let plugins = args.plugins(
                robot.clone(),
                args.record.as_deref(),
                args.seed,
                hand_pictures,
            )?;
            let mut app = headless_app_with(plugins);
            args.real.attach(&mut app, &robot, &scene.table)?;
            if args.record.is_some() {
                app.world_mut().write_command(RecordingCommand::Start);
            }
            app.add_systems(FixedLast, report_stops_of_the_robot.in_set(RestingSystems));
            args.tell_task(&mut app, Some(&scene))?;
            put_on_table(scene, &mut app);
            args.robot.show(&mut app);
            let start = Instant::now();
            let script = Script::start(&mut app, args.script.is_some());
            let script = script.run(&mut app, ticks(seconds.unwrap_or(10.0)));
            real::release(&mut app);
            let ends = args.write_ends(&app);
            let recorded = recorded::finish(&mut app);
            args.sum_up(&true_path(setup), "", &app, start);
            say_moved_aside(&recorded.as_ref().cloned().unwrap_or_default());
            Failure::of_all([script, recorded.map(drop), ends])?;
            Ok(result)
        }
    }
}

/// Simulates a task file for this many seconds, and writes the final poses of all objects. Its faults are reported and do
/// not stop the run, but give exit code 2.
pub(super) fn simulate(
    setup: &Path,
    allowed: &[PathBuf],
    seconds: f64,
    final_state: &Output,
) -> Result<ExitCode, Failure> {
    let (scene, result) = scene_of(setup, allowed)?;
    let mut app = headless_app_with(TabletopSimPlugins);
    put_on_table(scene, &mut app);
    pass(&mut app, ticks(seconds));
    write_final_state(&app, final_state)?;
    Ok(result)
}

/// The scene of a task file, and the exit code for its faults, which are reported.
fn scene_of(setup: &Path, allowed: &[PathBuf]) -> Result<(SceneSpec, ExitCode), Failure> {
    let reader = task_reader().allowing(allowed);
    let task = reader.read(setup).map_err(Failure::input)?;
    for fault in &task.faults {
        say(fault);
    }
    let result = match task.faults.is_empty() {
        true => ExitCode::SUCCESS,
        false => ExitCode::from(WRONG_INPUT),
    };
    Ok((task.scene, result))
}

/// Puts a scene on the table in the first tick.
fn put_on_table(scene: SceneSpec, app: &mut App) {
    app.world_mut()
        .write_command(SceneCommand::Set(Box::new(scene)));
}

/// Performs a scenario until it is done or has failed.
fn perform(scenario: &Path, args: &RunArgs) -> Result<ExitCode, Failure> {
    let (scenario, robot) = args.prepare(scenario)?;
    let program = args.program(&scenario, args.seed).map_err(Failure::input)?;
    let hand_pictures = args.hand_cameras.of(&robot)?;
    let plugins = args.plugins(
        robot.clone(),
        args.record.as_deref(),
        args.seed,
        hand_pictures,
    )?;
    let mut app = headless_app_with(plugins);
    if args.real.address().is_some() {
        let table = table_of(&scenario, args)?;
        args.real.attach(&mut app, &robot, &table)?;
    }
    let (limit, only_prepares) = (program.limit, program.only_prepares());
    app.insert_resource(ScenarioRun::new(program))
        .add_systems(FixedLast, report_stops_of_the_robot.in_set(RestingSystems));
    args.robot.show(&mut app);
    args.tell_task(&mut app, None)?;
    let start = Instant::now();
    let mut script = Script::start(&mut app, args.script.is_some());
    let mut ticks_taken = 0;
    let mut said = String::new();
    let outcome = loop {
        app.step(1);
        ticks_taken += 1;
        if let Err(unheard) = script.listen(&app) {
            break Err(unheard);
        }
        match app.world().resource::<ScenarioRun>().outcome() {
            Outcome::Running => {}
            Outcome::Done => break Ok(()),
            Outcome::Failed(error) => {
                said = error.to_string();
                say(format_args!("tabletop: {said}"));
                break Err(Failure::silent());
            }
        }
    };
    let outcome = outcome.and_then(|()| {
        if only_prepares {
            script.run_for(&mut app, limit.saturating_sub(ticks_taken))?;
        }
        if script.is_running() {
            say("tabletop: the script was still running when the scenario ended; a Wait at its end gives it more time");
        }
        Ok(())
    });
    shut_down(app.world_mut());
    real::release(&mut app);
    let ends = args.write_ends(&app);
    let recorded = recorded::finish(&mut app).map_err(|failure| failure.unless_said(&said));
    let run = app.world().resource::<ScenarioRun>();
    let done = run.steps_done() - usize::from(scenario.setup.is_some()).min(run.steps_done());
    let done = match scenario.steps.len() {
        all if done == all => counted(all, "step"),
        all => format!("{done} of {}", counted(all, "step")),
    };
    let checks = counted(run.checks_passed(), "check");
    let done = format!("{done} done, {checks} passed; ");
    args.sum_up(&scenario.path, &done, &app, start);
    let report = recorded.as_ref().cloned().unwrap_or_default();
    if args.record.is_some() && outcome.is_ok() && recorded.is_ok() && report.started == 0 {
        say("tabletop: nothing was recorded: the scenario has no Start");
    }
    say_moved_aside(&report);
    Failure::of_all([outcome, recorded.map(drop), ends, script.result()])?;
    Ok(ExitCode::SUCCESS)
}

/// The table with which a scenario begins.
fn table_of(scenario: &Scenario, args: &RunArgs) -> Result<Table, Failure> {
    let setup = scenario.setup.as_ref().map(|setup| &setup.step);
    let Some(Step::Load { file, .. }) = setup else {
        return Ok(Table::default());
    };
    let folder = scenario.path.parent().unwrap_or(Path::new(""));
    let scene = args.read_faultless(&seen_from(folder, file));
    Ok(scene.map_err(Failure::input)?.table)
}

/// Reports every obstacle of an arm, and every object that cannot be gripped, once.
fn report_stops_of_the_robot(
    mut facts: MessageReader<SimFact>,
    mut reported: Local<BTreeSet<String>>,
) {
    let events = facts.read().filter(|fact| stops_the_robot(fact));
    for event in events.filter_map(SimFact::robot_event) {
        if reported.insert(event.clone()) {
            say(format_args!("tabletop: {event}"));
        }
    }
}

fn stops_the_robot(fact: &SimFact) -> bool {
    match fact {
        SimFact::Robot(RobotFact::ArmBlocked { .. } | RobotFact::GripRefused { .. }) => true,
        SimFact::Scene(_)
        | SimFact::History(_)
        | SimFact::Mechanism(_)
        | SimFact::Hand(_)
        | SimFact::Recording(_)
        | SimFact::Robot(
            RobotFact::Shown { .. } | RobotFact::GripMade { .. } | RobotFact::GripReleased { .. },
        )
        | SimFact::Refused { .. } => false,
    }
}

impl RunArgs {
    /// Gives scripts the task of a recording, with the objects of a scene if there is one.
    fn tell_task(&self, app: &mut App, scene: Option<&SceneSpec>) -> Result<(), Failure> {
        let Some(recording) = &self.task else {
            return Ok(());
        };
        let (task, requirements) = read(recording, &Furniture::default())?;
        let binding = match scene {
            Some(scene) => {
                let objects = assemble(scene, &mut IdAllocator::default()).objects;
                Some(task.bind(&requirements, &objects).map_err(Failure::run)?)
            }
            None => None,
        };
        let shown = shown_task(recording, &task, &requirements, binding.as_ref());
        app.insert_resource(shown);
        Ok(())
    }

    /// Checks that the results of the end of a run can be written.
    fn check_ends(&self) -> Result<(), Failure> {
        if let Some(path) = self.save.as_deref().filter(|path| path.exists()) {
            let path = path.display();
            let reason = format!("{path}: it exists, and --save replaces nothing; name a new file");
            return Err(Failure::input(reason));
        }
        let mut outputs = self.final_state.iter().chain(&self.final_robot);
        outputs.try_for_each(Output::check)
    }

    /// Sums up the run: its work, its duration, and its file.
    fn sum_up(&self, file: &Path, done: &str, app: &App, start: Instant) {
        if self.quiet {
            return;
        }
        let file = file.display();
        let ticks = app.world().resource::<SimTick>().0;
        let simulated = ticks as f64 / f64::from(TICKS_PER_SECOND);
        let real = start.elapsed().as_secs_f64();
        say(format_args!(
            "tabletop: {file}: {done}{simulated:.2} s simulated in {real:.2} s"
        ));
    }

    /// Writes the results of the end of a run.
    fn write_ends(&self, app: &App) -> Result<(), Failure> {
        let state = self.final_state.as_ref();
        let robot = self.final_robot.as_ref();
        let save_to = self.save.as_deref();
        Failure::of_all([
            state.map_or(Ok(()), |output| write_final_state(app, output)),
            robot.map_or(Ok(()), |output| write_final_robot(app, output)),
            save_to.map_or(Ok(()), |path| save(app, path)),
        ])
    }
}

/// Saves the final state as a task file, and reports the parts that a task file cannot express.
fn save(app: &App, path: &Path) -> Result<(), Failure> {
    let name = path.display();
    let unsaid = save_task(app.world(), path)
        .map_err(|error| Failure::run(format!("{name}: it cannot be saved: {error}")))?;
    for unsaid in unsaid {
        say(format_args!("tabletop: {name}: {unsaid}"));
    }
    Ok(())
}

/// A number of things, in words.
fn counted(count: usize, of_what: &str) -> String {
    match count {
        1 => format!("1 {of_what}"),
        count => format!("{count} {of_what}s"),
    }
}

fn write_final_robot(app: &App, output: &Output) -> Result<(), Failure> {
    let mut json = Vec::new();
    final_state::write_robot(app.world(), &mut json).map_err(Failure::run)?;
    output.write(&json)
}

fn write_final_state(app: &App, output: &Output) -> Result<(), Failure> {
    let mut csv = Vec::new();
    final_state::write_state(app.world(), &mut csv).map_err(Failure::run)?;
    output.write(&csv)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use crate::{core::ObjectIndex, storage::TemporaryFolder};

    use super::*;

    #[test]
    fn a_task_file_is_read_once_before_the_first_tick() {
        let folder = TemporaryFolder::new("tabletop-run-once").unwrap();
        let setup = folder.path().join("setup.xml");
        let text = crate::shipped::read_text(Path::new(DEFAULT_SETUP)).unwrap();
        fs::write(&setup, text).unwrap();
        let (scene, _) = scene_of(&setup, &[]).map_err(|_| "it has faults").unwrap();
        fs::remove_file(&setup).unwrap();
        let mut app = headless_app_with(TabletopSimPlugins);
        put_on_table(scene, &mut app);
        app.step(1);
        assert_eq!(app.world().resource::<ObjectIndex>().iter().count(), 2);
    }
}
