//! Objects that must stand still.

use bevy::prelude::*;
use tabletop_core::{ObjectSpec, Part, Random, SceneItem, Shape};
use tabletop_geometry::Pose;
use tabletop_physics::PhysicsSettings;

use crate::world::*;

/// Largest displacement of the objects, in units, and their largest turn, in degrees.
fn drift(world: &TestWorld, put: &[SceneItem]) -> (f32, f32) {
    put.iter().fold((0.0f32, 0.0f32), |(far, turn), item| {
        let SceneItem::Object(spec) = item else {
            panic!("{item:?} is not an object");
        };
        let pose = world.pose(&spec.id);
        (
            far.max(pose.location.distance(spec.pose.location)),
            turn.max(pose.rotation.angle_between(spec.pose.rotation).to_degrees()),
        )
    })
}

#[test]
fn a_tower_of_ten_stands_still_for_a_minute() {
    let mut world = TestWorld::new(tower(10));
    world.seconds(60.0);
    let (far, turn) = drift(&world, &tower(10));
    assert!(far < 0.001 && turn < 0.05, "moved {far}, turned {turn}°");
}

#[test]
fn a_tower_that_may_not_sleep_stands_still_for_a_minute() {
    let settings = PhysicsSettings {
        sleep: false,
        ..default()
    };
    let mut world = TestWorld::with_settings(settings, tower(10));
    world.seconds(60.0);
    let (far, turn) = drift(&world, &tower(10));
    assert!(far < 0.002 && turn < 0.05, "moved {far}, turned {turn}°");
}

#[test]
fn crooked_towers_of_five_that_may_not_sleep_stand_still_for_a_minute() {
    let settings = PhysicsSettings {
        sleep: false,
        ..default()
    };
    let mut random = Random::new(3);
    let put: Vec<_> = (0..12)
        .flat_map(|tower| crooked_tower_of_five(&mut random, tower))
        .collect();
    let mut world = TestWorld::with_settings(settings, put.clone());
    world.seconds(60.0);
    let (far, turn) = drift(&world, &put);
    assert!(far < 0.001 && turn < 0.05, "moved {far}, turned {turn}°");
}

fn crooked_tower_of_five(random: &mut Random, number: usize) -> Vec<SceneItem> {
    let foot = Vec2::new((number % 4) as f32 - 2.0, (number / 4) as f32 - 1.0) * 3.0;
    let aside = (-0.15, 0.15);
    let storeys = (0..5).map(|storey| {
        let place = foot + Vec2::new(random.between(aside), random.between(aside));
        let place = place.extend(storey as f32 + 0.5);
        let mass = random.between((0.9, 1.3));
        let id = format!("{number}.{storey}");
        let degrees = Vec3::Z * random.between((0.0, 60.0));
        let shape = block(Vec3::ONE);
        SceneItem::Object(ObjectSpec::new(
            id,
            Pose::from_degrees(place, degrees),
            mass,
            shape,
        ))
    });
    storeys.collect()
}

#[test]
fn a_stack_of_twenty_stands_for_a_minute() {
    let mut world = TestWorld::new(tower(20));
    world.seconds(60.0);
    let (far, turn) = drift(&world, &tower(20));
    assert!(far < 0.005 && turn < 0.05, "moved {far}, turned {turn}°");
}

#[test]
fn the_heavy_stands_on_the_light() {
    for ratio in [2.0, 10.0] {
        let put = [
            object("light", Vec3::Z * 0.5, 1.0, block(Vec3::ONE)),
            object("heavy", Vec3::Z * 1.5, ratio, block(Vec3::ONE)),
        ];
        let settings = PhysicsSettings {
            sleep: false,
            ..default()
        };
        let mut world = TestWorld::with_settings(settings, put.clone());
        world.seconds(60.0);
        let (far, turn) = drift(&world, &put);
        assert!(far < 0.001 && turn < 0.05, "moved {far}, turned {turn}°");
    }
}

#[test]
fn the_two_blocks_of_the_report_stay_where_they_are_put() {
    let two = Vec3::splat(2.0);
    let mut world = TestWorld::new([
        turned("Red", (2.0, 0.0, 1.0), Vec3::Z * -15.0, 1.0, block(two)),
        turned("Green", (-2.0, 0.0, 1.0), Vec3::Z * 45.0, 1.0, block(two)),
    ]);
    world.seconds(10.0);
    for (id, x, yaw) in [("Red", 2.0, -15.0), ("Green", -2.0, 45.0)] {
        let pose = world.pose(id);
        assert!(pose.location.distance(Vec3::new(x, 0.0, 1.0)) < 0.005);
        assert!((pose.degrees() - Vec3::Z * yaw).length() < 0.05);
    }
}

#[test]
fn a_pile_of_logs_comes_to_rest() {
    let mut items = vec![
        object("left", (-2.1, 0.0, 1.5), 0.0, block((0.2, 4.0, 3.0))),
        object("right", (2.1, 0.0, 1.5), 0.0, block((0.2, 4.0, 3.0))),
    ];
    for layer in 0..3 {
        for i in 0..(4 - layer) {
            let x = i as f32 * 1.0 - 1.5 + layer as f32 * 0.5;
            let z = 0.5 + layer as f32 * 0.9;
            items.push(object(
                &format!("log{layer}_{i}"),
                (x, 0.0, z),
                1.0,
                cylinder(0.49, 3.0),
            ));
        }
    }
    let mut world = TestWorld::new(items);
    world.seconds(3.0);
    let (far, turn) = world.motion_in(1.0);
    assert!(far < 0.005 && turn < 0.5, "moved {far}, turned {turn}°");
}

#[test]
fn a_box_of_cylinders_comes_to_rest() {
    for turn in 0..4 {
        let mut items = vec![object(
            "box",
            (0.0, 0.0, 1.5),
            3.0,
            open_box((5.0, 5.0, 3.0), 0.3),
        )];
        for i in 0..12 {
            let (x, y, z) = ((i % 3) as f32, (i / 3 % 2) as f32, (i / 6) as f32);
            items.push(turned(
                &format!("cylinder{i}"),
                (x * 1.3 - 1.3, y * 1.8 - 0.9, 0.75 + z * 0.9),
                Vec3::Z * 20.0 * (i + turn) as f32,
                0.2,
                cylinder(0.4, 1.0),
            ));
        }
        let mut world = TestWorld::new(items);
        world.seconds(5.0); // They roll.
        let (far, turn) = world.motion_in(1.0);
        assert!(far < 0.005 && turn < 0.1, "moved {far}, turned {turn}°");
        for (id, pose) in world.poses() {
            let at = pose.location;
            assert!(at.abs().x < 2.5 && at.z > 0.3, "{id} is at {at}");
        }
    }
}

#[test]
fn the_hammer_of_the_report_rests_as_in_the_original() {
    let part = |pose, shape| Part {
        pointable: false,
        id: String::new(),
        pose,
        shape,
    };
    let head = Shape::Composite {
        parts: vec![
            part(Pose::IDENTITY, block(Vec3::ONE)),
            part(Pose::at(Vec3::Y * 0.9), cylinder(0.75, 0.8)),
            part(Pose::at(Vec3::Y * -0.9), cylinder(0.75, 0.8)),
        ],
    };
    let hammer = Shape::Composite {
        parts: vec![
            part(Pose::at(Vec3::X * -0.2), head),
            part(
                Pose::from_degrees(Vec3::X * 2.8, Vec3::Z * 90.0),
                cylinder(0.35, 5.0),
            ),
        ],
    };
    let mut world = TestWorld::new([turned(
        "hammer",
        (0.0, 0.0, 1.0),
        Vec3::Z * -30.0,
        10.0,
        hammer,
    )]);
    world.seconds(5.0);
    let pose = world.pose("hammer");
    let degrees = pose.degrees();
    assert!((pose.location.z - 0.733).abs() < 0.02, "{}", pose.location);
    assert!((degrees.y - 4.16).abs() < 0.5, "{degrees}");
    assert!((degrees.z + 30.0).abs() < 1.0, "{degrees}");
}
