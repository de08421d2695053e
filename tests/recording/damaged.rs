//! Recordings that were changed by accident or by a stranger: they are refused or replayed, and harm nothing.

use std::{fs, path::Path};

use bevy::prelude::*;
use proptest::prelude::*;
use tabletop::{TabletopSimPlugins, headless_app_with, prelude::*, replay::Replay};

use crate::demonstration::{Demonstration, fresh_folder_in_memory};

/// Texts that a change may put somewhere.
const TEXTS: [&str; 16] = [
    "0",
    "-1",
    "1e300",
    "1e39",
    "18446744073709551615",
    "4294967295",
    "99999",
    "null",
    "true",
    "[]",
    "{}",
    "[[[[",
    "\"\"",
    "\\n",
    "{\"Composite\":{\"parts\":[]}}",
    "/dev/zero",
];

/// A change: removes this many bytes at a place, and puts a text there.
#[derive(Clone, Debug)]
struct Change {
    at: prop::sample::Index,
    out: usize,
    text: prop::sample::Index,
}

fn change() -> impl Strategy<Value = Change> {
    let index = any::<prop::sample::Index>;
    (index(), 0_usize..8, index()).prop_map(|(at, out, text)| Change { at, out, text })
}

impl Change {
    fn make(&self, bytes: &mut Vec<u8>) {
        let at = self.at.index(bytes.len());
        let end = bytes.len().min(at + self.out);
        bytes.splice(at..end, self.text.get(&TEXTS).bytes());
    }

    /// Changes a number instead, wherever one is next.
    fn make_number(&self, bytes: &mut Vec<u8>) {
        let at = self.at.index(bytes.len());
        let is_of_number = |byte: &u8| byte.is_ascii_digit() || b"+-.e".contains(byte);
        if let Some(start) = bytes[at..].iter().position(is_of_number) {
            let start = at + start;
            let length = bytes[start..].iter().position(|byte| !is_of_number(byte));
            let end = length.map_or(bytes.len(), |length| start + length);
            bytes.splice(start..end, self.text.get(&TEXTS).bytes());
        }
    }
}

fn session() -> Vec<u8> {
    let mut demonstration = Demonstration::new("damaged");
    let hand = Hand::Any;
    let object = "RedBlock".to_owned();
    demonstration.act(&[
        (
            vec![SceneCommand::Load("tablesetup/default.xml".into()).into()],
            2,
        ),
        (vec![RecordingCommand::Start.into()], 2),
        (vec![HandCommand::Grasp { hand, object }.into()], 2),
        (
            vec![SceneCommand::Load("tablesetup/chain.xml".into()).into()],
            2,
        ),
        (vec![RobotCommand::Show(true).into()], 2),
        (vec![RecordingCommand::Finish.into()], 1),
    ]);
    fs::read(demonstration.folder.join("session.jsonl")).unwrap()
}

/// Reads a folder that may be a recording, and replays a second of it.
fn try_to_replay(folder: &Path) {
    if let Ok(replay) = Replay::read(folder) {
        let mut app = headless_app_with(replay.plugins());
        replay.play_in(&mut app);
        app.step(60);
    }
}

#[test]
fn a_changed_session_is_refused_or_replayed() {
    let session = session();
    let folder = fresh_folder_in_memory("damaged_session");
    fs::create_dir_all(folder.join("0")).unwrap();
    for file in ["0.txt", "states.csv", "joints.csv"] {
        fs::write(folder.join(file), "").unwrap();
    }
    proptest!(
        ProptestConfig::with_cases(64),
        |(changes in prop::collection::vec((any::<bool>(), change()), 1..3))| {
            let mut bytes = session.clone();
            for (is_number, change) in &changes {
                match is_number {
                    true => change.make_number(&mut bytes),
                    false => change.make(&mut bytes),
                }
            }
            fs::write(folder.join("session.jsonl"), bytes).unwrap();
            try_to_replay(&folder);
        }
    );
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn quaternions_that_are_almost_of_length_one_are_taken() {
    let mut app = headless_app_with(TabletopSimPlugins);
    let shape = Shape::Cylinder {
        radius: 0.5,
        yspan: 1.0,
        color: Rgb::GRAY,
    };
    let rotation = Quat::from_xyzw(0.0, 0.0, -0.705, 0.7122);
    let pose = Pose::new(Vec3::Z, rotation);
    let object = SceneItem::Object(ObjectSpec::new("peg", pose, 1.0, shape));
    let scene = SceneSpec {
        items: vec![object],
        ..default()
    };
    app.world_mut()
        .write_command_of(Actor::App, SceneCommand::Set(Box::new(scene)));
    app.step(120);
    let peg = app.world().resource::<ObjectIndex>().get("peg").unwrap();
    let place = app.world().get::<Transform>(peg).unwrap();
    assert!((place.translation.z - 0.5).abs() < 0.01, "{place:?}");
}
