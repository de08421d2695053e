//! Apps of one's own with one of the plugins: missing plugins are logged, and nothing panics.

use bevy::prelude::*;
use tabletop::{
    camera::CameraPlugin, demonstrator::DemonstratorPlugin, drive::DrivePlugin,
    history::HistoryPlugin, mechanism::MechanismPlugin, physics::PhysicsPlugin, prelude::*,
    robot::RobotPlugin, scenario::ScenarioPlugin, scene::ScenePlugin, script::ScriptPlugin,
    xml::XmlPlugin,
};

/// Steps an app with the core and these plugins, and gives it commands for all of them.
fn try_out(plugins: impl Fn(&mut App)) {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, CorePlugin::default()));
    plugins(&mut app);
    app.start().step(2);
    let hand = Hand::Left;
    let shape = Shape::Sphere {
        radius: 0.5,
        color: Rgb::GRAY,
    };
    let ball = ObjectSpec::new("ball", Pose::at(Vec3::Z), 1.0, shape);
    let world = app.world_mut();
    let entity = world.spawn((Transform::from(ball.pose), ball)).id();
    world.resource_mut::<ObjectIndex>().insert("ball", entity);
    let ball = || "ball".to_owned();
    let commands: [Vec<SimCommand>; 2] = [
        vec![
            SceneCommand::Set(Box::default()).into(),
            RobotCommand::Show(true).into(),
            RecordingCommand::Start.into(),
            HandCommand::Grasp {
                hand,
                object: ball(),
            }
            .into(),
            MechanismCommand::PointTo {
                hand,
                target: ball(),
            }
            .into(),
        ],
        vec![
            HistoryCommand::Undo.into(),
            ClockCommand::SetPaused(true).into(),
            RobotCommand::Show(false).into(),
            SceneCommand::Clear.into(),
            RecordingCommand::Finish.into(),
        ],
    ];
    for commands in commands {
        for command in commands {
            app.world_mut().write_command(command);
        }
        app.step(3);
    }
}

#[test]
fn each_plugin_runs_alone() {
    type Add = fn(&mut App);
    let plugins: [(&str, Add); 12] = [
        ("core", |_| {}),
        ("camera", |app| {
            app.add_plugins(CameraPlugin);
        }),
        ("demonstrator", |app| {
            app.add_plugins(DemonstratorPlugin);
        }),
        ("history", |app| {
            app.add_plugins(HistoryPlugin::DEFAULT);
        }),
        ("mechanism", |app| {
            app.add_plugins(MechanismPlugin);
        }),
        ("physics", |app| {
            app.add_plugins(PhysicsPlugin::default());
        }),
        ("robot", |app| {
            app.add_plugins(RobotPlugin::default());
        }),
        ("drive", |app| {
            app.add_plugins(DrivePlugin);
        }),
        ("scenario", |app| {
            app.add_plugins(ScenarioPlugin);
        }),
        ("scene", |app| {
            app.add_plugins(ScenePlugin);
        }),
        ("script", |app| {
            app.add_plugins(ScriptPlugin::default());
        }),
        ("xml", |app| {
            app.add_plugins(XmlPlugin);
        }),
    ];
    for (name, add) in plugins {
        let tried = std::panic::catch_unwind(|| try_out(add));
        assert!(tried.is_ok(), "{name}");
        if name != "physics" {
            let tried = std::panic::catch_unwind(|| {
                try_out(|app| {
                    app.add_plugins(PhysicsPlugin::default());
                    add(app);
                });
            });
            assert!(tried.is_ok(), "physics and {name}");
        }
    }
}
