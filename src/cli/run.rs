//! `tabletop run`: the simulation without a window.

use std::{collections::BTreeSet, path::Path, process::ExitCode, time::Instant};

use crate::{
    TabletopSimPlugins,
    core::{
        RecordingCommand, RestingSystems, RobotFact, SceneCommand, SceneSpec, SimFact, SimTick,
        StepApp as _, TICKS_PER_SECOND, Table, WriteCommand as _, seen_from,
    },
    final_state, headless_app_with,
    recorder::RecordingReport,
    scene::{IdAllocator, assemble},
    script::shut_down,
    shipped::true_path,
    shown_task::shown_task,
    storage::is_taken,
    task::Furniture,
    task_files::save_new_task,
};
use bevy::prelude::*;
use tabletop_scenario::{Outcome, Scenario, ScenarioRun, Step};

use super::{
    Failure, Output,
    counted::counted,
    duration::{pass, ticks},
    explain::read,
    real,
    recorded::{self, say_moved_aside},
    result_file::{ResultKind, require_outside},
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
            let robot = args.real.body(args.robot.plugin()?)?;
            let hand_pictures = args.hand_cameras.of(&robot)?;
            let scene = args.read_faultless(setup).map_err(Failure::input)?;
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
            // The last tick that is recorded is still the real robot's.
            let recorded = recorded::finish(&mut app);
            real::release(&mut app);
            let ends = args.write_ends(&app);
            args.sum_up(&true_path(setup), "", &app, start);
            recorded
                .iter()
                .for_each(|report| args.sum_up_recording(report));
            say_moved_aside(recorded.iter().flat_map(|report| &report.moved_aside));
            Failure::of_all([script, recorded.map(drop), ends])?;
            Ok(ExitCode::SUCCESS)
        }
    }
}

/// Simulates a scene for this many seconds, and writes the final poses of all objects.
pub(super) fn simulate(
    scene: SceneSpec,
    seconds: f64,
    final_state: &Output,
) -> Result<ExitCode, Failure> {
    let mut app = headless_app_with(TabletopSimPlugins);
    put_on_table(scene, &mut app);
    pass(&mut app, ticks(seconds));
    write_final_state(&app, final_state)?;
    Ok(ExitCode::SUCCESS)
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
    let recorded = recorded::finish(&mut app).map_err(|failure| failure.unless_said(&said));
    real::release(&mut app);
    let ends = args.write_ends(&app);
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
    args.sum_up_recording(&report);
    say_moved_aside(&report.moved_aside);
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
        let recording: Vec<_> = self.record.as_deref().into_iter().collect();
        if let Some(path) = self.save.as_deref() {
            if is_taken(path) {
                let path = path.display();
                let reason =
                    format!("{path}: it exists, and --save replaces nothing; name a new file");
                return Err(Failure::input(reason));
            }
            require_outside(path, &recording)?;
        }
        for (output, kind) in [
            (&self.final_state, ResultKind::Table),
            (&self.final_robot, ResultKind::Json),
        ] {
            if let Some(output) = output {
                output.check(kind)?;
            }
            if let Some(Output::File(path)) = output {
                require_outside(path, &recording)?;
            }
        }
        self.record
            .as_deref()
            .map_or(Ok(()), |folder| require_outside(folder, &[]))
    }

    /// Sums up the run: its work, its duration, and its file.
    fn sum_up(&self, file: &Path, done: &str, app: &App, start: Instant) {
        let file = file.display();
        let ticks = app.world().resource::<SimTick>().0;
        let simulated = ticks as f64 / f64::from(TICKS_PER_SECOND);
        let real = start.elapsed().as_secs_f64();
        self.quiet.sum_up(format_args!(
            "{file}: {done}{simulated:.2} s simulated in {real:.2} s"
        ));
    }

    /// Says which recording was made, if one was.
    fn sum_up_recording(&self, report: &RecordingReport) {
        if let Some(folder) = self.record.as_deref().filter(|_| report.started > 0) {
            self.quiet.sum_up_recording(folder);
        }
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
    let unsaid = save_new_task(app.world(), path)
        .map_err(|error| Failure::run(format!("{name}: it cannot be saved: {error}")))?;
    for unsaid in unsaid {
        say(format_args!("tabletop: {name}: {unsaid}"));
    }
    Ok(())
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

    use crate::{core::ObjectIndex, shipped::read_faultless_task, storage::TemporaryFolder};

    use super::*;

    #[test]
    fn a_task_file_is_read_once_before_the_first_tick() {
        let folder = TemporaryFolder::new("tabletop-run-once").unwrap();
        let setup = folder.path().join("setup.xml");
        let text = crate::shipped::read_text(Path::new(DEFAULT_SETUP)).unwrap();
        fs::write(&setup, text).unwrap();
        let scene = read_faultless_task(&setup, &[]).unwrap();
        fs::remove_file(&setup).unwrap();
        let mut app = headless_app_with(TabletopSimPlugins);
        put_on_table(scene, &mut app);
        app.step(1);
        assert_eq!(app.world().resource::<ObjectIndex>().iter().count(), 2);
    }
}
