//! Recent files, also of earlier runs.

use std::path::{Path, PathBuf};

use bevy::prelude::*;
use tabletop_gui::{Files, Preferences};
use tabletop_user::{Notices, Tone};

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

/// These paths with another before them.
fn with(path: &Path, mut paths: Vec<PathBuf>) -> Vec<PathBuf> {
    paths.retain(|other| other != path && other.exists());
    paths.insert(0, path.to_owned());
    paths.truncate(MOST);
    paths
}

/// Puts a path before the others.
pub(super) fn remember(world: &mut World, path: PathBuf) {
    let mut recent = with(&path, world.resource::<Files>().recent.clone());
    let kept = world.resource::<Preferences>().change(CONCERN, |kept| {
        // Another window may have opened others.
        if let Some(kept) = kept {
            recent = with(&path, kept);
        }
        recent.clone()
    });
    world.resource_mut::<Files>().recent = recent;
    if let Err(error) = kept {
        let mut notices = world.resource_mut::<Notices>();
        notices.add(Tone::Warning, &error.to_string());
    }
}
