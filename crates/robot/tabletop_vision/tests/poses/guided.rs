//! Objects that joints guide.

use std::path::Path;

use bevy::math::Vec3;
use tabletop_camera::{Camera, DrawnSolid, Rasterizer, Scene};
use tabletop_core::{HeadCamera, JointKind, JointSpec, Picture, Random, Shape, Table};
use tabletop_geometry::{Pose, Rgb, turn_about};
use tabletop_scene::{IdAllocator, assemble};
use tabletop_vision::{Eyes, KnownObject, KnownScenery};

pub fn camera() -> Camera {
    Camera::of_head(&HeadCamera::default(), &Table::default())
}

pub fn picture(objects: &[(&Shape, Pose)]) -> Picture {
    let mut scene = Scene {
        solids: vec![DrawnSolid::of_table(&Table::default(), 1)],
        ..Scene::default()
    };
    for ((shape, pose), number) in objects.iter().zip(2..) {
        let solids = shape.drawn();
        let solids = solids
            .iter()
            .map(|solid| DrawnSolid::of(*pose, solid, number));
        scene.solids.extend(solids);
    }
    let mut picture = Picture::default();
    Rasterizer::alone().draw(&scene, &camera(), &mut picture);
    picture
}

fn assert_near(seen: Option<Pose>, truth: Pose, about: &str) {
    let seen = seen.unwrap();
    let way = seen.location.distance(truth.location);
    let turn = seen.rotation.angle_between(truth.rotation).to_degrees();
    assert!(way < 0.02 && turn < 1.0, "{about}: {way} units, {turn}°");
}

#[test]
fn a_lid_is_seen_along_its_box_wherever_it_stands() {
    let text = include_str!("../../../../../tablesetup/chest.xml");
    let parsed = tabletop_xml::parse(Path::new("chest"), text.as_bytes());
    let chest = assemble(&parsed.scene, &mut IdAllocator::default());
    let (objects, joint) = (&chest.objects, &chest.joints[0]);
    assert_eq!(joint.objects, ["chest-box", "chest-lid"]);
    let known: Vec<_> = objects
        .iter()
        .map(|object| KnownObject::of(&object.shape))
        .collect();
    let known = vec![
        known[0].clone(),
        known[1].clone().guided(0, joint),
        known[2].clone(),
    ];
    for seed in 0..6 {
        let mut random = Random::new(seed);
        let mut eyes = Eyes::new(known.clone(), camera(), Table::default());
        let place = Vec3::new(
            random.between((0.0, 4.0)),
            random.between((-3.5, -2.0)),
            objects[0].pose.location.z,
        );
        let yaw = random.between((-0.6, 0.6));
        let mut own = Pose::new(place, turn_about(Vec3::Z, yaw) * objects[0].pose.rotation);
        let inside = own * Pose::at(Vec3::new(0.1, 0.2, -0.2));
        // It slides open and shut by 0.4 units a picture, and the chest is pushed a little.
        for frame in 0..15_u8 {
            let open = 2.8 - (f32::from(frame) * 0.4 - 2.8).abs();
            own.location.x -= 0.02;
            let slid = Pose::at(Vec3::NEG_X * open);
            let lid = own * joint.frames[0] * slid * joint.frames[1].inverse();
            let poses = [own, lid, inside];
            let shapes = objects.iter().map(|object| &object.shape);
            let scene: Vec<_> = shapes.zip(poses).collect();
            let seen = eyes.look(&picture(&scene), &KnownScenery::default());
            let about = format!("{seed}, picture {frame}");
            assert_near(seen.objects[0].pose, own, &format!("box, {about}"));
            assert_near(seen.objects[1].pose, lid, &format!("lid, {about}"));
            if open > 2.0 {
                assert_near(seen.objects[2].pose, inside, &format!("block, {about}"));
            }
        }
    }
}

#[test]
fn a_door_is_seen_at_the_angle_of_its_hinge() {
    let block = |x: f32, y: f32, z: f32, color| Shape::Block {
        span: Vec3::new(x, y, z),
        color,
    };
    let shapes = [
        block(1.0, 1.0, 1.0, Rgb::BLUE),
        block(2.0, 0.2, 0.8, Rgb::RED),
    ];
    let joint = JointSpec {
        objects: ["post".to_owned(), "door".to_owned()],
        // X of the joint is upward.
        frames: [Vec3::new(0.6, 0.0, 0.0), Vec3::new(-1.0, 0.0, 0.0)]
            .map(|at| Pose::new(at, turn_about(Vec3::Y, -std::f32::consts::FRAC_PI_2))),
        kind: JointKind::Hinge {
            min: -1.5,
            max: 1.5,
            damping: 0.0,
        },
        collides: false,
    };
    let flap = JointSpec {
        frames: [Vec3::new(0.0, -0.5, 0.5), Vec3::new(0.0, 0.1, -0.4)].map(Pose::at),
        ..joint.clone()
    };
    for joint in [joint, flap] {
        let known = vec![
            KnownObject::of(&shapes[0]),
            KnownObject::of(&shapes[1]).guided(0, &joint),
        ];
        let mut eyes = Eyes::new(known, camera(), Table::default());
        let post = Pose::from_degrees(Vec3::new(-2.0, -2.5, 0.5), Vec3::new(0.0, 0.0, 20.0));
        for frame in 0..15_u8 {
            let angle = 1.4 - 0.2 * f32::from(frame);
            let turned = Pose::new(Vec3::ZERO, turn_about(Vec3::X, angle));
            let door = post * joint.frames[0] * turned * joint.frames[1].inverse();
            let scene = [(&shapes[0], post), (&shapes[1], door)];
            let seen = eyes.look(&picture(&scene), &KnownScenery::default());
            assert_near(seen.objects[0].pose, post, &format!("post at {angle}"));
            assert_near(seen.objects[1].pose, door, &format!("door at {angle}"));
            assert!(seen.objects[1].is_sure);
        }
    }
}
