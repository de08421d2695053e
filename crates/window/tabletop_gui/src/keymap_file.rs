//! Files in which users bind keys: a RON map from the names of actions to the keys that do them.
//!
//! ```ron
//! {
//!     "pause": ["KeyP"],
//!     "redo": ["Ctrl+Shift+KeyZ", "Ctrl+KeyY"],
//!     "clear_table": [], // no key
//! }
//! ```
//!
//! Actions that are not named keep their keys.

use std::{
    collections::{BTreeMap, BTreeSet},
    fmt::{self, Write as _},
    path::{Path, PathBuf},
};

use bevy::prelude::*;
use ron::value::RawValue;
use serde::{
    Deserialize, Deserializer,
    de::{MapAccess, Visitor},
};
use tabletop_core::{RobotLayout, located_ron_fault};
use tabletop_storage::{Symlinks, read_regular_text};
use tabletop_user::{Action, KeyBinding, Keymap, Notices, Situation, Tone};

use crate::{Preferences, preferences::MOST_BYTES};

/// The file that is read when the program starts. Without this resource it is `keys.ron` of the [`Preferences`], if there is one.
#[derive(Resource, Clone, Debug, PartialEq, Eq)]
pub struct KeymapFile(pub PathBuf);

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(Startup, load);
}

fn load(
    named: Option<Res<KeymapFile>>,
    preferences: Res<Preferences>,
    layout: Res<RobotLayout>,
    mut keymap: ResMut<Keymap>,
    mut notices: ResMut<Notices>,
) {
    let path = named.as_ref().map(|file| file.0.as_path());
    let (read, faults) = read(path, &preferences, &layout);
    *keymap = read;
    for fault in faults {
        notices.add(Tone::Fault, &fault);
    }
}

/// Reads the keymap of a file, or that of the preferences, for a robot, with its faults. Without a file, keys have their
/// defaults.
pub fn read(
    path: Option<&Path>,
    preferences: &Preferences,
    layout: &RobotLayout,
) -> (Keymap, Vec<String>) {
    let own = || preferences.file("keys").filter(|path| path.exists());
    let Some(path) = path.map(Path::to_owned).or_else(own) else {
        return shipped(layout);
    };
    match read_text(&path) {
        Ok(text) => {
            let (keymap, faults) = parse(&text, layout);
            let faults = faults.into_iter();
            let located = faults.map(|fault| format!("{}:{fault}", path.display()));
            (keymap, located.collect())
        }
        Err(fault) => (Keymap::of(layout).0, vec![fault]),
    }
}

/// The text of a keymap.
///
/// # Errors
/// It cannot be read; the path is named.
pub fn read_text(path: &Path) -> Result<String, String> {
    let text = read_regular_text(path, MOST_BYTES, Symlinks::Followed);
    text.map_err(|error| format!("{}: {error}", path.display()))
}

/// The keys of a robot as they are shipped, and those of its joints that do not exist or have another meaning already.
fn shipped(layout: &RobotLayout) -> (Keymap, Vec<String>) {
    let (keymap, unknown) = Keymap::of(layout);
    let unknown = unknown.iter();
    let unknown = unknown.map(|fault| format!("{}: {fault}", layout.name));
    let conflicts = keymap.conflicts().into_iter();
    let faults = conflicts.map(|(binding, owner, action)| {
        format!(
            "{}: `{binding}` is a key of `{owner}` already, so it does not do `{action}`",
            layout.name
        )
    });
    let faults = unknown.chain(faults).collect();
    (keymap, faults)
}

/// An action that a file names, and its keys, each with its place.
struct KeymapEntry<'a> {
    action: Action,
    bindings: Vec<(&'a str, KeyBinding)>,
}

/// Reads a keymap. Faulty entries are reported with line and column, and left out. An empty text binds nothing: a shell leaves it empty when it
/// is about to write the file.
pub fn parse(text: &str, layout: &RobotLayout) -> (Keymap, Vec<String>) {
    let (mut keymap, mut faults) = shipped(layout);
    if text.trim().is_empty() {
        return (keymap, faults);
    }
    match ron::from_str::<RawEntries>(text) {
        Ok(entries) => {
            let entries = entries_of(&entries, &keymap, text, &mut faults);
            bind(&mut keymap, entries, text, &mut faults);
        }
        Err(error) => faults.push(located_ron_fault(&error)),
    }
    (keymap, faults)
}

/// Writes a file that names every action, for users to change.
pub fn write(keymap: &Keymap) -> String {
    let mut text = String::from(
        "// Keys are named after their places on a US keyboard: KeyA, Digit1, Slash, ArrowLeft, F1, Space.\n\
         // Ctrl, Alt, Shift and Super stand before a key: \"Ctrl+Shift+KeyZ\". Lines that are left out keep their keys.\n{\n",
    );
    for (group, name) in keymap.groups() {
        let _infallible = writeln!(text, "    // {name}");
        for action in keymap.actions_of(group) {
            let bindings = keymap.bindings(action).iter();
            let bindings: Vec<_> = bindings.map(|binding| format!("\"{binding}\"")).collect();
            let bindings = bindings.join(", ");
            let label = keymap.label(action);
            let _infallible = writeln!(text, "    \"{action}\": [{bindings}], // {label}");
        }
    }
    text + "}\n"
}

fn entries_of<'a>(
    RawEntries(entries): &RawEntries<'a>,
    keymap: &Keymap,
    text: &str,
    faults: &mut Vec<String>,
) -> Vec<KeymapEntry<'a>> {
    let of_baxter = Keymap::default();
    let mut named = BTreeSet::new();
    let mut read = Vec::new();
    for (name, bindings) in entries {
        let bindings = bindings.iter().filter_map(|binding| {
            let parsed = string(binding).and_then(|binding| {
                let parsed = binding.parse::<KeyBinding>();
                parsed.map_err(|error| error.to_string())
            });
            let part = binding.trim().get_ron();
            let reported =
                parsed.map_err(|fault| faults.push(format!("{}: {fault}", place(part, text))));
            Some((part, reported.ok()?))
        });
        let bindings = bindings.collect();
        let action = string(name).and_then(|name| {
            let action = keymap.find(&name);
            if action.is_none() && of_baxter.find(&name).is_some() {
                return Ok(None);
            }
            action.map(Some).ok_or_else(|| {
                format!("there is no action `{name}`; `tabletop keys` lists them all")
            })
        });
        let fault = match action {
            // The file is for Baxter, too, and this robot has no such joint.
            Ok(None) => continue,
            Ok(Some(action)) if named.insert(action) => {
                read.push(KeymapEntry { action, bindings });
                continue;
            }
            Ok(Some(action)) => format!("`{action}` already has its keys further up"),
            Err(fault) => fault,
        };
        let place = place(name.trim().get_ron(), text);
        faults.push(format!("{place}: {fault}"));
    }
    read
}

/// The keys of a file win over those of actions that it does not name, and earlier entries win over later ones.
fn bind(keymap: &mut Keymap, entries: Vec<KeymapEntry>, text: &str, faults: &mut Vec<String>) {
    let mut owners: BTreeMap<(KeyBinding, Situation), (Action, &str)> = BTreeMap::new();
    let named: BTreeSet<_> = entries.iter().map(|entry| entry.action).collect();
    for KeymapEntry { action, bindings } in entries {
        let mut own = Vec::new();
        for (part, binding) in bindings {
            let key = (binding, keymap.situation(action));
            let (owner, _) = *owners.entry(key).or_insert((action, part));
            if owner == action {
                own.push(binding);
            } else {
                let place = place(part, text);
                faults.push(format!(
                    "{place}: `{binding}` is a key of `{owner}` already"
                ));
            }
        }
        keymap.bind(action, own);
    }
    let actions: Vec<_> = keymap.actions().collect();
    for action in actions {
        if named.contains(&action) {
            continue;
        }
        let mut kept = keymap.default_bindings(action).to_vec();
        kept.retain(|&binding| {
            let Some((owner, part)) = owners.get(&(binding, keymap.situation(action))) else {
                return true;
            };
            faults.push(format!(
                "{}: `{owner}` takes `{binding}` from `{action}`: give that another key, or none: \"{action}\": []",
                place(part, text)
            ));
            false
        });
        keymap.bind(action, kept);
    }
}

fn string(value: &RawValue) -> Result<String, String> {
    let read = value.into_rust::<String>();
    read.map_err(|error| format!("{}, expected a text in quotes", error.code))
}

/// Line and column of a part of a text, both from 1 on.
fn place(part: &str, text: &str) -> String {
    let before = &text[..part.as_ptr().addr() - text.as_ptr().addr()];
    let line = before.matches('\n').count() + 1;
    let column = before
        .chars()
        .rev()
        .take_while(|&char| char != '\n')
        .count()
        + 1;
    format!("{line}:{column}")
}

/// The content of a file, in its order, as parts of its text.
struct RawEntries<'a>(Vec<(&'a RawValue, Vec<&'a RawValue>)>);

impl<'de> Deserialize<'de> for RawEntries<'de> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(EntriesVisitor)
    }
}

struct EntriesVisitor;

impl<'de> Visitor<'de> for EntriesVisitor {
    type Value = RawEntries<'de>;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a map from actions to lists of keys: {\"pause\": [\"Space\"]}")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let mut entries = Vec::new();
        while let Some(entry) = map.next_entry()? {
            entries.push(entry);
        }
        Ok(RawEntries(entries))
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn read_text(text: &str) -> (Keymap, Vec<String>) {
        parse(text, RobotLayout::baxter())
    }

    fn binding(text: &str) -> KeyBinding {
        text.parse().unwrap()
    }

    fn faults(text: &str) -> Vec<String> {
        read_text(text).1
    }

    #[test]
    fn a_complete_file_is_read_as_it_is_written() {
        let mut keymap = Keymap::default();
        keymap.bind(Action::Pause, [binding("Ctrl+KeyP"), binding("F5")]);
        keymap.bind(Action::ClearTable, []);
        assert_eq!(read_text(&write(&keymap)), (keymap, vec![]));
    }

    #[test]
    fn actions_that_are_not_named_keep_their_keys() {
        let (keymap, faults) = read_text("{\"pause\": [\"KeyV\"], \"clear_table\": []}");
        assert_eq!(faults, Vec::<String>::new());
        let mut expected = Keymap::default();
        expected.bind(Action::Pause, [binding("KeyV")]);
        expected.bind(Action::ClearTable, []);
        assert_eq!(keymap, expected);
        for nothing in ["{}", "", "\n"] {
            assert_eq!(read_text(nothing), (Keymap::default(), vec![]));
        }
    }

    #[test]
    fn faults_have_places_and_the_rest_works() {
        let text = r#"{
    // what a user may write
    "pauze": ["KeyV"],
    "quit": ["Shift+Qu", "KeyQ", 5], "camera_up": [],
    "redo": ["Strg+KeyY"],
    "quit": ["KeyX"],
    "step": ["KeyQ"],
}"#;
        let (keymap, faults) = read_text(text);
        let expected = [
            "3:5: there is no action `pauze`; `tabletop keys` lists them all",
            "4:14: there is no key `Qu`; keys are named as on a US keyboard: KeyA, Digit1, Space, F1",
            "4:34: Expected string, expected a text in quotes",
            "5:14: there is no modifier `Strg`; it can be Ctrl, Alt, Shift or Super",
            "6:5: `quit` already has its keys further up",
            "7:14: `KeyQ` is a key of `quit` already",
        ];
        assert_eq!(faults, expected);
        assert_eq!(keymap.bindings(Action::Quit), [binding("KeyQ")]);
        assert_eq!(keymap.bindings(Action::Redo), []);
        assert_eq!(keymap.bindings(Action::Step), []);
        assert_eq!(keymap.bindings(Action::Pause), [binding("Space")]);
        assert_eq!(keymap.conflicts(), []);
    }

    #[test]
    fn a_key_that_is_taken_from_an_action_is_reported() {
        let (keymap, faults) = read_text("{\"pause\": [\"KeyR\"]}");
        let expected = "1:12: `pause` takes `KeyR` from `show_robot`: give that another key, or none: \"show_robot\": []";
        assert_eq!(faults, [expected]);
        assert_eq!(keymap.bindings(Action::Pause), [binding("KeyR")]);
        assert_eq!(keymap.conflicts(), []);
    }

    #[test]
    fn two_actions_can_change_keys() {
        let (keymap, faults) = read_text("{\"pause\": [\"KeyR\"], \"show_robot\": [\"Space\"]}");
        assert_eq!(faults, Vec::<String>::new());
        assert_eq!(keymap.bindings(Action::ShowRobot), [binding("Space")]);
    }

    /// The bindings and messages when the program starts with these preferences.
    fn started(text: Option<&str>, name: &str) -> (Keymap, Vec<String>) {
        let folder = format!("tabletop-keys-{name}-{}", std::process::id());
        let folder = std::env::temp_dir().join(folder);
        fs::create_dir_all(&folder).unwrap();
        if let Some(text) = text {
            fs::write(folder.join("keys.ron"), text).unwrap();
        }
        let mut app = App::new();
        app.add_plugins(plugin)
            .insert_resource(Preferences::in_folder(&folder))
            .init_resource::<Keymap>()
            .init_resource::<RobotLayout>()
            .init_resource::<Notices>();
        app.update();
        fs::remove_dir_all(folder).unwrap();
        let notices = app.world().resource::<Notices>().iter();
        let notices = notices.map(ToOwned::to_owned).collect();
        (app.world().resource::<Keymap>().clone(), notices)
    }

    #[test]
    fn the_file_of_the_preferences_is_read_at_the_start_and_its_faults_are_reported() {
        assert_eq!(started(None, "none"), (Keymap::default(), vec![]));
        let (keymap, notices) = started(Some("{\"pause\": [\"KeyV\", \"V\"]}"), "faulty");
        assert_eq!(keymap.bindings(Action::Pause), [binding("KeyV")]);
        assert_eq!(notices.len(), 1);
        assert!(
            notices[0].contains("keys.ron:1:20: there is no key `V`"),
            "{notices:?}"
        );
    }

    #[test]
    fn a_file_that_was_named_must_be_there() {
        let mut app = App::new();
        app.add_plugins(plugin)
            .insert_resource(Preferences::nowhere())
            .insert_resource(KeymapFile("/no such folder/keys.ron".into()))
            .init_resource::<Keymap>()
            .init_resource::<RobotLayout>()
            .init_resource::<Notices>();
        app.update();
        assert_eq!(app.world().resource::<Notices>().iter().len(), 1);
    }

    #[test]
    fn a_malformed_keymap_is_reported_with_its_place() {
        for (text, place) in [
            ("{\n  \"pause\": \"Space\"}", "2:"),
            ("{\n\n  \"pause\" [\"Space\"]}", "3:"),
            ("[\"Space\"]", "1:1"),
        ] {
            let (keymap, faults) = read_text(text);
            assert_eq!(keymap, Keymap::default(), "{text}");
            assert_eq!(faults.len(), 1, "{text}");
            assert!(faults[0].starts_with(place), "{text}: {faults:?}");
        }
        assert_eq!(faults("{\"päuse\": 5}").len(), 1);
    }
}
