//! Judging policies: fixed tasks, each with fixed beginnings, and what a policy came to in them.

mod beginning;
mod episode;
mod judgement;
mod judgement_file;
mod pairs;
mod perturbation;
mod perturbed;
mod rate;
mod report;
mod summary;
mod tasks;

pub use beginning::{BeginningError, TaskBeginning};
pub use episode::JudgedEpisode;
pub use judgement::{AnswerDelay, JudgementHeader, NamedTask, PolicyJudgement};
pub use judgement_file::{JudgementError, JudgementFile};
pub use pairs::PairedOutcomes;
pub use perturbation::Perturbation;
pub use rate::SuccessRate;
pub use report::{paired_report, report};
pub use summary::{FailureGroup, percent};
pub use tasks::{JUDGED_TASKS, JudgedTask};

/// The version of tasks, seeds, beginnings, perturbations and time limits. Whatever changes one of them is another version.
pub const BENCHMARK_VERSION: &str = "benchmark@1";
