//! Smooth edges.

use bevy::math::Vec3;
use tabletop_core::Picture;
use tabletop_geometry::{Rgb, Solid};

use crate::scenes::{draw, head, level, mixed_scene, smooth, solid};

/// A wall that fills the picture to the right of, or above, a line through the middle of it. Its near face shows 80 % of white.
fn wall_beyond_middle(direction: Vec3, shift: f32) -> Picture {
    let camera = smooth(level(Vec3::new(0.0, -20.0, 0.0), 21, 21));
    // At a distance of 10 units from the eye.
    let pixel = 2.0 * 30_f32.to_radians().tan() * 10.0 / 21.0;
    let location = Vec3::new(0.0, -10.0, 0.0) + direction * (50.0 + shift * pixel);
    let wall = Solid::Cuboid(Vec3::new(100.0, 1e-4, 100.0));
    draw(&[solid(1, location, wall, Rgb::WHITE)], &camera)
}

#[test]
fn an_edge_pixel_is_mixed_by_the_covered_part_of_its_samples() {
    for direction in [Vec3::X, Vec3::Z] {
        for (shift, covered) in [(-0.45, 4), (-0.25, 3), (0.0, 2), (0.25, 1), (0.45, 0)] {
            let picture = wall_beyond_middle(direction, shift);
            let shown = (204.0 * covered as f32 / 4.0).round() as u8;
            assert_eq!(
                picture.color(10, 10),
                Some([shown; 3]),
                "{direction} {shift}"
            );
            let beyond = if direction == Vec3::X {
                (11, 10)
            } else {
                (10, 9)
            };
            assert_eq!(picture.color(beyond.0, beyond.1), Some([204; 3]));
            let before = if direction == Vec3::X {
                (9, 10)
            } else {
                (10, 11)
            };
            assert_eq!(picture.color(before.0, before.1), Some([0; 3]));
        }
    }
}

#[test]
fn away_from_edges_nothing_changes() {
    let (plain, smooth) = (
        draw(&mixed_scene(), &head()),
        draw(&mixed_scene(), &smooth(head())),
    );
    let (mut flat, mut mixed) = (0, 0);
    for row in 1..plain.height - 1 {
        for column in 1..plain.width - 1 {
            let around = (0..9).map(|place| (column + place % 3 - 1, row + place / 3 - 1));
            let colors = around.clone().map(|(x, y)| plain.color(x, y).unwrap()[0]);
            let (least, most) = colors.fold((255, 0), |(a, b), c| (a.min(c), b.max(c)));
            let object = |(x, y)| plain.objects[plain.index(x, y).unwrap()];
            let is_one_object = around
                .map(object)
                .all(|other| other == object((column, row)));
            let (before, after) = (plain.color(column, row), smooth.color(column, row));
            if is_one_object && most - least <= 2 {
                flat += 1;
                assert_eq!(before, after, "at ({column}, {row})");
            } else {
                mixed += u32::from(before != after);
            }
        }
    }
    assert!(flat > 20_000 && mixed > 500, "{flat} {mixed}");
}
