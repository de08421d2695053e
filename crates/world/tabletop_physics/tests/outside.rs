//! Changes of bodies from outside reach Rapier in the next step, even during a pause of one tick.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod kit;

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use tabletop_core::prelude::*;

/// An app in which a ball falls, so that Rapier changes something in every tick.
fn app() -> (App, Entity) {
    let mut app = kit::app(default());
    let ball = ball(&mut app, 0.0);
    app.step(5);
    (app, ball)
}

fn ball(app: &mut App, x: f32) -> Entity {
    sphere(app, Vec3::X * x, 0.5, 1.0)
}

fn sphere(app: &mut App, at: Vec3, radius: f32, mass: f32) -> Entity {
    let color = Rgb::GRAY;
    let shape = Shape::Sphere { radius, color };
    let spec = ObjectSpec::new(format!("ball at {at}"), Pose::at(at), mass, shape);
    let place = Transform::from_translation(at);
    app.world_mut().spawn((spec, place)).id()
}

fn bodies(app: &mut App) -> usize {
    let mut sets = app.world_mut().query::<&RapierRigidBodySet>();
    sets.single(app.world()).unwrap().bodies.len()
}

#[test]
fn a_change_of_a_component_reaches_the_engine() {
    let (mut app, ball) = app();
    let place = |app: &App| app.world().get::<Transform>(ball).unwrap().translation;
    app.world_mut()
        .get_mut::<Transform>(ball)
        .unwrap()
        .translation = Vec3::X * 7.0;
    app.step(1);
    assert_eq!(place(&app).x, 7.0);
    app.world_mut().get_mut::<Velocity>(ball).unwrap().linear = Vec3::Y * 6.0;
    app.step(1);
    assert!((place(&app).y - 0.1).abs() < 1e-5, "{}", place(&app));
    app.world_mut()
        .entity_mut(ball)
        .insert((GravityScale(0.0), Velocity::zero()));
    app.step(1);
    let height = place(&app).z;
    app.step(10);
    assert_eq!(place(&app).z, height, "it floats");
}

#[test]
fn a_body_that_comes_or_goes_during_a_pause_reaches_the_engine_after_it() {
    for paused in [1, 2] {
        let (mut app, falling) = app();
        let gone = ball(&mut app, 5.0);
        app.step(2);
        assert_eq!(bodies(&mut app), 2);
        app.world_mut().write_command(ClockCommand::SetPaused(true));
        app.step(3);
        app.world_mut().entity_mut(gone).remove::<RigidBody>();
        app.step(paused);
        app.world_mut()
            .write_command(ClockCommand::SetPaused(false));
        app.step(2);
        assert_eq!(bodies(&mut app), 1, "{falling} is left after {paused}");
    }
}

#[test]
fn a_fast_body_does_not_meet_removed_bodies() {
    let (mut app, small) = app();
    let post = sphere(&mut app, Vec3::new(20.0, 0.0, -100.0), 1.0, 0.0);
    let large = sphere(&mut app, Vec3::X * 20.0, 4.0, 1.0);
    for falling in [small, large] {
        app.world_mut().entity_mut(falling).insert(Ccd::disabled());
    }
    // The small one is so fast that Rapier sweeps it.
    app.step(30);
    for gone in [small, post] {
        app.world_mut().despawn(gone);
        app.step(1);
    }
    // The large one becomes so fast without any other change.
    app.step(80);
    let place = app.world().get::<Transform>(large).unwrap().translation;
    assert!(place.z < -110.0, "{place}");
}

/// Something that moves an entity to another of Bevy's tables.
#[derive(Component)]
struct Mark;

#[test]
fn bodies_woken_in_one_tick_wake_in_their_order() {
    let (mut app, falling) = app();
    let balls = [falling, ball(&mut app, 5.0), ball(&mut app, 10.0)];
    app.step(2);
    let active = |app: &mut App| {
        let mut simulations = app.world_mut().query::<&RapierContextSimulation>();
        let simulation = simulations.single(app.world()).unwrap();
        simulation.islands.active_bodies().collect::<Vec<_>>()
    };
    let bodies = active(&mut app);
    assert_eq!(bodies.len(), balls.len());
    for ball in balls {
        let floats = (GravityScale(0.0), Velocity::zero());
        app.world_mut().entity_mut(ball).insert(floats);
    }
    app.step(60);
    assert_eq!(active(&mut app), []);
    app.world_mut().entity_mut(balls[0]).insert(Mark);
    for ball in balls {
        app.world_mut().get_mut::<Velocity>(ball).unwrap().linear = Vec3::Z;
    }
    app.step(1);
    assert_eq!(active(&mut app), bodies);
}

#[test]
fn a_body_with_a_nan_velocity_stops_and_falls_on() {
    let (mut app, ball) = app();
    let height = |app: &App| app.world().get::<Transform>(ball).unwrap().translation.z;
    let before = height(&app);
    app.world_mut().get_mut::<Velocity>(ball).unwrap().linear = Vec3::NAN;
    app.step(1);
    assert_eq!(height(&app), before);
    assert_eq!(
        app.world().get::<Velocity>(ball).unwrap().linear,
        Vec3::ZERO
    );
    app.step(30);
    let depth = before - height(&app);
    assert!((10.0..20.0).contains(&depth), "{depth}");
}
