//! Depths and object numbers, compared with rays that are intersected with the solids one by one.

use bevy::{math::Vec3, prelude::*};
use proptest::prelude::*;
use tabletop_camera::{Camera, DrawnSolid};
use tabletop_core::{LIGHT, Picture};
use tabletop_geometry::{Pose, Primitive, Rgb, Solid};

use crate::scenes::{draw, head, level, mixed_scene, smooth, solid};

/// Nearest visible depth.
const NEAR: f32 = 0.01;

/// Depth and number of the surface at a point of the picture.
fn met(scene: &[DrawnSolid], camera: &Camera, x: f32, y: f32) -> Option<(f32, u32)> {
    let (width, height) = (camera.width as f32, camera.height as f32);
    let pixel = 2.0 * (camera.vertical_fov / 2.0).tan() / height;
    let across = if camera.square_fov {
        height / width
    } else {
        1.0
    };
    let local = Vec3::new(
        (x + 0.5 - width / 2.0) * pixel * across,
        (height / 2.0 - y - 0.5) * pixel,
        -1.0,
    );
    let ray = Ray3d {
        origin: camera.pose.location,
        direction: Dir3::new(camera.pose.rotation * local).expect("a direction"),
    };
    scene
        .iter()
        .filter_map(|drawn| {
            let primitive = Primitive {
                pose: Pose::IDENTITY,
                solid: drawn.solid.clone(),
                color: drawn.color,
            };
            let depth = primitive.distance_along(ray, drawn.pose)? / local.length();
            (depth >= NEAR).then_some((depth, drawn.object))
        })
        .min_by(|a, b| a.0.total_cmp(&b.0))
}

/// The surface at the centre of a pixel, if the same one is seen a little beside it at a similar depth.
fn met_for_sure(
    scene: &[DrawnSolid],
    camera: &Camera,
    column: u32,
    row: u32,
) -> Option<Option<(f32, u32)>> {
    const BESIDE: f32 = 0.02;
    let at = |x, y| met(scene, camera, column as f32 + x, row as f32 + y);
    let center = at(0.0, 0.0);
    let is_same = |other: Option<(f32, u32)>| match (center, other) {
        (Some((near, one)), Some((far, other))) => one == other && (near - far).abs() < 0.05 * near,
        (None, None) => true,
        _ => false,
    };
    [(BESIDE, 0.0), (-BESIDE, 0.0), (0.0, BESIDE), (0.0, -BESIDE)]
        .into_iter()
        .all(|(x, y)| is_same(at(x, y)))
        .then_some(center)
}

/// Compares every pixel whose surface is certain, and returns the number of these pixels.
fn assert_seen(scene: &[DrawnSolid], camera: &Camera, picture: &Picture) -> usize {
    let mut sure = 0;
    for row in 0..camera.height {
        for column in 0..camera.width {
            let Some(expected) = met_for_sure(scene, camera, column, row) else {
                continue;
            };
            sure += 1;
            let (depth, object) = expected.unwrap_or((f32::INFINITY, 0));
            let index = picture.index(column, row).expect("a pixel");
            let (own_depth, own_object) = (picture.depth[index], picture.objects[index]);
            assert_eq!(
                own_object, object,
                "({column}, {row}) of {camera:?} at {depth}"
            );
            assert!(
                own_depth == depth || (own_depth - depth).abs() < 2e-3 * depth,
                "{own_depth} for {depth} at ({column}, {row})"
            );
        }
    }
    sure
}

#[test]
fn every_pixel_shows_the_first_solid_on_its_ray() {
    let scene = mixed_scene();
    let views = [
        head(),
        Camera {
            square_fov: true,
            ..head()
        },
        Camera {
            width: 320,
            height: 90,
            ..head()
        },
        level(Vec3::new(-0.5, -7.0, 0.4), 160, 120),
        Camera {
            pose: Pose::at(Vec3::Z * 14.0),
            ..head()
        },
        Camera {
            pose: Pose::at(Vec3::new(2.0, 0.0, 5.0)),
            ..head()
        },
    ];
    for camera in views {
        let picture = draw(&scene, &camera);
        let sure = assert_seen(&scene, &camera, &picture);
        let pixels = picture.objects.len();
        assert!(sure > pixels * 9 / 10, "{sure} of {pixels}");
        assert!(picture.objects.iter().filter(|&&object| object > 1).count() > pixels / 50);
    }
}

#[test]
fn the_depth_of_the_table_lies_on_its_plane() {
    let camera = head();
    let picture = draw(&mixed_scene()[..1], &camera);
    // Straight ahead the view meets Z = 0 after 11.5921 / 0.82956 units.
    let [upper, lower] = [74, 75].map(|row| picture.depth[picture.index(100, row).unwrap()]);
    let ahead = 11.5921 / 0.82956;
    assert!(upper > ahead && ahead > lower, "{upper} {lower}");
    assert!((upper + lower) / 2.0 - ahead < 2e-3);
    assert_eq!(picture.depth[0], f32::INFINITY);
}

#[test]
fn smooth_edges_change_neither_depths_nor_numbers() {
    let (plain, smooth) = (
        draw(&mixed_scene(), &head()),
        draw(&mixed_scene(), &smooth(head())),
    );
    assert_eq!(plain.objects, smooth.objects);
    assert_eq!(plain.depth, smooth.depth);
    assert_ne!(plain.rgb, smooth.rgb);
}

#[test]
fn from_inside_a_solid_is_not_seen() {
    let wall = solid(
        1,
        [0.0, 5.0, 0.0],
        Solid::Cuboid(Vec3::new(50.0, 1.0, 50.0)),
        Rgb::WHITE,
    );
    for around in [
        Solid::Cuboid(Vec3::splat(2.0)),
        Solid::Ball(1.0),
        Solid::Cylinder {
            radius: 1.0,
            yspan: 3.0,
        },
    ] {
        for location in [Vec3::ZERO, Vec3::new(0.3, -0.4, 0.2)] {
            let scene = [wall.clone(), solid(2, location, around.clone(), Rgb::WHITE)];
            let picture = draw(&scene, &level(Vec3::ZERO, 40, 30));
            assert_eq!(picture.objects, [1; 1200], "{around:?}");
        }
    }
}

#[test]
fn solids_nearer_than_the_near_plane_are_not_seen() {
    let wall = solid(
        1,
        [0.0, 5.0, 0.0],
        Solid::Cuboid(Vec3::new(50.0, 1.0, 50.0)),
        Rgb::WHITE,
    );
    for (shape, half) in [
        (Solid::Cuboid(Vec3::splat(2.0)), 1.0),
        (Solid::Ball(100.0), 100.0),
    ] {
        for (gap, seen) in [(0.008, 1), (0.012, 2)] {
            let near = solid(2, [0.0, half + gap, 0.0], shape.clone(), Rgb::WHITE);
            let scene = [wall.clone(), near];
            let picture = draw(&scene, &level(Vec3::ZERO, 40, 30));
            assert_eq!(picture.objects, [seen; 1200], "{shape:?} at {gap}");
        }
    }
}

#[test]
fn solids_behind_the_camera_are_not_seen() {
    for shape in [
        Solid::Cuboid(Vec3::splat(2.0)),
        Solid::Ball(1.0),
        Solid::Cylinder {
            radius: 1.0,
            yspan: 2.0,
        },
    ] {
        for location in [[0.0, -2.0, 0.0], [0.9, -3.0, 0.9], [0.0, -1.001, 0.0]] {
            let picture = draw(
                &[solid(1, location, shape.clone(), Rgb::WHITE)],
                &level(Vec3::ZERO, 40, 30),
            );
            assert_eq!(picture.objects, [0; 1200], "{shape:?} at {location:?}");
        }
    }
}

#[test]
fn a_long_solid_that_passes_the_eye_is_cut_off_at_it() {
    for shape in [
        Solid::Cuboid(Vec3::new(0.3, 40.0, 0.3)),
        Solid::Cylinder {
            radius: 0.15,
            yspan: 40.0,
        },
    ] {
        let scene = [solid(1, [0.2, 0.0, -0.4], shape, Rgb::WHITE)];
        let camera = level(Vec3::ZERO, 120, 90);
        let picture = draw(&scene, &camera);
        assert!(assert_seen(&scene, &camera, &picture) > 120 * 90 * 9 / 10);
        // It leaves the picture at its lower edge, where it is near.
        let lowest = &picture.objects[120 * 89..];
        assert!(lowest.iter().filter(|&&object| object == 1).count() > 5);
    }
}

#[test]
fn of_equal_surfaces_the_first_is_seen() {
    let cube = Solid::Cuboid(Vec3::ONE);
    let twice = [1, 2].map(|number| solid(number, [0.0, 5.0, 0.0], cube.clone(), Rgb::WHITE));
    let picture = draw(&twice, &level(Vec3::ZERO, 41, 31));
    assert!(picture.objects.contains(&1));
    assert!(!picture.objects.contains(&2));
}

fn some_solid() -> impl Strategy<Value = Solid> {
    let size = 0.05..4.0_f32;
    prop_oneof![
        (size.clone(), size.clone(), size.clone()).prop_map(|span| Solid::Cuboid(span.into())),
        size.clone().prop_map(Solid::Ball),
        (size.clone(), size).prop_map(|(radius, yspan)| Solid::Cylinder { radius, yspan }),
    ]
}

fn somewhere() -> impl Strategy<Value = Pose> {
    let axis = || -6.0..6.0_f32;
    let turn = || -180.0..180.0_f32;
    ((axis(), axis(), axis()), (turn(), turn(), turn()))
        .prop_map(|(location, degrees)| Pose::from_degrees(location.into(), Vec3::from(degrees)))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn any_scene_is_seen_as_its_rays_meet_it(
        solids in prop::collection::vec((somewhere(), some_solid()), 1..8),
        pose in somewhere(),
        fov in 0.2..2.6_f32,
        square_fov: bool,
        (width, height) in (1..60_u32, 1..60_u32),
    ) {
        let scene: Vec<_> = (1..)
            .zip(solids)
            .map(|(object, (pose, solid))| DrawnSolid { pose, solid, color: Rgb::GRAY, object })
            .collect();
        let camera = Camera { pose, vertical_fov: fov, square_fov, width, height, antialiasing: false, light: LIGHT };
        assert_seen(&scene, &camera, &draw(&scene, &camera));
    }
}
