//! Pictures are the same to the last bit, however many threads draw them.

use std::sync::Arc;

use bevy::{
    math::Vec3,
    tasks::{ComputeTaskPool, TaskPoolBuilder},
};
use tabletop_camera::{Camera, DrawnFigure, DrawnSolid, Facets, Rasterizer, Scene};
use tabletop_core::{HeadCamera, Picture, Table};
use tabletop_geometry::{Pose, Rgb, Solid, Triangles};

#[test]
fn threads_do_not_change_a_picture() {
    assert!(ComputeTaskPool::try_get().is_none());
    let alone = pictures();
    ComputeTaskPool::get_or_init(|| TaskPoolBuilder::new().num_threads(3).build());
    assert_eq!(pictures(), alone);
    assert!(alone.iter().any(|picture| picture.objects.contains(&3)));
}

fn pictures() -> Vec<Picture> {
    let mut rasterizer = Rasterizer::default();
    let mut draw = |(width, height), antialiasing| {
        let head = HeadCamera {
            width,
            height,
            antialiasing,
            ..HeadCamera::default()
        };
        let mut picture = Picture::default();
        rasterizer.draw(
            &scene(),
            &Camera::of_head(&head, &Table::default()),
            &mut picture,
        );
        picture
    };
    [(200, 150), (1, 1), (33, 17), (0, 5), (64, 16)]
        .into_iter()
        .flat_map(|size| [draw(size, false), draw(size, true)])
        .collect()
}

/// A table, a ball, a large triangle that stands across the picture, and a marker.
fn scene() -> Scene {
    let triangle = Triangles {
        positions: vec![
            Vec3::new(-5.0, 3.0, 0.0),
            Vec3::new(5.0, 3.0, 0.0),
            Vec3::new(0.0, 4.0, 6.0),
        ],
        normals: vec![Vec3::NEG_Y; 3],
        colors: vec![Rgb::new(0.2, 0.7, 0.4); 3],
        indices: vec![[0, 1, 2]],
    };
    Scene {
        solids: vec![
            DrawnSolid::of_table(&Table::default(), 1),
            DrawnSolid {
                pose: Pose::at(Vec3::new(1.0, 0.0, 1.0)),
                solid: Solid::Ball(1.0),
                color: Rgb::new(0.9, 0.1, 0.1),
                object: 2,
            },
        ],
        figures: vec![DrawnFigure {
            pose: Pose::IDENTITY,
            facets: Arc::new(Facets::from(&triangle)),
            object: 3,
        }],
        markers: vec![Vec3::new(-1.0, -1.0, 1.0)],
    }
}
