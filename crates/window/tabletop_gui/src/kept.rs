//! Resources that are kept from run to run.

use bevy::prelude::*;
use serde::{Serialize, de::DeserializeOwned};
use tabletop_user::{Notices, Tone};

use crate::preferences::Preferences;

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
    let Some(before) = before.filter(|before| *before != *now) else {
        return;
    };
    let kept = preferences.change(T::CONCERN, |kept: Option<T>| match kept {
        Some(kept) => with_changes(&kept, &before, &now),
        None => now.clone(),
    });
    if let Err(error) = kept {
        notices.add(Tone::Fault, &error.to_string());
    }
}

/// What is kept, with the choices that have changed here; those of another window stay.
fn with_changes<T: Kept>(kept: &T, before: &T, now: &T) -> T {
    let changed = || {
        let [mut kept, before, now] = [kept, before, now].map(serde_json::to_value);
        let choices = kept.as_mut().ok()?.as_object_mut()?;
        let (before, now) = (before.ok()?, now.ok()?);
        for (choice, value) in now.as_object()? {
            if before.get(choice) != Some(value) {
                choices.insert(choice.clone(), value.clone());
            }
        }
        serde_json::from_value(kept.ok()?).ok()
    };
    // What has no parts is one choice.
    changed().unwrap_or_else(|| now.clone())
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

    #[derive(Resource, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    struct Favourites {
        number: u32,
        name: Option<String>,
    }

    impl Kept for Favourites {
        const CONCERN: &'static str = "favourites";
    }

    #[test]
    fn two_windows_keep_what_each_has_changed() {
        let name = format!("tabletop-kept-twice-{}", std::process::id());
        let folder = env::temp_dir().join(name);
        let mut windows = [(), ()].map(|()| {
            let mut app = App::new();
            app.insert_resource(Preferences::in_folder(&folder))
                .add_plugins((MinimalPlugins, keep::<Favourites>));
            app.update();
            app.update();
            app
        });
        let [one, other] = &mut windows;
        one.world_mut().resource_mut::<Favourites>().number = 7;
        one.update();
        other.world_mut().resource_mut::<Favourites>().name = Some("cube".into());
        other.update();
        let kept = Preferences::in_folder(&folder).read("favourites").unwrap();
        let expected = Favourites {
            number: 7,
            name: Some("cube".into()),
        };
        assert_eq!(kept, Some(expected));
        fs::remove_dir_all(folder).unwrap();
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
