//! Judging policies: fixed tasks, each with fixed beginnings, and what a policy came to in them.

mod beginning;
mod episode;
mod judgement;
mod judgement_file;
mod pairs;
mod rate;
mod report;
mod tasks;

pub use beginning::{BeginningError, TaskBeginning};
pub use episode::JudgedEpisode;
pub use judgement::{JudgementHeader, NamedTask, PolicyJudgement};
pub use judgement_file::{JudgementError, JudgementFile};
pub use pairs::PairedOutcomes;
pub use rate::SuccessRate;
pub use report::{paired_report, report};
pub use tasks::{JUDGED_TASKS, JudgedTask};

/// The version of tasks, seeds, beginnings and time limits. Whatever changes one of them is another version.
pub const BENCHMARK_VERSION: &str = "benchmark@1";
