//! Benchmark: pictures of Baxter's moving arms over three blocks, as environments draw them.
//!
//! `cargo bench -p tabletop -p tabletop_camera --bench baxter` prints the median time of a picture on one core. `-- 128` draws only pictures of this
//! size, and `-- 128 once` each only once, for a profiler.
#![expect(clippy::print_stdout, reason = "a benchmark prints its results")]

mod robot;

use std::time::Instant;

use tabletop_camera::{Rasterizer, Scene};
use tabletop_core::Picture;

use robot::MovingBaxter;

const PICTURES: usize = 100;
const TURNS: usize = 40;

fn main() {
    let args: Vec<_> = std::env::args().skip(1).collect();
    let mut robot = MovingBaxter::at_home();
    let scenes: Vec<Scene> = (0..PICTURES)
        .map(|_| {
            robot.step();
            robot.scene()
        })
        .collect();
    let turns = match args.iter().any(|arg| arg == "once") {
        true => 1,
        false => TURNS,
    };
    for side in [64, 84, 128] {
        let is_named = |arg: &String| arg.parse() == Ok(side);
        if args.iter().any(|arg| arg.parse::<u32>().is_ok()) && !args.iter().any(is_named) {
            continue;
        }
        let camera = robot.camera(side, false);
        let (mut rasterizer, mut picture) = (Rasterizer::alone(), Picture::default());
        let mut times: Vec<f64> = (0..turns)
            .map(|_| {
                let start = Instant::now();
                for scene in &scenes {
                    rasterizer.draw(scene, &camera, &mut picture);
                }
                start.elapsed().as_secs_f64() / scenes.len() as f64
            })
            .collect();
        times.sort_by(f64::total_cmp);
        let median = times[times.len() / 2] * 1e6;
        println!("{side:4} x {side:<4} {median:7.1} µs a picture");
    }
}
