//! The settings that a recording needs to be replayed.

use std::path::absolute;

use bevy::prelude::*;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use tabletop_baxter::{BaxterPlugin, Description, Source};
use tabletop_core::{Robot, RobotMode, SimSystems, TickSystems};
use tabletop_kinematics::ModelError;
use tabletop_physics::PhysicsSettings;
use tabletop_recorder::SessionSettings;

/// Names of the settings in a session log.
pub(crate) const PHYSICS: &str = "physics";
pub(crate) const ROBOT: &str = "robot";

/// Which robot stood at the table.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct RobotSettings {
    mode: RobotMode,
    /// Its description, if it is not the one that comes with the program.
    description: Option<Source>,
}

impl RobotSettings {
    /// The plugin of this robot.
    pub fn plugin(self) -> Result<BaxterPlugin, ModelError> {
        Ok(BaxterPlugin {
            description: self.description.map(Description::read).transpose()?,
            mode: self.mode,
        })
    }
}

/// Writes the [`PhysicsSettings`] and the robot into the headers of recordings.
#[derive(Clone, Copy, Debug, Default)]
pub struct RecordedSettingsPlugin;

impl Plugin for RecordedSettingsPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(
            FixedUpdate,
            (
                note_physics.run_if(resource_exists_and_changed::<PhysicsSettings>),
                note_robot.run_if(resource_exists_and_changed::<Description>),
            )
                .chain()
                .in_set(TickSystems)
                .before(SimSystems::Load)
                .run_if(resource_exists::<SessionSettings>),
        );
    }
}

fn note_physics(physics: Res<PhysicsSettings>, mut settings: ResMut<SessionSettings>) -> Result {
    // Through a text, in which numbers have the digits of their 32 bits.
    let value: Value = serde_json::from_str(&serde_json::to_string(&*physics)?)?;
    settings.0.insert(PHYSICS.into(), value);
    Ok(())
}

/// The same, wherever the program runs that replays it: its meshes are beside the file.
fn from_everywhere(source: Source) -> Source {
    let path = absolute(&source.path).unwrap_or(source.path);
    Source { path, ..source }
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
