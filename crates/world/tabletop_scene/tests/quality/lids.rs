//! Lid boxes.

use bevy::prelude::*;
use bevy_rapier3d::prelude::ExternalForce;

use crate::world::*;

const UPRIGHT: (Vec3, Vec3) = (Vec3::new(0.0, 0.0, 2.5), Vec3::ZERO);
const TRAPDOOR: (Vec3, Vec3) = (Vec3::new(0.0, 0.0, 3.0), Vec3::new(0.0, 90.0, -90.0));

fn push(world: &mut TestWorld, force: Vec3) {
    let lid = world.entity("lidbox-lid");
    world.0.world_mut().entity_mut(lid).insert(ExternalForce {
        force,
        torque: Vec3::ZERO,
    });
}

#[test]
fn a_shut_lid_holds_still() {
    let mut world = TestWorld::new([report_lidbox(UPRIGHT.0, UPRIGHT.1)]);
    world.seconds(1.0);
    let (far, turn) = world.motion_in(20.0);
    assert!(far < 0.001 && turn < 0.01, "moved {far}, turned {turn}°");
    assert!(
        world
            .pose("lidbox-lid")
            .location
            .distance(Vec3::new(0.0, 0.0, 5.3))
            < 0.01
    );
    assert!(
        world
            .pose("lidbox-box")
            .location
            .distance(Vec3::new(0.0, 0.0, 2.5))
            < 0.01
    );
}

#[test]
fn a_lid_opens_and_closes_over_its_whole_travel() {
    let mut world = TestWorld::new([report_lidbox(UPRIGHT.0, UPRIGHT.1)]);
    let opening = |world: &TestWorld| {
        world.pose("lidbox-box").location.x - world.pose("lidbox-lid").location.x
    };
    push(&mut world, Vec3::X * -40.0);
    world.seconds(3.0);
    assert!(
        (opening(&world) - 6.0).abs() < 0.05,
        "open by {}",
        opening(&world)
    );
    push(&mut world, Vec3::ZERO);
    let (far, _) = world.motion_in(3.0);
    assert!(far < 0.01, "the open lid moved {far}");

    push(&mut world, Vec3::X * 40.0);
    world.seconds(3.0);
    assert!(opening(&world).abs() < 0.05, "open by {}", opening(&world));
    let (lid, body) = (world.pose("lidbox-lid"), world.pose("lidbox-box"));
    let turn = lid.rotation.angle_between(body.rotation).to_degrees();
    assert!(turn < 0.1, "the lid turned {turn}°");
}

#[test]
fn a_half_open_lid_stays_half_open() {
    let mut world = TestWorld::new([report_lidbox(UPRIGHT.0, UPRIGHT.1)]);
    push(&mut world, Vec3::X * -40.0);
    world.seconds(0.5);
    push(&mut world, Vec3::ZERO);
    world.seconds(1.0);
    let lid = world.pose("lidbox-lid").location.x;
    assert!((-5.5..-0.5).contains(&lid), "the lid is at {lid}");
    let (far, _) = world.motion_in(10.0);
    assert!(far < 0.001, "moved {far}");
}

#[test]
fn a_trapdoor_stays_shut_and_falls_shut() {
    let mut world = TestWorld::new([report_lidbox(TRAPDOOR.0, TRAPDOOR.1)]);
    let opening = |world: &TestWorld| {
        let lid = world.pose("lidbox-box").inverse() * world.pose("lidbox-lid").location;
        lid.distance(Vec3::Z * 2.8)
    };
    world.seconds(20.0);
    assert!(opening(&world) < 0.01, "open by {}", opening(&world));

    push(&mut world, Vec3::Z * 250.0);
    world.seconds(0.25);
    assert!(opening(&world) > 0.3, "open by {} only", opening(&world));
    push(&mut world, Vec3::ZERO);
    world.seconds(3.0);
    assert!(opening(&world) < 0.01, "open by {}", opening(&world));
    let body = world.pose("lidbox-box");
    assert!(
        body.location.distance(TRAPDOOR.0) < 0.05,
        "{}",
        body.location
    );
}
