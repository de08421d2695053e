//! Kinematic bodies keep all their moves, however many ticks a frame has (Rapier alone loses some), and turn the short way.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use std::time::Duration;

use bevy::{prelude::*, time::TimeUpdateStrategy};
use bevy_rapier3d::prelude::*;
use tabletop_core::prelude::*;
use tabletop_physics::PhysicsPlugin;

#[derive(Component)]
struct Mover;

fn move_on(mut movers: Query<&mut Transform, With<Mover>>) {
    for mut transform in &mut movers {
        transform.translation.x += 0.1;
    }
}

fn moved_after_twelve_ticks(ticks_a_frame: u32, with_child: bool) -> f32 {
    let mut app = App::new();
    app.add_plugins((
        MinimalPlugins,
        CorePlugin::default(),
        PhysicsPlugin::default(),
    ))
    .add_systems(FixedUpdate, move_on.in_set(SimSystems::Actuate));
    app.finish();
    app.cleanup();
    app.insert_resource(TimeUpdateStrategy::FixedTimesteps(ticks_a_frame));
    app.world_mut()
        .resource_mut::<Time<Virtual>>()
        .set_max_delta(Duration::from_secs(1));
    app.update();
    let mover = app
        .world_mut()
        .spawn((
            Mover,
            RigidBody::KinematicPositionBased,
            Collider::ball(0.5),
            Transform::default(),
        ))
        .id();
    if with_child {
        app.world_mut()
            .spawn((Transform::default(), ChildOf(mover)));
    }
    for _ in 0..12 / ticks_a_frame {
        app.update();
    }
    app.world().get::<Transform>(mover).unwrap().translation.x
}

#[test]
fn a_kinematic_body_keeps_its_moves() {
    for ticks_a_frame in [1, 3] {
        for with_child in [false, true] {
            let moved = moved_after_twelve_ticks(ticks_a_frame, with_child);
            assert!(
                (moved - 1.2).abs() < 1e-5,
                "moved {moved} with {ticks_a_frame} ticks a frame, child: {with_child}"
            );
        }
    }
}

#[derive(Component)]
struct Turner;

/// Turns past where the largest component of its quaternion is another one, which makes its sign change.
fn turn_on(mut turners: Query<&mut Transform, With<Turner>>, tick: Res<SimTick>) {
    for mut transform in &mut turners {
        let angle = 1e-4 * (tick.0 as f32 - 20.0);
        transform.rotation = Quat::from_rotation_z(-std::f32::consts::FRAC_PI_2 - angle);
    }
}

#[test]
fn a_slowly_turning_body_does_not_strike_its_load() {
    let mut app = App::new();
    app.add_plugins((
        MinimalPlugins,
        CorePlugin::default(),
        PhysicsPlugin::default(),
    ))
    .add_systems(FixedUpdate, turn_on.in_set(SimSystems::Actuate))
    .start();
    app.world_mut().spawn((
        Turner,
        RigidBody::KinematicPositionBased,
        Collider::cuboid(1.0, 1.0, 0.5),
        Transform::from_xyz(0.0, 0.0, -0.5),
    ));
    let shape = Shape::Block {
        span: Vec3::ONE,
        color: Rgb::RED,
    };
    let at = Pose::at(Vec3::new(0.7, 0.0, 0.5));
    let block = app
        .world_mut()
        .spawn((
            ObjectSpec::new("block", at, 1.0, shape),
            Transform::from(at),
        ))
        .id();
    for _ in 0..40 {
        app.step(1);
        let there = app.world().get::<Transform>(block).unwrap().translation;
        let moved = (there - at.location).truncate().length();
        assert!(moved < 0.01, "{there}");
    }
}
