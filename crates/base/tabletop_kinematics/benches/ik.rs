//! Benchmark of inverse kinematics on one core.
//!
//! `cargo bench -p tabletop_kinematics` asks for the poses of the hand at random angles, starting at the robot's first
//! posture (a jump anywhere) and at angles close by (following a hand), and for poses out of reach. It prints the time of an
//! answer, in µs, and that of all frames of the robot.
#![expect(clippy::print_stdout, reason = "a benchmark prints its results")]

use std::{error::Error, hint::black_box, time::Instant};

use tabletop_kinematics::{ArmChain, Target, baxter};

const POSES: usize = 1000;
const START: [f64; 7] = [0.25, 0.0, -1.527, 2.618, 1.529, 1.5, 0.0];
/// Distance of a seed that is close by from the angles of the pose, in rad.
const NEAR: f64 = 0.05;

fn main() -> Result<(), Box<dyn Error>> {
    let robot = baxter()?;
    let arm = ArmChain::between(&robot, "torso", "left_end_effector")?;
    let mut state = 1;
    let angles: Vec<_> = (0..POSES)
        .map(|_| {
            let limits = arm.limits();
            let angles = limits
                .iter()
                .map(|[least, largest]| least + random(&mut state) * (largest - least));
            angles.collect::<Vec<_>>()
        })
        .collect();

    let report = |what: &str, beyond: f64, seed: &mut dyn FnMut(&[f64]) -> Vec<f64>| {
        let mut times = Vec::with_capacity(POSES);
        let mut solved = 0;
        for angles in &angles {
            let (mut pose, seed) = (arm.tip(angles), seed(angles));
            pose.translation.x += beyond;
            let target = Target::Pose(pose);
            let start = Instant::now();
            solved += usize::from(black_box(arm.solve(&target, &seed)).is_ok());
            times.push(start.elapsed().as_secs_f64() * 1e6);
        }
        times.sort_by(f64::total_cmp);
        let mean = times.iter().sum::<f64>() / POSES as f64;
        println!(
            "{what:<20} {solved} of {POSES} solved, mean {mean:.1}, median {:.1}, 99 % {:.1}, longest {:.1} µs",
            times[POSES / 2],
            times[POSES * 99 / 100],
            times[POSES - 1],
        );
    };
    report("from the start", 0.0, &mut |_| START.to_vec());
    report("2 m out of reach", 2.0, &mut |_| START.to_vec());
    report("from close by", 0.0, &mut |angles| {
        let near = |angle| angle + NEAR * (2.0 * random(&mut state) - 1.0);
        angles.iter().map(near).collect()
    });

    let mut frames = robot.frames(&robot.zero());
    let mut configuration = robot.zero();
    arm.set_angles(&START, &mut configuration);
    let start = Instant::now();
    for _ in 0..10_000 {
        robot.frames_into(black_box(&configuration), &mut frames);
    }
    let each = start.elapsed().as_secs_f64() * 1e6 / 10_000.0;
    println!("all {} frames        {each:.2} µs", robot.links().len());
    Ok(())
}

/// Random numbers from 0 to 1 that are the same everywhere.
fn random(state: &mut u64) -> f64 {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    (*state >> 11) as f64 / (1_u64 << 53) as f64
}
