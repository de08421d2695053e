//! What the robot believes.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use bevy::prelude::*;
use tabletop_core::{
    ObjectSpec, PictureDemand, RobotCommand, SceneCommand, SceneItem, SceneSpec, Shape,
    StepApp as _, WriteCommand as _,
};
use tabletop_geometry::{Pose, Rgb};
use tabletop_sim::headless_app;
use tabletop_vision::{Perception, PerceptionDemand};

fn scene(at: Vec3) -> SceneSpec {
    let block = |id: &str, at: Vec3, color| {
        let shape = Shape::Block {
            span: Vec3::ONE,
            color,
        };
        SceneItem::Object(ObjectSpec::new(id, Pose::at(at), 1.0, shape))
    };
    SceneSpec {
        items: vec![
            block("Red", at, Rgb::RED),
            block("Blue", Vec3::new(2.0, -3.0, 0.5), Rgb::BLUE),
        ],
        ..default()
    }
}

fn app_with(scene: SceneSpec) -> App {
    let mut app = headless_app();
    let world = app.world_mut();
    world.write_command(SceneCommand::Set(Box::new(scene)));
    world.write_command(RobotCommand::Show(true));
    app.step(30);
    app
}

fn look(app: &mut App) {
    app.world().resource::<PictureDemand>().ask();
    app.world().resource::<PerceptionDemand>().ask();
    app.step(1);
}

fn believed(app: &App) -> Vec<(String, Vec3)> {
    let perception = app.world().resource::<Perception>();
    let objects = perception.objects.iter();
    let objects = objects.map(|object| (object.id.clone(), object.seen.pose.unwrap().location));
    objects.collect()
}

#[test]
fn the_eyes_are_closed_until_somebody_asks() {
    let mut app = app_with(scene(Vec3::new(-2.0, -3.0, 0.5)));
    app.world().resource::<PictureDemand>().ask();
    app.step(1);
    assert!(app.world().resource::<Perception>().objects.is_empty());
}

#[test]
fn objects_are_where_they_are_seen_also_after_they_were_exchanged_for_others() {
    let mut app = app_with(scene(Vec3::new(-2.0, -3.0, 0.5)));
    for at in [Vec3::new(-2.0, -3.0, 0.5), Vec3::new(-1.0, -2.0, 0.5)] {
        let command = SceneCommand::Set(Box::new(scene(at)));
        app.world_mut().write_command(command);
        app.step(30);
        look(&mut app);
        let seen = believed(&app);
        assert_eq!(seen.len(), 2);
        for ((id, location), (name, truth)) in seen
            .iter()
            .zip([("Red", at), ("Blue", Vec3::new(2.0, -3.0, 0.5))])
        {
            assert_eq!(id, name);
            assert!(location.distance(truth) < 0.01, "{id}: {location}");
        }
    }
}
