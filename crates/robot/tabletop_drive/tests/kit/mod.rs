//! A table with a robot, for tests.
#![allow(dead_code, reason = "not every test needs everything")]

pub mod motors;

use bevy::{ecs::message::MessageCursor, prelude::*};
use bevy_rapier3d::{parry, prelude::Collider, rapier::prelude as rapier};
use tabletop_core::CommandId;
use tabletop_core::*;
use tabletop_demonstrator::DemonstratorPlugin;
use tabletop_drive::DrivePlugin;
use tabletop_geometry::*;
use tabletop_history::HistoryPlugin;
use tabletop_physics::PhysicsPlugin;
use tabletop_robot::{RobotLink, RobotPlugin};
use tabletop_scene::ScenePlugin;

pub struct Stage {
    pub app: App,
    facts: MessageCursor<SimFact>,
}

/// A block of this size.
pub fn block(span: Vec3) -> Shape {
    Shape::Block {
        span,
        color: Rgb::GRAY,
    }
}

impl Stage {
    /// An empty table with the robot at it.
    pub fn new() -> Self {
        Self::with(RobotPlugin::default())
    }

    /// The same in dynamic mode.
    pub fn dynamic() -> Self {
        Self::in_mode(RobotMode::Dynamic)
    }

    /// The same in a mode.
    pub fn in_mode(mode: RobotMode) -> Self {
        Self::with(RobotPlugin {
            mode,
            ..RobotPlugin::default()
        })
    }

    /// An empty table with this robot at it.
    pub fn with(robot: RobotPlugin) -> Self {
        let mut app = App::new();
        app.add_plugins((
            MinimalPlugins,
            CorePlugin::default(),
            HistoryPlugin::default(),
            PhysicsPlugin::default(),
        ))
        .add_plugins((ScenePlugin, DemonstratorPlugin, robot, DrivePlugin))
        .start();
        let mut stage = Self {
            app,
            facts: MessageCursor::default(),
        };
        stage.tell(SceneCommand::Set(Box::default()));
        stage.tell(RobotCommand::Show(true));
        stage.app.step(1);
        stage
    }

    pub fn tell(&mut self, command: impl Into<SimCommand>) -> CommandId {
        self.app.world_mut().write_command(command)
    }

    pub fn put(&mut self, id: &str, shape: Shape, mass: f32, pose: Pose) -> Entity {
        let spec = ObjectSpec::new(id, pose, mass, shape);
        self.app
            .world_mut()
            .spawn((Transform::from(pose), spec))
            .id()
    }

    pub fn robot(&self) -> &Robot {
        self.app.world().resource()
    }

    pub fn place(&self, id: &str) -> Pose {
        let object = self.app.world().resource::<ObjectIndex>().get(id).unwrap();
        Pose::from(self.app.world().get::<Transform>(object).unwrap())
    }

    /// The facts of the next ticks.
    pub fn facts_of(&mut self, ticks: u64) -> Vec<SimFact> {
        let mut all = Vec::new();
        for _ in 0..ticks {
            self.app.step(1);
            let facts = self.app.world().resource::<Messages<SimFact>>();
            all.extend(self.facts.read(facts).cloned());
        }
        all
    }

    /// Brings an end effector to a place, its fingers pointing down and opening along X, then turned about Z.
    pub fn reach(&mut self, arm: Arm, location: Vec3, yaw_degrees: f32) {
        let pose = Pose::from_degrees(location, Vec3::Z * yaw_degrees);
        self.tell(RobotCommand::ReachTo {
            arm: arm.name(),
            pose,
        });
        let mut facts = self.facts_of(1);
        for _ in 0..600 {
            if !self.robot().limb(arm).is_moving {
                break;
            }
            facts.extend(self.facts_of(1));
        }
        if self.robot().mode == RobotMode::Dynamic {
            // It has arrived, apart from the last pull of its motors.
            facts.extend(self.facts_of(30));
        }
        // A motor yields a little to an object that it slides along.
        let near = match self.robot().mode {
            RobotMode::Kinematic => 1e-3,
            RobotMode::Dynamic => 5e-3,
        };
        let there = self.robot().limb(arm).end_effector;
        assert!(
            (there.location - location).length() < near,
            "{there:?} instead of {pose:?}: {facts:?}"
        );
    }
}

/// The bodies of the arms that are inside the table.
pub fn inside_the_table(stage: &mut Stage) -> Vec<String> {
    let slab = Table::default().slab();
    let Solid::Cuboid(span) = slab.solid else {
        panic!("{slab:?}");
    };
    let table = rapier::SharedShape::cuboid(span.x / 2.0, span.y / 2.0, span.z / 2.0);
    let table_at = rapier::Pose::from_translation(slab.pose.location);
    let world = stage.app.world_mut();
    let mut bodies = world.query::<(&RobotLink, &Transform, &Collider)>();
    bodies
        .iter(world)
        .filter(|(body, ..)| body.name.contains("left") || body.name.contains("right"))
        .filter(|(_, place, collider)| {
            let at = rapier::Pose::from_parts(place.translation, place.rotation);
            // An intersection test reports some bodies that are a hair apart as touching.
            let contact = parry::query::contact(&at, &*collider.raw, &table_at, &*table, 0.0);
            contact.unwrap().is_some_and(|contact| contact.dist < 0.0)
        })
        .map(|(body, ..)| body.name.clone())
        .collect()
}
