//! The folders and the notes of the recordings that the user makes.

use std::path::PathBuf;

use bevy::prelude::*;
use tabletop_core::{Recording, RecordingFact, SimFact};
use tabletop_user::{KeySystems, NextTake, Notices, Tone};

use tabletop_recorder::{record_into, write_notes};

pub(super) fn plugin(app: &mut App) {
    app.add_systems(
        RunFixedMainLoop,
        choose_folder
            .run_if(|recording: Res<Recording>| !recording.0)
            .before(KeySystems)
            .in_set(RunFixedMainLoopSystems::BeforeFixedMainLoop),
    )
    .add_systems(Update, keep_notes);
}

/// The next recording is made where the user wants it.
fn choose_folder(world: &mut World, mut chosen: Local<Option<PathBuf>>) {
    let folder = world.resource::<NextTake>().folder();
    if chosen.as_ref() != Some(&folder) && record_into(world, &folder).is_ok() {
        *chosen = Some(folder);
    }
}

/// Writes the notes on a recording when it begins, and again when it has ended; then they are those of the next one.
fn keep_notes(
    mut facts: MessageReader<SimFact>,
    mut take: ResMut<NextTake>,
    mut notices: ResMut<Notices>,
) {
    for fact in facts.read() {
        let (folder, has_ended) = match fact {
            SimFact::Recording(RecordingFact::Started { folder, .. }) => (folder, false),
            SimFact::Recording(RecordingFact::Finished { folder, .. }) => (folder, true),
            // One that has failed at once has left another recording in its place.
            SimFact::Recording(RecordingFact::Failed { .. })
            | SimFact::Scene(_)
            | SimFact::History(_)
            | SimFact::Hand(_)
            | SimFact::Mechanism(_)
            | SimFact::Robot(_)
            | SimFact::Refused { .. } => continue,
        };
        if !take.notes.is_empty()
            && let Err(error) = write_notes(folder, take.notes.trim())
        {
            notices.add(Tone::Fault, &error.to_string());
        } else if has_ended && !take.notes.is_empty() {
            take.notes.clear();
        }
    }
}
