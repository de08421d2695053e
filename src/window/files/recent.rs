//! Recent files, also of earlier runs.

use std::path::PathBuf;

use bevy::prelude::*;
use tabletop_gui::{Files, Notices, Preferences, Tone};

/// Number of remembered files.
const MOST: usize = 10;

/// Their name in the [`Preferences`].
const CONCERN: &str = "recent";

pub(super) fn plugin(app: &mut App) {
    app.add_systems(Startup, recall);
}

fn recall(preferences: Res<Preferences>, mut files: ResMut<Files>, mut notices: ResMut<Notices>) {
    match preferences.read::<Vec<PathBuf>>(CONCERN) {
        Ok(recent) => {
            files.recent = recent.unwrap_or_default();
            files.recent.retain(|path| path.exists());
            files.recent.truncate(MOST);
        }
        Err(error) => notices.add(Tone::Warning, &error.to_string()),
    }
}

/// Puts a path before the others.
pub(super) fn remember(world: &mut World, path: PathBuf) {
    let mut files = world.resource_mut::<Files>();
    files
        .recent
        .retain(|other| *other != path && other.exists());
    files.recent.insert(0, path);
    files.recent.truncate(MOST);
    let recent = files.recent.clone();
    if let Err(error) = world.resource::<Preferences>().keep(CONCERN, &recent) {
        let mut notices = world.resource_mut::<Notices>();
        notices.add(Tone::Warning, &error.to_string());
    }
}
