//! What falls.

use bevy::prelude::*;
use bevy_rapier3d::prelude::Velocity;
use tabletop_core::{SceneItem, StepApp as _};

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

/// Things that are easily lost, dropped from a height of 100 units along the line of this `y`.
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

/// Asserts that none of the objects passes through this height within the table's edges in so many seconds; what is
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
fn what_leaves_the_world_is_deleted() {
    let mut world = TestWorld::new([object("ball", (30.0, 0.0, 1.0), 1.0, sphere(0.5))]);
    world.seconds(4.0);
    assert_eq!(world.poses().len(), 1);
    world.seconds(1.0);
    assert_eq!(world.poses().len(), 0);
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
