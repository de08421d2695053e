//! `tabletop benchmark`: what is understood of taught programs, and how often policies do tasks.

use std::process::ExitCode;

use crate::{
    benchmark::{
        BenchmarkLesson, LESSONS, RobotTrials, Score, Teacher, TeachingResult, TrialRobot, table,
        trials_table,
    },
    robot::RobotPlugin,
    run_episodes,
};
use clap::{ArgGroup, Args};

use super::{
    Failure, Output,
    jobs::{JOBS, at_a_time},
    judge::JudgeOptions,
    range::{NumberRange, SEEDS},
    terminal::{say, show_warnings},
};

const TABLES: NumberRange<usize> = NumberRange::whole(1, 10_000);

#[derive(Args)]
#[command(mut_arg("policy", |policy| policy.conflicts_with_all(OF_TEACHING)))]
#[command(mut_group("RobotChoice", |options| options.requires("policy")))]
#[command(mut_group("ShardOption", |options| options.requires("policy")))]
#[command(group = ArgGroup::new("judged").args(["policy", "merge"]))]
pub(super) struct BenchmarkArgs {
    /// The families of programs, by the beginnings of their names, such as `sort` or `swap`; with --policy, the tasks by theirs, such as `stack` [default: all]
    #[arg(value_name = "FAMILY")]
    families: Vec<String>,
    /// The seed of all demonstrations and tables, from 0 to 18446744073709551615
    #[arg(long, value_name = "N", default_value = "1", value_parser = SEEDS, allow_negative_numbers = true)]
    seed: u64,
    /// Number of other tables on which a program is compared with the true one, from 1 to 10000
    #[arg(long, value_name = "N", default_value = "25", value_parser = TABLES, allow_negative_numbers = true)]
    tables: usize,
    /// Let the robot do each program that is right in the end on so many further tables with two to nine objects, from 1 to 10000, and print how often it is done
    #[arg(long, value_name = "N", value_parser = TABLES, allow_negative_numbers = true)]
    trials: Option<usize>,
    /// Let the demonstrations be understood from pictures of the head camera alone, as `tabletop watch` does
    #[arg(long)]
    watch: bool,
    /// Print what was found for each program, too
    #[arg(long)]
    programs: bool,
    /// Number of programs or episodes at a time, from 1 to 256 [default: the number of cores]
    #[arg(long, value_name = "N", value_parser = JOBS, allow_negative_numbers = true)]
    jobs: Option<usize>,
    #[command(flatten)]
    judging: JudgeOptions,
}

/// The options of taught programs.
const OF_TEACHING: [&str; 5] = ["seed", "tables", "trials", "watch", "programs"];

/// Teaches programs by demonstrations, and says how many were understood; or judges a policy.
pub(super) fn benchmark(args: &BenchmarkArgs) -> Result<ExitCode, Failure> {
    show_warnings();
    if args.judging.is_asked() {
        return args.judging.judge(&args.families, args.jobs);
    }
    let lessons = args.lessons()?;
    let robot = args.trials.map(|_| TrialRobot::new(RobotPlugin::default()));
    let robot = robot.transpose().map_err(Failure::run)?;
    let teacher = match args.watch {
        true => Teacher::Showing,
        false => Teacher::Telling,
    };
    let (mut scores, mut trials) = (Vec::new(), Vec::new());
    run_episodes(
        0..lessons.len() as u64,
        at_a_time(args.jobs, lessons.len()),
        |number| {
            let seed = args.seed.wrapping_add(number);
            let lesson = lessons[number as usize];
            let score = Score::of(lesson, teacher, seed, args.tables).map_err(Failure::run)?;
            let trials = robot.as_ref().zip(args.trials);
            let trials = trials.and_then(|(robot, tables)| tried(&score, robot, seed, tables));
            Ok::<_, Failure>((score, trials))
        },
        |_, (score, tried): (Score, Option<RobotTrials>)| {
            if args.programs {
                say(report(&score));
                tried.iter().for_each(|trials| say(trials_report(trials)));
            }
            scores.push(score);
            trials.extend(tried);
            Ok(())
        },
    )?;
    Output::tell(&table(&scores))?;
    if robot.is_some() {
        Output::tell(&trials_table(&trials))?;
    }
    Ok(ExitCode::SUCCESS)
}

impl BenchmarkArgs {
    fn lessons(&self) -> Result<Vec<&'static BenchmarkLesson>, Failure> {
        let is_of =
            |lesson: &BenchmarkLesson, name: &String| lesson.family.starts_with(name.as_str());
        let unknown = self
            .families
            .iter()
            .find(|name| !LESSONS.iter().any(|lesson| is_of(lesson, name)));
        if let Some(name) = unknown {
            let mut families: Vec<_> = LESSONS.iter().map(|lesson| lesson.family).collect();
            families.dedup();
            return Err(Failure::input(format!(
                "{name}: no family's name begins so; they are {}",
                families.join(", ")
            )));
        }
        let is_chosen = |lesson: &&BenchmarkLesson| {
            self.families.is_empty() || self.families.iter().any(|name| is_of(lesson, name))
        };
        Ok(LESSONS.iter().filter(is_chosen).collect())
    }
}

/// What a robot does of the program that was found in the end. `None` if that is not right.
fn tried(score: &Score, robot: &TrialRobot, seed: u64, tables: usize) -> Option<RobotTrials> {
    let found = score.results.last().filter(|it| it.is_right);
    let program = found.and_then(|TeachingResult { found, .. }| found.parse().ok())?;
    Some(RobotTrials::of(score.lesson, &program, robot, seed, tables))
}

/// What a robot did of a program.
fn trials_report(trials: &RobotTrials) -> String {
    let (done, all) = (trials.done(), trials.trials.len());
    let failures = trials.failures().into_iter();
    let failures = failures.map(|(class, count)| format!("; {count} {class}"));
    format!(
        "  by the robot: {done} of {all}{}",
        failures.collect::<String>()
    )
}

/// What was found of a program.
fn report(score: &Score) -> String {
    let one_line = |text: &str| text.replace('\n', " ");
    let results = score.results.iter().enumerate().map(|(i, result)| {
        let verdict = match (result.is_right, result.is_named) {
            (true, _) => "right",
            (false, true) => "named",
            (false, false) => "wrong",
        };
        let others = result.alternatives;
        format!(
            "  {}: {verdict}, {others} others: {}",
            i + 1,
            one_line(&result.found)
        )
    });
    let lines = [one_line(score.lesson.sentences)]
        .into_iter()
        .chain(results);
    lines.collect::<Vec<_>>().join("\n")
}
