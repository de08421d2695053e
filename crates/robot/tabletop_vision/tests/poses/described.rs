//! Unknown objects.

use bevy::math::Vec3;
use tabletop_camera::{Camera, DrawnSolid, Rasterizer, Scene};
use tabletop_core::{HeadCamera, Picture, Random, Shape, Table};
use tabletop_geometry::{Pose, Rgb, turn_about};
use tabletop_vision::Descriptions;

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

/// The picture of objects on a table.
fn picture_of(placed: &[(&Shape, Pose)], camera: &Camera, table: &Table) -> Picture {
    let mut scene = Scene {
        solids: vec![DrawnSolid::of_table(table, 1)],
        ..Scene::default()
    };
    for ((shape, pose), number) in placed.iter().zip(2..) {
        let solids = shape.drawn();
        let solids = solids.iter();
        let solids = solids.map(|solid| DrawnSolid::of(*pose, solid, number));
        scene.solids.extend(solids);
    }
    let mut picture = Picture::default();
    Rasterizer::alone().draw(&scene, camera, &mut picture);
    picture
}

#[test]
fn what_is_hidden_at_first_is_described_when_it_is_seen() {
    let (table, head) = (Table::default(), HeadCamera::default());
    let camera = Camera::of_head(&head, &table);
    let block = |span: Vec3, color: Rgb| Shape::Block { span, color };
    let front = block(Vec3::new(1.6, 0.8, 2.2), Rgb::BLUE);
    let behind = block(Vec3::new(1.4, 1.0, 1.0), Rgb::RED);
    let [near, aside, far] = [(0.0, -3.8, 1.1), (4.0, -3.0, 1.1), (0.3, -2.8, 0.5)]
        .map(|(x, y, z)| Pose::at(Vec3::new(x, y, z)));
    let first = picture_of(&[(&front, near), (&behind, far)], &camera, &table);
    let then = picture_of(&[(&front, aside), (&behind, far)], &camera, &table);
    let mut descriptions = Descriptions::of(&first, &camera, &table);
    let red = |descriptions: &Descriptions| {
        let mut objects = descriptions.objects();
        let is_red = |shape: &Shape| shape.drawn()[0].color.red > 0.5;
        objects.find(|it| is_red(&it.shape)).unwrap().clone()
    };
    let half_seen = red(&descriptions);
    assert!(
        half_seen.pose.location.distance(far.location) > 0.1,
        "{half_seen:?}"
    );
    descriptions.see(&then);
    assert_eq!(descriptions.objects().count(), 2);
    let found = red(&descriptions);
    assert!(
        found.pose.location.distance(far.location) < 0.03,
        "{found:?}"
    );
    for (own, truth) in sizes(&found.shape).into_iter().zip(sizes(&behind)) {
        assert!((own - truth).abs() < 0.05, "{found:?}");
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
        let picture = picture_of(&placed, &camera, &table);
        let found = Descriptions::of(&picture, &camera, &table);
        let found: Vec<_> = found.objects().collect();
        assert_eq!(found.len(), 3, "{seed}: {found:?}");
        for (shape, pose) in placed {
            let near = found.iter().copied().min_by(|one, other| {
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
