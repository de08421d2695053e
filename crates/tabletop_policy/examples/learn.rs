//! Learns from a recording, and evaluates: `learn DEMO FILE SAMPLES [SCENES]`.
#![expect(clippy::print_stdout, clippy::unwrap_used, reason = "an experiment")]

use std::{ops::ControlFlow, path::Path, time::Instant};

use tabletop_episodes::multiplication::{Multiplication, Variation};
use tabletop_policy::{Curriculum, Training, loss_curve};
use tabletop_recorder::RecordingReader;

fn main() {
    let arguments: Vec<_> = std::env::args().skip(1).collect();
    let recording = RecordingReader::open(&arguments[0]).unwrap();
    let file = Path::new(&arguments[1]);
    let samples = arguments[2].parse().unwrap();
    let number = |i: usize, usual: f32| arguments.get(i).map_or(usual, |it| it.parse().unwrap());
    let variation = Variation {
        light: number(4, 0.3),
        camera: number(5, 0.2),
        distractors: number(6, 2.0) as u32,
        ..Variation::default()
    };
    let multiplication = Multiplication::of(&recording, None, variation, 0).unwrap();
    let curriculum = Curriculum::new(&multiplication, 20_000).unwrap();
    let mut training = Training::resume(file, &curriculum, samples, 0).unwrap();
    let start = Instant::now();
    training
        .run(&curriculum, 1, file, |progress| {
            let [done, all] = progress.samples;
            if done % 800 == 0 {
                println!(
                    "{done}/{all} loss {:.3}, {:.1}/s, {:?} left",
                    progress.loss, progress.rate, progress.left
                );
            }
            ControlFlow::Continue(())
        })
        .unwrap();
    println!("trained in {:?}", start.elapsed());
    tabletop_storage::Storage::default()
        .replace(
            &file.with_extension("svg"),
            loss_curve(training.losses()).as_bytes(),
        )
        .unwrap();
    let start = Instant::now();
    let evaluation = training
        .policy()
        .evaluate(&curriculum, number(3, 100.0) as u64)
        .unwrap();
    println!(
        "{} done, {} moves, pick error {:.3}, failed {:?}, {:?}",
        evaluation.done.len(),
        evaluation.moves,
        evaluation.mean_pick_error(),
        evaluation.failed,
        start.elapsed()
    );
}
