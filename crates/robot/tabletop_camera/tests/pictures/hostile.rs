//! Hostile numbers: a picture is always drawn.

use bevy::math::{Quat, Vec3};
use proptest::prelude::*;
use tabletop_camera::{Camera, DrawnSolid, Rasterizer};
use tabletop_core::{LIGHT, Picture};
use tabletop_geometry::{Pose, Rgb, Solid};

use crate::scenes::{draw, head, mixed_scene, of_solids, smooth};

fn any_number() -> impl Strategy<Value = f32> {
    prop_oneof![
        4 => -10.0..10.0_f32,
        1 => any::<f32>(),
        1 => prop::sample::select(vec![
            0.0, -0.0, 1e-30, 1e-6, 1e6, 1e15, 1e38, f32::MAX, f32::INFINITY, f32::NEG_INFINITY, f32::NAN,
        ]),
    ]
}

fn any_vector() -> impl Strategy<Value = Vec3> {
    [any_number(), any_number(), any_number()].prop_map(Vec3::from)
}

fn any_pose() -> impl Strategy<Value = Pose> {
    let turned = any_vector().prop_map(|axis| Quat::from_scaled_axis(axis.normalize_or_zero()));
    let rotation = prop_oneof![
        6 => turned,
        1 => [any_number(), any_number(), any_number(), any_number()].prop_map(Quat::from_array),
    ];
    (any_vector(), rotation).prop_map(|(location, rotation)| Pose::new(location, rotation))
}

fn any_solid() -> impl Strategy<Value = Solid> {
    prop_oneof![
        any_vector().prop_map(Solid::Cuboid),
        any_number().prop_map(Solid::Ball),
        (any_number(), any_number()).prop_map(|(radius, yspan)| Solid::Cylinder { radius, yspan }),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn every_pixel_has_a_value(
        solids in prop::collection::vec((any_pose(), any_solid(), any_vector()), 0..6),
        pose in any_pose(),
        fov in any_number(),
        (square_fov, antialiasing) in (any::<bool>(), any::<bool>()),
        (width, height) in prop_oneof![9 => (0..40_u32, 0..40_u32), 1 => (0..301_u32, 0..201_u32)],
    ) {
        let scene: Vec<_> = (1..)
            .zip(&solids)
            .map(|(object, &(pose, ref solid, color))| DrawnSolid {
                pose,
                solid: solid.clone(),
                color: Rgb::new(color.x, color.y, color.z),
                object,
            })
            .collect();
        let camera = Camera { pose, vertical_fov: fov, square_fov, width, height, antialiasing, light: LIGHT };
        let picture = draw(&scene, &camera);
        let pixels = width as usize * height as usize;
        prop_assert_eq!(picture.rgb.len(), 3 * pixels);
        prop_assert_eq!(picture.depth.len(), pixels);
        prop_assert_eq!(picture.objects.len(), pixels);
        for (&depth, &object) in picture.depth.iter().zip(&picture.objects) {
            prop_assert!(depth > 0.0, "depth {depth} of object {object}");
            prop_assert_eq!(depth.is_infinite(), object == 0);
            prop_assert!(object as usize <= scene.len());
        }
    }
}

#[test]
fn a_rasterizer_forgets_the_picture_before() {
    let (mut rasterizer, mut picture) = (Rasterizer::default(), Picture::default());
    let cameras = [
        smooth(head()),
        Camera {
            width: 64,
            height: 300,
            ..head()
        },
        Camera { width: 0, ..head() },
        head(),
    ];
    for camera in cameras {
        for scene in [mixed_scene(), Vec::new(), mixed_scene()] {
            rasterizer.draw(&of_solids(&scene), &camera, &mut picture);
            assert!(picture == draw(&scene, &camera), "{camera:?}");
        }
    }
}
