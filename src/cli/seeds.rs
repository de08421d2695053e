//! `tabletop run SCENARIO --seeds A..B`: a scenario, once with each seed.

use std::{fmt::Write as _, ops::Range, path::Path, process::ExitCode, time::Instant};

use bevy::prelude::*;
use serde_json::json;
use tabletop_core::{SimTick, StepApp as _, TICKS_PER_SECOND};
use tabletop_scenario::{Outcome, Scenario, ScenarioRun};

use super::{
    Failure, Output, jobs::at_a_time, multiply::refused, progress::ProgressLine, recorded,
    run_arguments::RunArgs, terminal::say,
};
use crate::{
    Collection, headless_app_with,
    recorder::{HandPictures, SessionHeader},
    robot::RobotPlugin,
    run_episodes,
    shipped::read_text,
};

/// The file with what a folder of recordings is made of.
const MANIFEST: &str = "seeds.json";

/// The result with a seed.
struct Performed {
    /// The step that failed, and why.
    failure: Option<String>,
    simulated: u64,
}

/// Performs a scenario with each seed. Exit code 1 if a step failed with one of them.
pub(super) fn perform(path: &Path, seeds: Range<u64>, args: &RunArgs) -> Result<ExitCode, Failure> {
    let (scenario, robot) = args.prepare(path)?;
    let work = Work {
        scenario: &scenario,
        args,
        hand_pictures: args.hand_cameras.of(&robot)?,
        robot,
    };
    let collection = match &args.record {
        Some(folder) => {
            let storage = args.wait.storage();
            let collection = Collection::open(folder, MANIFEST, &work.manifest()?, &storage);
            Some(collection.map_err(refused)?)
        }
        None => None,
    };
    let start = Instant::now();
    let mut missing = Vec::new();
    let mut there = 0;
    for seed in args.shard.share_of(seeds) {
        let is_right = |header: &SessionHeader| header.settings.get("seed") == Some(&json!(seed));
        let holds = collection.as_ref().map(|it| it.holds(seed, is_right));
        match holds.transpose().map_err(refused)? {
            Some(true) => there += 1,
            Some(false) | None => missing.push(seed),
        }
    }
    let tally = perform_all(&work, collection.as_ref(), &missing);
    let closed = collection.map_or(Ok(()), |it| it.close().map_err(refused));
    let tally = tally?;
    closed?;
    if !args.quiet.is_quiet() {
        let real = start.elapsed().as_secs_f64();
        Output::tell(&tally.summary(there, real))?;
    }
    Ok(ExitCode::from(u8::from(tally.failed > 0)))
}

#[derive(Default)]
struct SeedTally {
    done: u64,
    failed: u64,
    simulated: u64,
}

impl SeedTally {
    fn summary(&self, there: u64, real: f64) -> String {
        let mut text = String::new();
        if there > 0 {
            let _infallible = writeln!(text, "{there} were there");
        }
        let all = self.done + self.failed;
        let simulated = self.simulated as f64 / f64::from(TICKS_PER_SECOND);
        let _infallible = writeln!(
            text,
            "{} of {all} done; {simulated:.0} s simulated in {real:.1} s, {:.1} seeds a second",
            self.done,
            all as f64 / real.max(1e-3)
        );
        text
    }
}

/// Performs it with these seeds, on all cores. The first error that is not a step's ends it.
fn perform_all(
    work: &Work,
    collection: Option<&Collection>,
    seeds: &[u64],
) -> Result<SeedTally, Failure> {
    let jobs = at_a_time(work.args.jobs, seeds.len());
    let mut progress = ProgressLine::new(seeds.len() as u64, "");
    let mut tally = SeedTally::default();
    let perform = |seed| work.perform(seed, collection);
    let result = run_episodes(seeds.iter().copied(), jobs, perform, |seed, performed| {
        tally.simulated += performed.simulated;
        match performed.failure {
            None => tally.done += 1,
            Some(failure) => {
                tally.failed += 1;
                progress.end();
                say(format_args!("tabletop: seed {seed}: {failure}"));
                say(format_args!("tabletop: again: {}", work.again(seed)));
            }
        }
        progress.reach(tally.done + tally.failed, "");
        Ok(())
    });
    progress.end();
    result.map(|()| tally)
}

/// What is done with each seed.
struct Work<'a> {
    scenario: &'a Scenario,
    args: &'a RunArgs,
    robot: RobotPlugin,
    hand_pictures: HandPictures,
}

impl Work<'_> {
    /// Performs it with a seed. A recording that is whole appears in the collection.
    fn perform(&self, seed: u64, collection: Option<&Collection>) -> Result<Performed, Failure> {
        let program = match self.args.program(self.scenario, seed) {
            Ok(program) => program,
            // There is no room for this seed's places.
            Err(error) => {
                return Ok(Performed {
                    failure: Some(error.to_string()),
                    simulated: 0,
                });
            }
        };
        let folder = collection.map(|collection| collection.part(seed));
        let plugins = self.args.plugins(
            self.robot.clone(),
            folder.as_deref(),
            seed,
            self.hand_pictures.clone(),
        )?;
        let mut app = headless_app_with(plugins);
        app.insert_resource(ScenarioRun::new(program));
        self.args.robot.show(&mut app);
        let failure = loop {
            app.step(1);
            match app.world().resource::<ScenarioRun>().outcome() {
                Outcome::Running => {}
                Outcome::Done => break None,
                Outcome::Failed(error) => break Some(error.to_string()),
            }
        };
        let report = recorded::finish(&mut app)?;
        if let (Some(collection), None) = (collection, &failure)
            && report.started > 0
        {
            collection.keep(seed).map_err(refused)?;
        }
        Ok(Performed {
            failure,
            simulated: app.world().resource::<SimTick>().0,
        })
    }

    /// The command that does it again with a seed.
    fn again(&self, seed: u64) -> String {
        let args = self.args;
        let path = |path: &Path| path.display().to_string();
        let mut words = vec!["tabletop".into(), "run".into()];
        words.extend(args.scenario.as_deref().map(path));
        words.extend(["--seed".into(), seed.to_string()]);
        let (robot, is_dynamic) = args.robot.name();
        let seconds = args.seconds.map(|seconds| seconds.to_string());
        for (option, value) in [
            ("--setup", args.setup.as_deref().map(path)),
            ("--robot", robot.map(path)),
            ("--seconds", seconds),
        ] {
            words.extend(value.into_iter().flat_map(|value| [option.into(), value]));
        }
        for folder in &args.allowed.folders {
            words.extend(["--allow-path".into(), path(folder)]);
        }
        for (option, is_given) in [
            ("--dynamic", is_dynamic),
            ("--show-robot", args.robot.show_robot),
        ] {
            words.extend(is_given.then(|| option.into()));
        }
        let quoted = words
            .iter()
            .map(|word| match word.contains([' ', '\'', '"', '$', '*']) {
                true => format!("'{}'", word.replace('\'', r"'\''")),
                false => word.clone(),
            });
        quoted.collect::<Vec<_>>().join(" ")
    }

    /// All that decides the recordings, but not the seeds.
    fn manifest(&self) -> Result<serde_json::Value, Failure> {
        let text = read_text(&self.scenario.path).map_err(Failure::input)?;
        Ok(json!({
            "scenario": text,
            "setup": self.args.setup,
            "program": env!("CARGO_PKG_VERSION"),
            "robot": self.args.robot.name(),
            "show_robot": self.args.robot.show_robot,
            "hand_cameras": self.args.hand_cameras.hand_cameras,
        }))
    }
}
