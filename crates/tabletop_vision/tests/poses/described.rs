//! Unknown objects.

use bevy::math::Vec3;
use tabletop_camera::{Camera, DrawnSolid, Rasterizer, Scene};
use tabletop_core::{HeadCamera, Picture, Random, Shape, Table};
use tabletop_geometry::{Pose, Rgb, turn_about};
use tabletop_vision::described;

/// Width, depth and height of a shape on the table, the longer side first.
#[expect(clippy::wildcard_enum_match_arm, reason = "no other is described")]
fn sizes(shape: &Shape) -> [f32; 3] {
    match shape {
        Shape::Block { span, .. } => [span.x.max(span.y), span.x.min(span.y), span.z],
        Shape::Cylinder { radius, yspan, .. } => [2.0 * radius, 2.0 * radius, *yspan],
        Shape::Sphere { radius, .. } => [2.0 * radius; 3],
        other => panic!("{other:?}"),
    }
}

#[test]
fn blocks_cylinders_and_spheres_are_described_by_their_silhouettes() {
    let (table, head) = (Table::default(), HeadCamera::default());
    let camera = Camera::of_head(&head, &table);
    for seed in 0..6 {
        let mut random = Random::new(seed);
        let mut any = |least: f32, most: f32| random.between((least, most));
        let block = Shape::Block {
            span: Vec3::new(any(0.8, 2.0), any(0.6, 1.2), any(0.5, 1.5)),
            color: Rgb::RED,
        };
        let cylinder = Shape::Cylinder {
            radius: any(0.4, 0.9),
            yspan: any(0.5, 1.5),
            color: Rgb::new(0.1, 0.7, 0.2),
        };
        let sphere = Shape::Sphere {
            radius: any(0.4, 0.7),
            color: Rgb::BLUE,
        };
        let yaw = turn_about(Vec3::Z, any(0.0, 3.0));
        let upright = turn_about(Vec3::X, std::f32::consts::FRAC_PI_2);
        let [_, _, height] = sizes(&block);
        let placed = [
            (
                &block,
                Pose::new(
                    Vec3::new(any(-4.0, -2.0), any(-4.0, -1.0), height / 2.0),
                    yaw,
                ),
            ),
            (
                &cylinder,
                Pose::new(
                    Vec3::new(any(-0.5, 0.5), any(-4.0, -1.0), sizes(&cylinder)[2] / 2.0),
                    upright,
                ),
            ),
            (
                &sphere,
                Pose::at(Vec3::new(
                    any(2.0, 4.0),
                    any(-4.0, -1.0),
                    sizes(&sphere)[2] / 2.0,
                )),
            ),
        ];
        let mut scene = Scene {
            solids: vec![DrawnSolid::of_table(&table, 1)],
            ..Scene::default()
        };
        for ((shape, pose), number) in placed.iter().zip(2..) {
            let solids = shape.drawn();
            let solids = solids
                .iter()
                .map(|solid| DrawnSolid::of(*pose, solid, number));
            scene.solids.extend(solids);
        }
        let mut picture = Picture::default();
        Rasterizer::alone().draw(&scene, &camera, &mut picture);
        let found = described(&picture, &camera, &table);
        assert_eq!(found.len(), 3, "{seed}: {found:?}");
        for (shape, pose) in placed {
            let near = found.iter().min_by(|one, other| {
                let [one, other] = [one, other].map(|it| it.pose.location.distance(pose.location));
                one.total_cmp(&other)
            });
            let near = near.unwrap();
            let about = format!("{seed}: {shape:?} at {pose:?} is {near:?}");
            let is_alike = std::mem::discriminant(&near.shape) == std::mem::discriminant(shape);
            assert!(is_alike, "{about}");
            assert!(near.pose.location.distance(pose.location) < 0.03, "{about}");
            for (own, truth) in sizes(&near.shape).into_iter().zip(sizes(shape)) {
                assert!((own - truth).abs() < 0.05, "{about}");
            }
            let [own, truth] = [&near.shape, shape].map(|shape| shape.drawn()[0].color);
            let parts = [
                own.red - truth.red,
                own.green - truth.green,
                own.blue - truth.blue,
            ];
            assert!(parts.iter().all(|part| part.abs() < 0.04), "{about}");
        }
    }
}
