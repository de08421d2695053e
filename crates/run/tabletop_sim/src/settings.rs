//! Settings that a recording needs to be replayed.

use std::path::absolute;

use bevy::prelude::*;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use tabletop_core::{
    CommandSystems, Reach, RestingSystems, Robot, RobotMode, SceneFact, SimFact, TickSystems,
    is_shipped,
};
use tabletop_physics::PhysicsSettings;
use tabletop_recorder::SessionSettings;
use tabletop_robot::{Description, DescriptionError, DescriptionSource, RobotPlugin};

/// The name of the physics in a session log.
pub const PHYSICS: &str = "physics";
/// The name of the robot in a session log.
pub const ROBOT: &str = "robot";
const TASK_FILE: &str = "task_file";

/// The settings with which a world must be made to go through the same states.
#[derive(Clone, Debug, Serialize)]
pub struct Settings {
    /// Gravity, friction and the like.
    pub physics: PhysicsSettings,
    /// The robot at the table.
    pub robot: RobotSettings,
}

impl Settings {
    /// The settings of a world.
    pub fn of(world: &World) -> Self {
        let robot = world.get_resource::<Robot>();
        let description = world.get_resource::<Description>();
        Self {
            physics: world
                .get_resource::<PhysicsSettings>()
                .copied()
                .unwrap_or_default(),
            robot: RobotSettings {
                mode: robot.map(|robot| robot.mode).unwrap_or_default(),
                description: description
                    .and_then(|description| description.source.clone())
                    .map(from_everywhere),
            },
        }
    }

    /// The first setting that differs from another world's, with both values.
    pub fn first_difference(&self, here: &Self) -> Option<String> {
        let [recorded, here] = [self, here].map(|settings| value(settings).ok());
        first_difference("settings", &recorded?, &here?)
    }
}

/// Length beyond which values are not shown.
const LONGEST_VALUE: usize = 60;

fn first_difference(name: &str, recorded: &Value, here: &Value) -> Option<String> {
    if let (Value::Object(recorded), Value::Object(here)) = (recorded, here) {
        return recorded.iter().find_map(|(key, value)| {
            let other = here.get(key).unwrap_or(&Value::Null);
            first_difference(&format!("{name}.{key}"), value, other)
        });
    }
    if recorded == here {
        return None;
    }
    let [recorded, here] = [recorded, here].map(Value::to_string);
    Some(match recorded.len().max(here.len()) > LONGEST_VALUE {
        true => format!("{name} is another one"),
        false => format!("{name} was {recorded}, and is {here} here"),
    })
}

/// The robot at the table.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct RobotSettings {
    mode: RobotMode,
    /// Its description, if it is not the robot inside the program.
    description: Option<DescriptionSource>,
}

impl RobotSettings {
    /// The plugin of this robot, whose meshes must be within reach.
    pub fn plugin(self, reach: Reach) -> Result<RobotPlugin, DescriptionError> {
        let source = self.description.map(|source| DescriptionSource {
            reach: Some(reach),
            ..source
        });
        Ok(RobotPlugin {
            description: source.map(Description::read).transpose()?,
            mode: self.mode,
        })
    }
}

/// Writes the [`PhysicsSettings`], the robot and the task file that was loaded last into the headers of recordings.
#[derive(Clone, Copy, Debug, Default)]
pub struct RecordedSettingsPlugin;

impl Plugin for RecordedSettingsPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(
            FixedUpdate,
            (
                note_physics.run_if(resource_exists_and_changed::<PhysicsSettings>),
                note_robot.run_if(resource_exists_and_changed::<Description>),
                note_task_file,
            )
                .chain()
                .in_set(TickSystems)
                .in_set(RestingSystems)
                .before(CommandSystems::History)
                .run_if(resource_exists::<SessionSettings>),
        );
    }
}

fn note_physics(physics: Res<PhysicsSettings>, mut settings: ResMut<SessionSettings>) -> Result {
    settings.0.insert(PHYSICS.into(), value(&*physics)?);
    Ok(())
}

/// Through a text, in which numbers have the digits of their 32 bits.
fn value(settings: &impl Serialize) -> serde_json::Result<Value> {
    serde_json::from_str(&serde_json::to_string(settings)?)
}

fn note_task_file(mut facts: MessageReader<SimFact>, mut settings: ResMut<SessionSettings>) {
    for fact in facts.read() {
        if let SimFact::Scene(SceneFact::TaskLoaded { path, .. }) = fact {
            let path = path.to_string_lossy();
            settings.0.insert(TASK_FILE.into(), path.into());
        }
    }
}

/// The same for a replay in any working folder: its meshes are beside the file.
fn from_everywhere(source: DescriptionSource) -> DescriptionSource {
    let path = match is_shipped(&source.path) {
        true => source.path,
        false => absolute(&source.path).unwrap_or(source.path),
    };
    DescriptionSource { path, ..source }
}

fn note_robot(
    description: Res<Description>,
    robot: Res<Robot>,
    mut settings: ResMut<SessionSettings>,
) -> Result {
    let robot = RobotSettings {
        mode: robot.mode,
        description: description.source.clone().map(from_everywhere),
    };
    settings
        .0
        .insert(ROBOT.into(), serde_json::to_value(robot)?);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_setting_that_differs_is_named_with_both_values() {
        let settings = || Settings {
            physics: PhysicsSettings::default(),
            robot: RobotSettings::default(),
        };
        let difference = |other: &Settings| other.first_difference(&settings());
        assert_eq!(difference(&settings()), None);
        let mut moon = settings();
        moon.physics.gravity = 16.0;
        let found = difference(&moon).unwrap();
        assert_eq!(found, "settings.physics.gravity was 16.0, and is 98.1 here");
        let mut other = settings();
        other.robot.description = Some(DescriptionSource {
            path: "robot.urdf".into(),
            urdf: "<robot/>".repeat(100),
            layout: None,
            reach: None,
        });
        assert_eq!(
            difference(&other).unwrap(),
            "settings.robot.description is another one"
        );
    }
}
