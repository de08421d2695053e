//! `tabletop learn`: a policy from one demonstration.

use std::{ops::ControlFlow, path::PathBuf, process::ExitCode, time::Instant};

use crate::{
    multiplication::Multiplication,
    policy::{Curriculum, Evaluation, PolicyError, Training, loss_curve},
    recorder::RecordingReader,
    storage::WriterLock,
};
use clap::Args;

use super::{
    Failure, Output,
    cut_off::say_if_cut_off,
    jobs::{JOBS, at_a_time},
    progress::ProgressLine,
    range::{NumberRange, SEEDS},
    result_file::{ResultFile, ResultKind, require_outside},
    terminal::show_warnings,
    variation_options::VariationOptions,
    wait::WaitOption,
};

#[derive(Args)]
pub(super) struct LearnArgs {
    /// The recording's folder
    #[arg(value_name = "DIR")]
    recording: PathBuf,
    /// The policy's file; a training that it holds goes on. The plot of the loss is put beside it, as .svg
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Number of scenes to learn from, from 1 to 1000000
    #[arg(long, value_name = "N", default_value_t = 2000, value_parser = COUNTS, allow_negative_numbers = true)]
    count: u64,
    /// Number of samples, each a step in a scene, from 1 to 100000000
    #[arg(long, value_name = "N", default_value_t = 40_000, value_parser = SAMPLES, allow_negative_numbers = true)]
    samples: u64,
    /// Number of other scenes in which the policy is tried in the end, from 0 to 100000
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = TRIALS, allow_negative_numbers = true)]
    trials: u64,
    /// The seed of scenes, samples and first weights, from 0 to 18446744073709551615 [default: 0]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true, value_parser = SEEDS, allow_negative_numbers = true)]
    seed: u64,
    #[command(flatten)]
    variation: VariationOptions,
    /// Number of threads, from 1 to 256, of which at most four have work [default: the number of cores]
    #[arg(long, value_name = "N", value_parser = JOBS, allow_negative_numbers = true)]
    jobs: Option<usize>,
    #[command(flatten)]
    wait: WaitOption,
}

const COUNTS: NumberRange<u64> = NumberRange::whole(1, 1_000_000);
const SAMPLES: NumberRange<u64> = NumberRange::whole(1, 100_000_000);
const TRIALS: NumberRange<u64> = NumberRange::whole(0, 100_000);

/// Learns, and prints how the policy does in other scenes. Exit code 1 if it cannot learn.
pub(super) fn run(args: &LearnArgs) -> Result<ExitCode, Failure> {
    show_warnings();
    let plot = args.out.with_extension("svg");
    if plot == args.out {
        let out = args.out.display();
        return Err(Failure::input(format!(
            "{out}: the plot of the loss has this name; name a policy such as policy.safetensors"
        )));
    }
    ResultFile::replacing(&args.out, ResultKind::Policy)?;
    let plot = ResultFile::replacing(&plot, ResultKind::LossCurve)?;
    require_outside(&args.out, &[&args.recording])?;
    let _alone = WriterLock::of_place(&args.out, &args.wait.storage())
        .map_err(|error| Failure::at(&args.out, error))?;
    let recording = RecordingReader::open(&args.recording).map_err(Failure::input)?;
    say_if_cut_off(&recording, "learned from");
    let variation = args.variation.variation();
    let multiplication = Multiplication::of(&recording, None, variation, args.seed);
    let multiplication = multiplication.map_err(Failure::input)?;
    let curriculum = Curriculum::new(&multiplication, args.count).map_err(failure)?;
    let training = Training::resume(&args.out, &curriculum, args.samples, args.seed);
    let mut training = training.map_err(failure)?;
    let start = Instant::now();
    learn(args, &curriculum, &mut training)?;
    let seconds = start.elapsed().as_secs_f64();
    plot.write(loss_curve(training.losses()).as_bytes())?;
    let evaluation = training
        .policy()
        .evaluate(&curriculum, args.trials)
        .map_err(failure)?;
    let text = format!("learned in {seconds:.0} s\n{}", table(&evaluation));
    Output::tell(&text)?;
    Ok(ExitCode::SUCCESS)
}

fn learn(
    args: &LearnArgs,
    curriculum: &Curriculum,
    training: &mut Training,
) -> Result<(), Failure> {
    let mut line = ProgressLine::new(args.samples, " samples");
    let threads = at_a_time(args.jobs, usize::MAX);
    let result = training.run(curriculum, threads, &args.out, |progress| {
        let [done, all] = progress.samples;
        line.expect(all);
        line.reach(done, &format!(", loss {:.2}", progress.loss));
        ControlFlow::Continue(())
    });
    line.end();
    result.map_err(failure)
}

fn table(evaluation: &Evaluation) -> String {
    let trials = evaluation.done.len() + evaluation.failed.len();
    let mut text = format!(
        "{} of {trials} unseen scenes done; objects taken {:.2} units from their origins on average\n",
        evaluation.done.len(),
        evaluation.mean_pick_error(),
    );
    for (number, failure) in &evaluation.failed {
        text += &format!("scene {number}: {failure}\n");
    }
    text
}

fn failure(error: PolicyError) -> Failure {
    match error {
        PolicyError::Io { .. } | PolicyError::Wire(_) => Failure::run(error),
        PolicyError::Multiply(_)
        | PolicyError::NoPlace(_)
        | PolicyError::TooManyLevels(_)
        | PolicyError::NothingSeen
        | PolicyError::Damaged { .. }
        | PolicyError::OtherCurriculum { .. } => Failure::input(error),
    }
}
