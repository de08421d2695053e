//! Resources that are kept from run to run.

use bevy::prelude::*;
use serde::{Serialize, de::DeserializeOwned};

use crate::{
    panels::messages::{Notices, Tone},
    preferences::Preferences,
};

/// A resource of the user's choices, which has a file in the preferences.
pub(crate) trait Kept:
    Resource + Clone + Default + PartialEq + Serialize + DeserializeOwned
{
    /// The name of the file.
    const CONCERN: &'static str;
}

/// Recalls a resource at the start, and keeps its changes.
pub(crate) fn keep<T: Kept>(app: &mut App) {
    app.init_resource::<T>()
        .init_resource::<Notices>()
        .init_resource::<Preferences>()
        .add_systems(Startup, recall::<T>)
        .add_systems(Update, keep_changes::<T>.run_if(resource_changed::<T>));
}

fn recall<T: Kept>(
    preferences: Res<Preferences>,
    mut commands: Commands,
    mut notices: ResMut<Notices>,
) {
    match preferences.read::<T>(T::CONCERN) {
        Ok(None) => {}
        Ok(Some(kept)) => commands.insert_resource(kept),
        Err(error) => notices.add(Tone::Fault, &error.to_string()),
    }
}

fn keep_changes<T: Kept>(
    mut before: Local<Option<T>>,
    now: Res<T>,
    preferences: Res<Preferences>,
    mut notices: ResMut<Notices>,
) {
    let before = before.replace(now.clone());
    if before.is_some_and(|before| before != *now)
        && let Err(error) = preferences.keep(T::CONCERN, &*now)
    {
        notices.add(Tone::Fault, &error.to_string());
    }
}

#[cfg(test)]
mod tests {
    use std::{env, fs, path::Path};

    use serde::Deserialize;

    use super::*;

    #[derive(Resource, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    struct Favourite(u32);

    impl Kept for Favourite {
        const CONCERN: &'static str = "favourite";
    }

    fn app(folder: &Path) -> App {
        let mut app = App::new();
        app.insert_resource(Preferences::in_folder(folder))
            .add_plugins((MinimalPlugins, keep::<Favourite>));
        app.update();
        app
    }

    #[test]
    fn a_choice_is_kept_once_it_is_made_and_a_damaged_file_is_reported() {
        let name = format!("tabletop-kept-{}", std::process::id());
        let folder = env::temp_dir().join(name);
        let mut first = app(&folder);
        first.update();
        assert!(!folder.exists());
        first.insert_resource(Favourite(7));
        first.update();
        let file = folder.join("favourite.ron");
        assert_eq!(*app(&folder).world().resource::<Favourite>(), Favourite(7));
        fs::write(&file, "(seven)").unwrap();
        let damaged = app(&folder);
        assert_eq!(*damaged.world().resource::<Favourite>(), Favourite(0));
        assert_eq!(damaged.world().resource::<Notices>().iter().count(), 1);
        assert_eq!(fs::read_to_string(file).unwrap(), "(seven)");
        fs::remove_dir_all(folder).unwrap();
    }
}
