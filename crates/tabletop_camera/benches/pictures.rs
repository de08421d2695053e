//! How many pictures a second one core draws.
//!
//! `cargo bench -p tabletop -p tabletop_camera --bench pictures` prints it for the two blocks of `default.xml` with ten more,
//! and for a table of balls and cylinders, plain and with smooth edges.
#![expect(clippy::print_stdout, reason = "a benchmark prints its results")]

use std::time::Instant;

use bevy::math::{Quat, Vec3};
use tabletop_camera::{Camera, DrawnSolid, Painter};
use tabletop_core::{HeadCamera, Picture, Pose, Rgb, Solid, Table};

const TURNS: usize = 20;
const SECONDS_PER_TURN: f64 = 0.1;

fn main() {
    println!("scene                  size      plain      smooth   pictures/s, median (best)");
    for (name, scene) in [
        ("default and 10 blocks", blocks()),
        ("20 balls and cylinders", rounds()),
    ] {
        for (width, height) in [(200, 150), (640, 480), (1024, 600)] {
            let [plain, smooth] = [false, true].map(|antialiasing| {
                let head = HeadCamera {
                    width,
                    height,
                    antialiasing,
                    ..HeadCamera::default()
                };
                pictures_a_second(&scene, &Camera::of_head(&head, &Table::default()))
            });
            println!("{name:22} {width:4}x{height:<4} {plain}  {smooth}");
        }
    }
}

fn pictures_a_second(scene: &[DrawnSolid], camera: &Camera) -> String {
    let (mut painter, mut picture) = (Painter::default(), Picture::default());
    let mut rates: Vec<f64> = (0..TURNS)
        .map(|_| {
            let (start, mut count) = (Instant::now(), 0);
            while start.elapsed().as_secs_f64() < SECONDS_PER_TURN {
                painter.draw(scene.iter().copied(), camera, &mut picture);
                count += 1;
            }
            f64::from(count) / start.elapsed().as_secs_f64()
        })
        .collect();
    rates.sort_by(f64::total_cmp);
    format!("{:6.0} ({:.0})", rates[TURNS / 2], rates[TURNS - 1])
}

/// The blocks of `tablesetup/default.xml`, and ten more around them.
fn blocks() -> Vec<DrawnSolid> {
    let turned = |degrees: f32| Quat::from_rotation_z(degrees.to_radians());
    let cube = |number: u32, location: Vec3, degrees: f32, span: f32, color| DrawnSolid {
        pose: Pose::new(location, turned(degrees)),
        solid: Solid::Cuboid(Vec3::splat(span)),
        color,
        object: number,
    };
    let mut scene = vec![
        DrawnSolid::of_table(&Table::default(), 1),
        cube(
            2,
            Vec3::new(2.0, 0.0, 1.0),
            -15.0,
            2.0,
            Rgb::new(1.0, 0.0, 0.0),
        ),
        cube(
            3,
            Vec3::new(-2.0, 0.0, 1.0),
            45.0,
            2.0,
            Rgb::new(0.0, 1.0, 0.0),
        ),
    ];
    scene.extend((0..10).map(|block| {
        let (column, row) = (block % 5, block / 5);
        let location = Vec3::new(column as f32 * 2.0 - 4.0, row as f32 * 6.0 - 3.0, 0.5);
        cube(
            4 + block,
            location,
            block as f32 * 17.0,
            1.0,
            Rgb::new(0.2, 0.4, 0.1 * block as f32),
        )
    }));
    scene
}

/// Ten balls and ten cylinders that lie in all directions.
fn rounds() -> Vec<DrawnSolid> {
    let mut scene = vec![DrawnSolid::of_table(&Table::default(), 1)];
    scene.extend((0..20u32).map(|number| {
        let (column, row) = (number % 5, number / 5);
        let location = Vec3::new(column as f32 * 2.4 - 4.8, row as f32 * 2.4 - 3.6, 0.8);
        let lying = Quat::from_rotation_z(number as f32);
        DrawnSolid {
            pose: Pose::new(location, lying),
            solid: match number % 2 {
                0 => Solid::Ball(0.8),
                _ => Solid::Cylinder {
                    radius: 0.5,
                    yspan: 2.0,
                },
            },
            color: Rgb::new(0.9, 0.05 * number as f32, 0.3),
            object: 2 + number,
        }
    }));
    scene
}
