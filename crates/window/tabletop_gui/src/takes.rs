//! The name, folder and number of the next recording, kept between runs.

use std::path::{Path, PathBuf};

use bevy::prelude::*;
use serde::{Deserialize, Serialize};
use tabletop_core::{RecordingFact, SimFact};
use tabletop_storage::Storage;
use tabletop_user::{NextTake, Notices, Tone};

use crate::{files::short_name, preferences::Preferences};

/// Its name in the preferences.
const CONCERN: &str = "recordings";

/// What is kept of the next take.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
struct KeptTake {
    folder: PathBuf,
    name: String,
}

impl KeptTake {
    fn of(take: &NextTake) -> Self {
        Self {
            folder: take.shelf.clone(),
            name: take.name.clone(),
        }
    }
}

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(Startup, recall)
        .add_systems(Update, (number, keep).chain());
}

fn recall(preferences: Res<Preferences>, mut take: ResMut<NextTake>, mut notices: ResMut<Notices>) {
    match preferences.read::<KeptTake>(CONCERN) {
        Ok(kept) => {
            let KeptTake { folder, name } = kept.unwrap_or_default();
            take.shelf = folder;
            take.name = NextTake::usable_name(&name);
        }
        Err(error) => notices.add(Tone::Fault, &error.to_string()),
    }
}

/// Numbers the next take when a recording has begun or ended, and when another name or folder is chosen.
fn number(
    mut facts: MessageReader<SimFact>,
    mut numbered: Local<Option<KeptTake>>,
    mut take: ResMut<NextTake>,
) {
    let has_begun_or_ended = |fact: &SimFact| match fact {
        SimFact::Recording(
            RecordingFact::Started { .. }
            | RecordingFact::Finished { .. }
            | RecordingFact::Failed { .. },
        ) => true,
        SimFact::Scene(_)
        | SimFact::History(_)
        | SimFact::Hand(_)
        | SimFact::Mechanism(_)
        | SimFact::Robot(_)
        | SimFact::Refused { .. } => false,
    };
    let has_changed = facts.read().filter(|fact| has_begun_or_ended(fact)).count() > 0;
    let now = KeptTake::of(&take);
    if has_changed || numbered.as_ref() != Some(&now) {
        *numbered = Some(now);
        let next = next_number(&take);
        if take.number != next {
            take.number = next;
        }
    }
}

/// One more than the largest number of the takes of this name; folders that cannot be read have none.
fn next_number(take: &NextTake) -> u32 {
    let folder = match take.shelf.as_os_str().is_empty() {
        true => Path::new("."),
        false => &take.shelf,
    };
    let entries = Storage::default().entries(folder).unwrap_or_default();
    let taken = entries
        .iter()
        .filter_map(|entry| take.number_of(&short_name(entry)));
    taken.max().map_or(1, |largest| largest.saturating_add(1))
}

fn keep(
    mut kept: Local<Option<KeptTake>>,
    take: Res<NextTake>,
    preferences: Res<Preferences>,
    mut notices: ResMut<Notices>,
) {
    let now = KeptTake::of(&take);
    if kept.as_ref() == Some(&now) {
        return;
    }
    let is_first = kept.is_none();
    if !is_first && let Err(error) = preferences.keep(CONCERN, &now) {
        notices.renew(Tone::Fault, &error.to_string());
    }
    *kept = Some(now);
}

#[cfg(test)]
mod tests {
    use std::{env, fs, process};

    use tabletop_core::{CommandId, CorePlugin};
    use tabletop_user::UserPlugin;

    use super::*;

    fn app(preferences: &Preferences) -> App {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default(), UserPlugin, plugin))
            .insert_resource(preferences.clone())
            .init_resource::<Notices>();
        app.update();
        app
    }

    #[test]
    fn takes_are_counted_and_their_name_is_kept() {
        let folder = env::temp_dir().join(format!("tabletop-takes-{}", process::id()));
        for taken in ["tower-01", "tower-07", "tower-x", "other-09"] {
            fs::create_dir_all(folder.join("shelf").join(taken)).unwrap();
        }
        let preferences = Preferences::in_folder(folder.join("config"));
        let mut first = app(&preferences);
        let mut take = first.world_mut().resource_mut::<NextTake>();
        assert_eq!(take.name, "");
        take.shelf = folder.join("shelf");
        take.name = "tower".into();
        first.update();
        let next = |app: &App| app.world().resource::<NextTake>().folder();
        assert_eq!(next(&first), folder.join("shelf/tower-08"));

        fs::create_dir(folder.join("shelf/tower-08")).unwrap();
        let started = RecordingFact::Started {
            cause: CommandId(0),
            folder: folder.join("shelf/tower-08"),
            moved_aside: None,
        };
        first.world_mut().write_message(SimFact::from(started));
        first.update();
        assert_eq!(next(&first), folder.join("shelf/tower-09"));
        assert_eq!(next(&app(&preferences)), folder.join("shelf/tower-09"));
        fs::remove_dir_all(folder).unwrap();
    }
}
