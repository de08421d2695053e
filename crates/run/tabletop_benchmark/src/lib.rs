//! Benchmarks: what is understood of task programs that are taught by demonstrations, and how often policies do tasks.
//!
//! A [`BenchmarkLesson`] has a true program and tables at random. It is taught by one to three demonstrations that the program itself makes, with detours and
//! in random order, whose poses are told or which is watched through the head camera. What is understood is compared with the true program by what both do on other tables.
//!
//! [`RobotTrials`] let a robot do what was understood on further tables.
//!
//! [`JUDGED_TASKS`] are tasks with fixed beginnings, by which policies are judged: a [`PolicyJudgement`] has the results, with all that is needed to repeat them.

mod judging;
mod lesson;
mod lessons;
mod pictures;
mod props;
mod score;
mod showing;
mod table;
mod trials;

pub use judging::{
    AnswerDelay, BENCHMARK_VERSION, BeginningError, FailureGroup, JUDGED_TASKS, JudgedEpisode,
    JudgedTask, JudgementError, JudgementFile, JudgementHeader, NamedTask, PairedOutcomes,
    Perturbation, PolicyJudgement, SuccessRate, TaskBeginning, paired_report, percent, report,
};
pub use lesson::BenchmarkLesson;
pub use lessons::LESSONS;
pub use score::{Score, Teacher, TeachingResult};
pub use table::{table, trials_table};
pub use trials::{RobotTrials, TrialRobot};
