//! Benchmark: the pictures per second that one core draws.
//!
//! `cargo bench -p tabletop -p tabletop_camera --bench pictures` prints this for the two blocks of `default.xml` with ten more, and
//! for these with two arms of 2304 triangles over them. Each scene is drawn still, with one block moved in every picture, and with
//! everything but the table moved. Balls and cylinders that move follow. All are drawn plain and with smooth edges.
#![expect(clippy::print_stdout, reason = "a benchmark prints its results")]

mod scenes;

use std::time::Instant;

use tabletop_camera::{Camera, Rasterizer, Scene};
use tabletop_core::{HeadCamera, Picture, Table};

use scenes::{arms, blocks, rounds};

const TURNS: usize = 20;
const SECONDS_PER_TURN: f64 = 0.1;

fn main() {
    println!("scene                  size      plain      smooth   pictures/s, median (best)");
    let without_arms = |solids| Scene {
        solids,
        ..Scene::default()
    };
    let with_arms = Scene {
        solids: blocks(),
        figures: arms(),
        ..Scene::default()
    };
    let still = |scene: Scene| vec![scene];
    let moving = |scene: Scene| vec![moved(&scene), scene];
    let one_moving = |scene: Scene| vec![with_one_moved(&scene), scene];
    for (name, scenes) in [
        ("default and 10 blocks", still(without_arms(blocks()))),
        ("one of them moving", one_moving(without_arms(blocks()))),
        ("all of them moving", moving(without_arms(blocks()))),
        ("the same with two arms", still(with_arms.clone())),
        ("one block moving", one_moving(with_arms.clone())),
        ("all of it moving", moving(with_arms)),
        ("20 balls and cylinders", moving(without_arms(rounds()))),
    ] {
        for (width, height) in [(200, 150), (640, 480), (1024, 600)] {
            let [plain, smooth] = [false, true].map(|antialiasing| {
                let head = HeadCamera {
                    width,
                    height,
                    antialiasing,
                    ..HeadCamera::default()
                };
                pictures_a_second(&scenes, &Camera::of_head(&head, &Table::default()))
            });
            println!("{name:22} {width:4}x{height:<4} {plain}  {smooth}");
        }
    }
}

/// Pictures per second of these scenes, one after the other.
fn pictures_a_second(scenes: &[Scene], camera: &Camera) -> String {
    let (mut rasterizer, mut picture) = (Rasterizer::default(), Picture::default());
    let mut rates: Vec<f64> = (0..TURNS)
        .map(|_| {
            let (start, mut count) = (Instant::now(), 0);
            while start.elapsed().as_secs_f64() < SECONDS_PER_TURN {
                for scene in scenes {
                    rasterizer.draw(scene, camera, &mut picture);
                    count += 1;
                }
            }
            f64::from(count) / start.elapsed().as_secs_f64()
        })
        .collect();
    rates.sort_by(f64::total_cmp);
    format!("{:6.0} ({:.0})", rates[TURNS / 2], rates[TURNS - 1])
}

/// The scene with its last solid a little farther right.
fn with_one_moved(scene: &Scene) -> Scene {
    let mut moved = scene.clone();
    if let Some(solid) = moved.solids.last_mut() {
        solid.pose.location.x += 0.01;
    }
    moved
}

/// The scene with everything but the table, which comes first, a little farther right.
fn moved(scene: &Scene) -> Scene {
    let mut moved = scene.clone();
    let solids = moved.solids.iter_mut().skip(1).map(|solid| &mut solid.pose);
    let figures = moved.figures.iter_mut().map(|figure| &mut figure.pose);
    for pose in solids.chain(figures) {
        pose.location.x += 0.01;
    }
    moved
}
