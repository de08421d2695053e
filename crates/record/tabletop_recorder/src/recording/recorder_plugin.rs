//! The plugin that records.

use std::path::PathBuf;

use bevy::prelude::*;
use serde_json::{Map, Value};
use tabletop_core::{
    CommandSystems, PictureSystems, RestApp as _, RestingSystems, SimSystems, TickSystems,
};

use tabletop_storage::Storage;

use crate::{
    files::{
        channels::Channels, destination::Destination, durability::Durability,
        hand_pictures::HandPictures, session::SessionSettings,
    },
    recording::recorder::{
        Recorder, ask_for_picture, follow_history, pass_over, record, take_commands, ticks_to_frame,
    },
};

/// Records the simulation into a folder from [`Start`] to [`Finish`], both ticks included.
/// Needs [`CorePlugin`](tabletop_core::CorePlugin).
///
/// It keeps between the phases of a tick: after undo and redo it follows them, before [`SimSystems::Ingest`] it logs the commands, after
/// [`PictureSystems`] it writes what came of them. All of it also happens while paused, so that nothing is missed that is done meanwhile.
///
/// [`Start`]: tabletop_core::RecordingCommand::Start
/// [`Finish`]: tabletop_core::RecordingCommand::Finish
#[derive(Clone, Debug)]
pub struct RecorderPlugin {
    /// The folder. An earlier recording is moved aside when one starts; a folder with anything else is refused.
    pub folder: PathBuf,
    /// The initial [settings](SessionSettings).
    pub header: Map<String, Value>,
    /// The files beside the pictures.
    pub channels: Channels,
    /// The hand cameras whose pictures are recorded, too.
    pub hand_pictures: HandPictures,
    /// The durability over a loss of power.
    pub durability: Durability,
    /// The file system, which tests let fail.
    pub storage: Storage,
}

impl Default for RecorderPlugin {
    fn default() -> Self {
        Self {
            folder: "demo".into(),
            header: Map::new(),
            channels: Channels::default(),
            hand_pictures: HandPictures::default(),
            durability: Durability::default(),
            storage: Storage::default(),
        }
    }
}

impl Plugin for RecorderPlugin {
    fn build(&self, app: &mut App) {
        app.insert_resource(Recorder::new(Destination {
            folder: self.folder.clone(),
            channels: self.channels,
            hand_pictures: self.hand_pictures.clone(),
            durability: self.durability,
            storage: self.storage.clone(),
        }))
        .insert_resource(SessionSettings(self.header.clone()))
        .add_systems(
            FixedUpdate,
            (
                take_commands.in_set(CommandSystems::Recording),
                (
                    follow_history
                        .after(CommandSystems::History)
                        .before(SimSystems::Load),
                    ask_for_picture
                        .after(SimSystems::Propagate)
                        .before(SimSystems::Sense),
                    record
                        .after(PictureSystems::Draw)
                        .before(SimSystems::Record),
                )
                    .in_set(TickSystems),
            )
                .in_set(RestingSystems),
        )
        .wake_after(ticks_to_frame)
        .at_rest(pass_over);
    }
}
