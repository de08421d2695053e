//! Scenes that the benchmark draws.

use std::{f32::consts::TAU, sync::Arc};

use bevy::math::{Quat, Vec3};
use tabletop_camera::{DrawnFigure, DrawnSolid, Facets};
use tabletop_core::Table;
use tabletop_geometry::{Pose, Rgb, Solid, Triangles};

/// The blocks of `tablesetup/default.xml`, and ten more around them.
pub fn blocks() -> Vec<DrawnSolid> {
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
pub fn rounds() -> Vec<DrawnSolid> {
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

/// Two arms of twelve links that hang over the near half of the table.
pub fn arms() -> Vec<DrawnFigure> {
    let facets = Arc::new(Facets::from(&drum()));
    let links = [-1.0, 1.0].into_iter().flat_map(|side: f32| {
        (0..12u16).map(move |link| {
            let along = f32::from(link) / 12.0;
            let location = Vec3::new(
                side * (5.0 - 3.0 * along),
                -7.0 + 6.0 * along,
                5.0 - 3.0 * along,
            );
            Pose::new(location, Quat::from_rotation_y(side * f32::from(link)))
        })
    });
    (20..)
        .zip(links)
        .map(|(object, pose)| DrawnFigure {
            pose,
            facets: Arc::clone(&facets),
            object,
        })
        .collect()
}

/// A drum of 100 triangles: five rings of ten corners.
fn drum() -> Triangles {
    const CORNERS: u32 = 10;
    let mut drum = Triangles::default();
    for ring in 0..5u16 {
        let height = f32::from(ring) * 0.25 - 0.5;
        for corner in 0..CORNERS {
            let turned = Quat::from_rotation_z(TAU * corner as f32 / CORNERS as f32) * Vec3::X;
            drum.positions.push(turned * 0.6 + Vec3::Z * height);
            drum.normals.push(turned);
        }
    }
    for ring in 0..4 {
        for corner in 0..CORNERS {
            let [a, b] = [corner, (corner + 1) % CORNERS].map(|i| ring * CORNERS + i);
            let [c, d] = [a + CORNERS, b + CORNERS];
            drum.indices.extend([[a, b, d], [a, d, c]]);
        }
    }
    for (ring, normal) in [(0, Vec3::NEG_Z), (4, Vec3::Z)] {
        let first = drum.positions.len() as u32;
        for corner in 0..CORNERS {
            drum.positions
                .push(drum.positions[(ring * CORNERS + corner) as usize]);
            drum.normals.push(normal);
        }
        drum.indices.extend((2..CORNERS).map(|i| match ring {
            0 => [first, first + i, first + i - 1],
            _ => [first, first + i - 1, first + i],
        }));
    }
    drum.colors = vec![Rgb::new(0.7, 0.1, 0.1); drum.positions.len()];
    drum
}
