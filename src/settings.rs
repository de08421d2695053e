//! The settings that a recording needs to be replayed.

use bevy::prelude::*;
use serde_json::Value;
use tabletop_core::SimSystems;
use tabletop_physics::PhysicsSettings;
use tabletop_recorder::SessionSettings;

/// Their name among the settings of a session log.
pub(crate) const PHYSICS: &str = "physics";

/// Writes the [`PhysicsSettings`] into the headers of recordings.
#[derive(Clone, Copy, Debug, Default)]
pub struct RecordedSettingsPlugin;

impl Plugin for RecordedSettingsPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(
            FixedUpdate,
            note_physics
                .before(SimSystems::Load)
                .run_if(resource_exists::<SessionSettings>)
                .run_if(resource_exists_and_changed::<PhysicsSettings>),
        );
    }
}

fn note_physics(physics: Res<PhysicsSettings>, mut settings: ResMut<SessionSettings>) -> Result {
    // Through a text, in which numbers have the digits of their 32 bits.
    let value: Value = serde_json::from_str(&serde_json::to_string(&*physics)?)?;
    settings.0.insert(PHYSICS.into(), value);
    Ok(())
}
