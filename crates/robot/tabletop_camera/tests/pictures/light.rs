//! Other light: brighter or darker, from one side, warm.

use bevy::math::Vec3;
use tabletop_camera::{Camera, DrawnFigure, Facets, Rasterizer, Scene};
use tabletop_core::{LIGHT, Light, Picture};
use tabletop_geometry::{Pose, Rgb, Triangles};

use crate::scenes::{default_scene, draw_scene, head, mixed_scene, of_solids, smooth};

fn in_light(light: Light) -> Camera {
    Camera {
        light,
        ..smooth(head())
    }
}

/// The mixed scene with a marker and a figure.
fn scene() -> Scene {
    let figure = Triangles {
        positions: vec![Vec3::ZERO, Vec3::X * 3.0, Vec3::Y * 3.0],
        normals: vec![Vec3::Z, Vec3::X, Vec3::Y],
        colors: vec![Rgb::GRAY; 3],
        indices: vec![[0, 1, 2]],
    };
    Scene {
        figures: vec![DrawnFigure {
            pose: Pose::at(Vec3::new(-1.0, 0.0, 4.0)),
            facets: Facets::from(&figure).into(),
            object: 99,
        }],
        markers: vec![Vec3::new(0.0, -2.0, 2.0)],
        ..of_solids(&mixed_scene())
    }
}

fn warm_from_the_right() -> Light {
    Light {
        along: LIGHT.along.with_x(1.0),
        against: LIGHT.against.with_x(0.4),
        color: Vec3::new(1.1, 0.9, 0.7),
    }
}

#[test]
fn colours_are_those_of_the_light_and_nothing_is_brighter_than_white() {
    let scene = of_solids(&default_scene());
    let usual = draw_scene(&scene, &in_light(LIGHT));
    let color = Vec3::new(1.1, 0.8, 0.6);
    let warm = draw_scene(&scene, &in_light(Light { color, ..LIGHT }));
    let at = |picture: &Picture, pixel: usize| picture.rgb[3 * pixel..3 * pixel + 3].to_vec();
    // The white table, which faces up, away from its edges.
    let table = (0..usual.objects.len())
        .find(|&pixel| usual.objects[pixel] == 1 && at(&usual, pixel) == [255, 255, 255])
        .unwrap();
    assert_eq!(at(&warm, table), [255, 204, 153]);
    assert_eq!((usual.depth, usual.objects), (warm.depth, warm.objects));
}

#[test]
fn a_picture_does_not_depend_on_earlier_ones() {
    let scene = scene();
    let mut rasterizer = Rasterizer::default();
    let mut picture = Picture::default();
    for light in [LIGHT, warm_from_the_right(), LIGHT] {
        let alone = draw_scene(&scene, &in_light(light));
        // The third picture is copied from the second one.
        for _ in 0..3 {
            rasterizer.draw(&scene, &in_light(light), &mut picture);
            assert!(picture == alone, "{light:?}");
        }
    }
    let other = draw_scene(&scene, &in_light(warm_from_the_right()));
    let differing = picture.rgb.iter().zip(&other.rgb);
    let differing = differing.filter(|(one, other)| one != other).count();
    assert!(differing > picture.rgb.len() / 3, "{differing}");
}
