//! `tabletop benchmark --policy`: how often a policy does tasks with fixed beginnings.

mod judgement_page;
mod policy_judge;

use std::{
    collections::BTreeSet,
    path::{Path, PathBuf},
    process::ExitCode,
    time::Instant,
};

use crate::{
    Collection,
    benchmark::{
        BENCHMARK_VERSION, JUDGED_TASKS, JudgedEpisode, JudgedTask, JudgementError, JudgementFile,
        JudgementHeader, NamedTask, Perturbation, PolicyJudgement, paired_report, report,
    },
    core::{RobotMode, TICKS_PER_SECOND},
    multiplication::Fingerprint,
    policy::ActingPolicy,
    robot::RobotPlugin,
    run_episodes,
    storage::{Symlinks, read_regular_file},
    wire::{WireMap, WireValue},
};
use clap::{Args, builder::PossibleValuesParser};
use serde_json::{Value, json};

use super::{
    Failure, Output,
    acting_policy::PolicyOptions,
    jobs::at_a_time,
    multiply::refused,
    progress::ProgressLine,
    range::NumberRange,
    result_file::{ResultFile, ResultKind, require_outside},
    robot_options::RobotChoice,
    shard::ShardOption,
    wait::WaitOption,
};
use judgement_page::page_of;
use policy_judge::PolicyJudge;

const EPISODES: NumberRange<u64> = NumberRange::whole(1, 100_000);
/// Most bytes of a policy's file.
const MOST_BYTES: u64 = 1 << 32;
/// The file with what a folder of recordings is made of.
const MANIFEST: &str = "benchmark.json";
/// What stands for each perturbation.
const EACH: &str = "all";

#[derive(Args)]
pub(super) struct JudgeOptions {
    #[command(flatten)]
    policy: PolicyOptions,
    #[command(flatten)]
    robot: RobotChoice,
    /// Number of episodes of each task, from 1 to 100000
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = EPISODES, requires = "policy", allow_negative_numbers = true)]
    episodes: u64,
    /// Do each episode once more with this perturbation, from the same beginning; `all` does it with each in turn
    #[arg(long, value_name = "KIND", requires = "policy", value_delimiter = ',', value_parser = perturbations())]
    perturb: Vec<String>,
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
    /// Write all results into this page, which a browser shows without network; with --record, films of a success and of failures of each task are in it
    #[arg(long, value_name = "FILE", requires = "judged")]
    html: Option<PathBuf>,
    #[command(flatten)]
    wait: WaitOption,
}

/// The names of perturbations, and of all of them.
fn perturbations() -> PossibleValuesParser {
    let names = Perturbation::ALL.map(Perturbation::name);
    PossibleValuesParser::new(names.into_iter().chain([EACH]))
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
        let page = self.html.as_deref();
        let page = page.map(|file| ResultFile::replacing(file, ResultKind::Page));
        let page = page.transpose()?;
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
        if let Some(page) = page {
            let beside = self.beside.as_deref().zip(other.as_ref());
            let text = page_of(&judgement, beside, self.record.as_deref())?;
            page.write(text.as_bytes())?;
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
        if let Some(episode) = merged
            .missing()
            .and_then(|it| merged.header.episode_name(it))
        {
            return Err(Failure::input(format!(
                "{episode}: it is in none of these files"
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
        let thinking = self.policy.thinking();
        let judge = PolicyJudge::new(&policy, thinking, robot, &header, collection.as_ref())?;
        let all = header.round() * self.episodes;
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
            robot: robot.layout().name.clone(),
            dynamic: robot.mode == RobotMode::Dynamic,
            policy: name.display().to_string(),
            about,
            mapping,
            delay: self.policy.delay(),
            tasks: tasks.iter().map(|task| NamedTask::from(*task)).collect(),
            perturbations: self.perturbations(),
        })
    }

    fn perturbations(&self) -> Vec<Perturbation> {
        let is_asked = |perturbation: &Perturbation| {
            let mut names = self.perturb.iter();
            names.any(|name| [EACH, perturbation.name()].contains(&name.as_str()))
        };
        Perturbation::ALL.into_iter().filter(is_asked).collect()
    }
}

/// The tasks of these names, or those whose names begin so; all if there are no names.
fn tasks_of(names: &[String]) -> Result<Vec<&'static JudgedTask>, Failure> {
    let is_whole = |name: &String| JUDGED_TASKS.iter().any(|task| task.name == name);
    let is_of = |task: &JudgedTask, name: &String| match is_whole(name) {
        true => task.name == name,
        false => task.name.starts_with(name.as_str()),
    };
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_whole_name_is_one_task_and_a_beginning_is_all_that_begin_so() {
        let named = |name: &str| tasks_of(&[name.to_owned()]).map_or(0, |tasks| tasks.len());
        assert_eq!(named("stack"), 1);
        assert!(named("s") > 1);
        assert_eq!(named("nothing"), 0);
        assert_eq!(
            tasks_of(&[]).map_or(0, |tasks| tasks.len()),
            JUDGED_TASKS.len()
        );
    }
}
