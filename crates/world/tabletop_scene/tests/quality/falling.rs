//! Falling objects.

use bevy::prelude::*;
use bevy_rapier3d::prelude::Velocity;
use tabletop_core::{Hand, Manipulator, SceneItem, Shape, StepApp as _};
use tabletop_geometry::Pose;
use tabletop_physics::hold;

use crate::world::*;

#[test]
fn a_ball_falls_as_fast_as_the_formula_says() {
    let mut world = TestWorld::new([object("ball", (0.0, 0.0, 60.0), 1.0, sphere(0.5))]);
    let expected = (2.0 * (60.0 - 0.5) / 98.1f32).sqrt();
    let mut ticks = 1;
    while world.pose("ball").location.z > 0.52 {
        world.0.step(1);
        ticks += 1;
    }
    let landed = ticks as f32 / 60.0;
    // One tick is 1.5 % of this fall, so look at the height one tick before as well.
    assert!(
        (landed - expected).abs() < 1.0 / 60.0 + 0.01 * expected,
        "landed after {landed} s, not {expected} s"
    );
    world.seconds(2.0);
    assert!((world.pose("ball").location.z - 0.5).abs() < 0.01);
}

#[test]
fn a_falling_ball_is_where_the_formula_says() {
    let mut world = TestWorld::new([object("ball", (0.0, 0.0, 60.0), 1.0, sphere(0.5))]);
    world.seconds(59.0 / 60.0);
    let fallen = 60.0 - world.pose("ball").location.z;
    assert!(
        (fallen / (98.1 / 2.0) - 1.0).abs() < 0.01,
        "{fallen} units in 1 s"
    );
}

/// Small things, dropped from a height of 100 units along the line of this `y`.
fn dropped(y: f32, z: f32, turn: usize) -> Vec<SceneItem> {
    let turn = turn as f32;
    let degrees = Vec3::new(10.0 * turn, 13.0 * turn + 20.0, 30.0 * turn);
    [
        block(Vec3::splat(0.1)),
        sphere(0.05),
        cylinder(0.05, 1.0),
        block((1.0, 1.0, 0.05)),
        open_box((1.0, 1.0, 1.0), 0.05),
        block(Vec3::ONE),
    ]
    .into_iter()
    .enumerate()
    .map(|(i, shape)| {
        let location = Vec3::new(i as f32 * 3.0 - 7.5, y, z);
        turned(
            &format!("{}{i}", shape.name()),
            location,
            degrees,
            1.0,
            shape,
        )
    })
    .collect()
}

/// Asserts that no object passes through this height within the table's edges during these seconds; objects
/// thrown over the edge may fall.
fn nothing_passes(world: &mut TestWorld, height: f32, seconds: f32) {
    let mut over_the_edge = std::collections::BTreeSet::new();
    for _ in 0..(seconds * 60.0) as usize {
        world.0.step(1);
        for (id, pose) in world.poses() {
            let at = pose.location;
            if at.x.abs() > 9.0 || at.y.abs() > 5.0 {
                over_the_edge.insert(id);
            } else if !over_the_edge.contains(&id) {
                assert!(at.z > height, "{id} went through at {at}");
            }
        }
    }
    assert!(over_the_edge.len() < 6, "{over_the_edge:?} left the table");
}

#[test]
fn nothing_tunnels_through_the_table() {
    for turn in 0..6 {
        let mut world = TestWorld::new(dropped(0.0, 100.0, turn));
        nothing_passes(&mut world, 0.0, 3.0);
    }
}

#[test]
fn nothing_tunnels_through_a_thin_plate() {
    for turn in 0..6 {
        let plate = object("plate", (0.0, 0.0, 5.0), 0.0, block((20.0, 12.0, 0.05)));
        let mut world = TestWorld::new(dropped(0.0, 105.0, turn).into_iter().chain([plate]));
        nothing_passes(&mut world, 4.95, 3.0);
    }
}

#[test]
fn nothing_tunnels_through_the_floor_of_a_thin_box() {
    let mut world = TestWorld::new([
        object("box", (0.0, 0.0, 1.5), 0.0, open_box((5.0, 5.0, 3.0), 0.05)),
        object("ball", (0.0, 0.0, 100.0), 1.0, sphere(0.2)),
    ]);
    let floor_top = 0.05;
    world.seconds(4.0);
    let ball = world.pose("ball").location;
    assert!((ball.z - 0.2 - floor_top).abs() < 0.02, "{ball}");
}

#[test]
fn a_sleeping_object_that_is_hit_stays_out_of_the_table() {
    for mass in [1.0, 3.0] {
        let plate = block((2.0, 2.0, 1.0));
        let mut world = TestWorld::new([
            object("low", Vec3::Z * 0.75, 1.0, block(Vec3::splat(1.5))),
            turned(
                "plate",
                Vec3::new(6.0, 0.0, 0.5),
                Vec3::Z * 20.0,
                mass,
                plate,
            ),
        ]);
        world.seconds(4.0);
        let plate = world.entity("plate");
        let mut place = world.0.world_mut().get_mut::<Transform>(plate).unwrap();
        place.translation = Vec3::new(0.1, 0.05, 9.0);
        for tick in 0..60 {
            world.0.step(1);
            let low = world.pose("low").location.z;
            assert!(low > 0.73, "{low} in tick {tick}, hit by {mass} kg");
        }
    }
}

/// Height, in units, of the lowest point of a box at a pose.
fn lowest_point(span: Vec3, pose: Pose) -> f32 {
    let up = pose.rotation.inverse() * Vec3::Z;
    pose.location.z - up.abs().dot(span / 2.0)
}

#[test]
fn a_blow_presses_nothing_light_into_the_table() {
    let half = Vec3::new(0.65, 0.98, 0.9);
    for number in 0..60 {
        let aside = Vec2::from_angle(number as f32) * 0.02 * number as f32;
        let mut world = TestWorld::new([
            object("light", Vec3::Z * half.z, 0.22, block(2.0 * half)),
            turned(
                "heavy",
                aside.extend(10.0),
                Vec3::new(45.0, 35.0, 10.0 * number as f32),
                1.0,
                block(Vec3::splat(1.5)),
            ),
        ]);
        for tick in 0..90 {
            world.0.step(1);
            let light = world.pose("light");
            let lowest = lowest_point(2.0 * half, light);
            let is_on_table = light.location.xy().abs().cmplt(Vec2::new(9.0, 5.0)).all();
            assert!(
                !is_on_table || lowest > -0.01,
                "{lowest} in tick {tick}, {aside}"
            );
        }
    }
}

#[test]
fn objects_that_leave_the_world_are_deleted() {
    let mut world = TestWorld::new([object("ball", (30.0, 0.0, 1.0), 1.0, sphere(0.5))]);
    world.seconds(4.0);
    assert_eq!(world.poses().len(), 1);
    world.seconds(1.0);
    assert_eq!(world.poses().len(), 0);
}

#[test]
fn an_object_that_turns_near_a_hand_hardly_enters_the_table() {
    let span = Vec3::new(5.0, 5.0, 3.0);
    for number in 0..40 {
        let height = 1.9 + 0.02 * number as f32;
        let tilt = Vec3::new(3.0, -3.0, 40.0);
        let mut world = TestWorld::new([
            turned("it", Vec3::Z * height, tilt, 3.0, block(span)),
            object("held", (3.0, 3.0, height), 1.0, block(Vec3::ONE)),
        ]);
        let [it, held] = ["it", "held"].map(|id| world.entity(id));
        hold(world.0.world_mut(), held, Manipulator::Hand(Hand::Right));
        *world.0.world_mut().get_mut::<Velocity>(it).unwrap() = Velocity {
            linear: Vec3::new(3.0, 3.0, 2.0),
            angular: Vec3::new(4.8, -1.7, 2.1),
        };
        for tick in 0..20 {
            world.0.step(1);
            let lowest = lowest_point(span, world.pose("it"));
            assert!(lowest > -0.1, "{lowest} in tick {tick}, from {height}");
        }
    }
}

#[test]
fn a_box_near_a_hand_keeps_its_corners_out_of_the_table_while_something_is_fast() {
    let span = Vec3::new(3.0, 3.0, 2.0);
    for number in 0..40 {
        let degrees = number as f32 * Vec3::new(1.2, 2.9, 57.0);
        let height = -lowest_point(span, Pose::from_degrees(Vec3::ZERO, degrees));
        let mut world = TestWorld::new([
            turned("box", Vec3::Z * height, degrees, 3.0, open_box(span, 0.1)),
            object("held", (3.2, 0.0, height), 1.0, block(Vec3::ONE)),
            object("fast", (-6.0, 0.0, 50.0), 1.0, sphere(0.5)),
        ]);
        let [hit, held, fast] = ["box", "held", "fast"].map(|id| world.entity(id));
        hold(world.0.world_mut(), held, Manipulator::Hand(Hand::Right));
        world.0.step(2);
        for (object, linear) in [(fast, Vec3::Z * 90.0), (hit, Vec3::new(-1.0, -1.0, -8.0))] {
            *world.0.world_mut().get_mut::<Velocity>(object).unwrap() = Velocity {
                linear,
                angular: Vec3::ZERO,
            };
        }
        for tick in 0..20 {
            world.0.step(1);
            let lowest = lowest_point(span, world.pose("box"));
            assert!(lowest > -0.02, "{lowest} in tick {tick}, turned {degrees}");
        }
    }
}

#[test]
fn a_block_slides_as_far_as_friction_lets_it() {
    let mut world = TestWorld::new([object("block", (-5.0, 0.0, 0.5), 1.0, block(Vec3::ONE))]);
    let entity = world.entity("block");
    world
        .0
        .world_mut()
        .get_mut::<Velocity>(entity)
        .unwrap()
        .linear = Vec3::X * 10.0;
    world.seconds(3.0);
    let slid = world.pose("block").location.x + 5.0;
    let expected = 10.0f32.powi(2) / (2.0 * 0.25 * 98.1);
    assert!(
        (slid / expected - 1.0).abs() < 0.1,
        "slid {slid}, not {expected}"
    );
}

/// Distance, in units, between where an object was dropped and where it comes to rest, seen from above.
fn lands_aside(shape: Shape, degrees: Vec3, bottom: f32, height: f32) -> f32 {
    let dropped = turned("it", Vec3::Z * (bottom + height), degrees, 1.0, shape);
    let mut world = TestWorld::new([dropped]);
    world.seconds(4.0);
    let at = world.pose("it").location;
    assert!((at.z - bottom).abs() < 0.002, "it lies at {at}");
    at.truncate().length()
}

#[test]
fn a_cube_that_falls_flat_lands_below() {
    for height in [0.05, 0.3, 1.0, 3.0, 10.0] {
        for yaw in [0.0, 17.0, 45.0] {
            let cube = block(Vec3::splat(2.0));
            let aside = lands_aside(cube, Vec3::Z * yaw, 1.0, height);
            assert!(aside < 0.002, "{aside} aside from {height}, yaw {yaw}°");
        }
    }
}

#[test]
fn every_convex_shape_that_falls_flat_lands_below() {
    let standing = Vec3::X * 90.0;
    for (shape, degrees, bottom) in [
        (block(Vec3::ONE), Vec3::ZERO, 0.5),
        (block((1.0, 2.0, 3.0)), Vec3::ZERO, 1.5),
        (block((4.0, 1.0, 0.5)), Vec3::Z * 30.0, 0.25),
        (block((1.0, 1.0, 0.05)), Vec3::ZERO, 0.025),
        (cylinder(0.5, 1.0), standing, 0.5),
        (cylinder(1.0, 0.5), standing, 0.25),
        (cylinder(0.4, 1.5), standing, 0.75),
        (sphere(0.5), Vec3::ZERO, 0.5),
    ] {
        for height in [1.0, 3.0, 10.0] {
            let aside = lands_aside(shape.clone(), degrees, bottom, height);
            assert!(aside < 0.002, "{aside} aside from {height}: {shape:?}");
        }
    }
}

#[test]
fn a_cylinder_that_falls_on_its_side_hardly_rolls() {
    for height in [0.3, 1.0, 3.0] {
        let aside = lands_aside(cylinder(0.5, 3.0), Vec3::ZERO, 0.5, height);
        assert!(aside < 0.002, "{aside} aside from {height}");
    }
}

#[test]
fn a_cube_that_falls_flat_onto_blocks_stays_on_them() {
    for (storeys, height, most) in [(1, 1.0, 0.002), (3, 0.5, 0.005), (3, 3.0, 0.03)] {
        let mut items = tower(storeys);
        let at = Vec3::Z * (storeys as f32 + 0.5 + height);
        items.push(object("it", at, 1.0, block(Vec3::ONE)));
        let mut world = TestWorld::new(items);
        world.seconds(4.0);
        for (id, pose) in world.poses() {
            let aside = pose.location.truncate().length();
            assert!(aside < most, "{id} is {aside} aside: {storeys}, {height}");
        }
    }
}
