//! Benchmark of a large pyramid: 5,050 boxes in 100 storeys, as Box2D and Box3D have it among their own benchmarks.
//!
//! `cargo bench --bench large_pyramid` simulates 1,000 steps of 1/60 s, and prints what the first hundred take, what all take, how far the
//! farthest box has moved, and whether the pyramid stands.
#![expect(clippy::print_stdout, reason = "a benchmark prints its results")]

use std::time::Instant;

use bevy::prelude::*;
use tabletop::{headless_app, prelude::*};

const STOREYS: usize = 100;
const STEPS: u64 = 1_000;
const FIRST: u64 = 100;

/// A box that has moved by more, in units, has left its place.
const STANDS: f32 = 0.5;

fn main() {
    let mut app = headless_app();
    let items = places().enumerate().map(|(number, place)| {
        let shape = Shape::Block {
            span: Vec3::ONE,
            color: Rgb::GRAY,
        };
        let id = format!("box{number}");
        SceneItem::Object(ObjectSpec::new(id, Pose::at(place), 1.0, shape))
    });
    let table = Table {
        xspan: 1.2 * STOREYS as f32,
        yspan: 12.0,
    };
    let scene = SceneSpec {
        table,
        items: items.collect(),
    };
    app.world_mut()
        .write_command(SceneCommand::Set(Box::new(scene)));
    app.step(1);
    let start = Instant::now();
    for _ in 0..FIRST {
        app.step(1);
    }
    let first = start.elapsed();
    app.step(STEPS - FIRST);
    let all = start.elapsed();
    let index = app.world().resource::<ObjectIndex>();
    let moved = places().enumerate().map(|(number, place)| {
        let object = index.get(&format!("box{number}"));
        let now = object.and_then(|object| app.world().get::<Transform>(object));
        now.map_or(f32::INFINITY, |now| now.translation.distance(place))
    });
    let farthest = moved.fold(0.0, f32::max);
    let stands = if farthest < STANDS { "stands" } else { "falls" };
    let per_step = |time: std::time::Duration, steps| time.as_secs_f64() * 1e3 / steps as f64;
    println!("{} boxes", places().count());
    println!(
        "{:7.1} ms a step, the first {FIRST}",
        per_step(first, FIRST)
    );
    println!("{:7.1} ms a step, all {STEPS}", per_step(all, STEPS));
    println!("{farthest:7.3} units moved at most: it {stands}");
}

/// The centres of the boxes, storey by storey.
fn places() -> impl Iterator<Item = Vec3> {
    (0..STOREYS).flat_map(|storey| {
        let boxes = STOREYS - storey;
        let left = -0.5 * (boxes - 1) as f32;
        (0..boxes).map(move |place| Vec3::new(left + place as f32, 0.0, storey as f32 + 0.5))
    })
}
