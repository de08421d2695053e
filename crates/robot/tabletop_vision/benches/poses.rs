//! The errors of poses in pictures of random scenes, and the time that a picture takes: `cargo bench -p tabletop_vision [-- TASK [COUNT]]`.
#![expect(
    clippy::print_stdout,
    clippy::unwrap_used,
    reason = "a bench prints a table, and may panic"
)]

#[path = "../tests/poses/scenes.rs"]
mod scenes;

use std::time::Instant;

use bevy::math::Vec3;
use scenes::{Difficulty, TASKS, TaskScene};
use tabletop_vision::KnownScenery;

/// Number of pictures in which an object is followed.
const FRAMES: u32 = 40;
/// The least part of an object that is visible of which the pose counts.
const VISIBLE: f32 = 0.1;
/// Number of looks at each picture.
const REPEATED: usize = 2;

const EASY: Difficulty = Difficulty {
    is_end: false,
    noise: 0.0,
    distractors: 0,
    same_color: false,
    light: 0.0,
};

const DIFFICULTIES: [(&str, Difficulty); 7] = [
    ("beginning", EASY),
    (
        "end",
        Difficulty {
            is_end: true,
            ..EASY
        },
    ),
    (
        "noise",
        Difficulty {
            noise: 10.0,
            ..EASY
        },
    ),
    ("light", Difficulty { light: 0.3, ..EASY }),
    (
        "distractors",
        Difficulty {
            distractors: 4,
            ..EASY
        },
    ),
    (
        "same colour",
        Difficulty {
            same_color: true,
            ..EASY
        },
    ),
    (
        "same, end",
        Difficulty {
            same_color: true,
            is_end: true,
            ..EASY
        },
    ),
];

fn main() {
    let mut words = std::env::args()
        .skip(1)
        .filter(|word| !word.starts_with("--"));
    let wanted = words.next().unwrap_or_default();
    let count: u64 = words.next().map_or(100, |count| count.parse().unwrap());
    let difficulty = words.next().unwrap_or_default();
    let is_verbose = words.next().is_some();
    println!(
        "{:12} {:12} {:>8} {:>8} {:>8} {:>8} {:>7} {:>6} {:>6} {:>7} {:>7}",
        "task",
        "",
        "median",
        "99 %",
        "deg 99 %",
        "largest",
        "wrong",
        "silent",
        "doubt",
        "ms",
        "most"
    );
    for task in TASKS.iter().filter(|task| task.name.contains(&wanted)) {
        follow(task);
    }
    for task in TASKS.iter().filter(|task| task.name.contains(&wanted)) {
        for (name, own) in DIFFICULTIES.iter().filter(|it| it.0.contains(&difficulty)) {
            let (mut errors, mut times) = (Vec::new(), Vec::new());
            for seed in 0..count {
                let sample = task.sample(own, seed);
                let mut eyes = sample.eyes();
                // The least of some times, since other programs run meanwhile.
                let mut looks = (0..REPEATED).map(|_| {
                    eyes.forget();
                    let start = Instant::now();
                    let seen = eyes.look(&sample.picture, &KnownScenery::default());
                    (start.elapsed().as_secs_f64() * 1e3, seen)
                });
                let (first, seen) = looks.next().unwrap();
                times.push(looks.fold(first, |least, (time, _)| least.min(time)));
                for error in sample.errors(&seen) {
                    if is_verbose && (error.length > 0.02 || error.degrees > 1.0) {
                        println!("  seed {seed}: {error:?}");
                    }
                    errors.push(error);
                }
            }
            // What is hidden cannot be known.
            let silent = errors
                .iter()
                .filter(|error| error.length > 0.1 && error.is_sure);
            let silent = silent.count();
            errors.retain(|error| error.visible > VISIBLE);
            let part = |mut of: Vec<f32>, part: f32| {
                of.sort_by(f32::total_cmp);
                of[((of.len() - 1) as f32 * part).round() as usize]
            };
            let lengths: Vec<_> = errors.iter().map(|error| error.length).collect();
            let degrees = errors.iter().map(|error| error.degrees).collect();
            let wrong = errors.iter().filter(|error| error.length > 0.1);
            let doubted = errors
                .iter()
                .filter(|error| error.length <= 0.02 && !error.is_sure)
                .count();
            let percent = |count: usize| 100.0 * count as f64 / errors.len() as f64;
            println!(
                "{:12} {name:12} {:8.4} {:8.4} {:8.2} {:8.3} {:6.1}% {:5.1}% {:5.1}% {:7.1} {:7.1}",
                task.name,
                part(lengths.clone(), 0.5),
                part(lengths.clone(), 0.99),
                part(degrees, 0.99),
                part(lengths, 1.0),
                percent(wrong.count()),
                percent(silent),
                percent(doubted),
                times.iter().sum::<f64>() / times.len() as f64,
                times.iter().copied().fold(0.0, f64::max)
            );
        }
    }
}

/// Follows the last object, which is lifted and carried, through pictures, and prints its largest error and the time of a picture.
fn follow(task: &TaskScene) {
    let sample = task.sample(&EASY, 3);
    let mut eyes = sample.eyes();
    eyes.look(&sample.picture, &KnownScenery::default());
    let mut poses = sample.poses.clone();
    let last = poses.len() - 1;
    let start = poses[last].location;
    let (mut largest, mut total) = (0.0_f32, 0.0);
    for frame in 1..=FRAMES {
        let time = frame as f32 / 10.0;
        let aside = (time - 2.0).max(0.0);
        poses[last].location = start + Vec3::new(aside, 0.3 * aside, time.min(2.0));
        let picture = sample.with_poses(&poses);
        let begin = Instant::now();
        let seen = eyes.look(&picture, &KnownScenery::default());
        total += begin.elapsed().as_secs_f64() * 1e3;
        let pose = seen.objects[last].pose.unwrap();
        largest = largest.max(pose.location.distance(poses[last].location));
    }
    println!(
        "{:12} following    largest error {largest:.4}, {:.1} ms a picture",
        task.name,
        total / f64::from(FRAMES)
    );
}
