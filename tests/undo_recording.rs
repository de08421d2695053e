//! A recording in which something was undone is, byte for byte, the recording in which it was never done.

use std::{
    fs,
    path::{Path, PathBuf},
};

use bevy::prelude::*;
use tabletop::{
    core::History, headless_app_with, prelude::*, recorder::RecorderPlugin,
    replay::first_difference,
};

/// Commands, and how many ticks to simulate with them.
type Act = (Vec<SimCommand>, u64);

fn grasp(hand: Hand, object: &str) -> SimCommand {
    SimCommand::Grasp {
        hand,
        object: object.into(),
    }
}

fn move_to(hand: Hand, location: (f32, f32, f32)) -> SimCommand {
    SimCommand::MoveTo {
        hand,
        location: location.into(),
    }
}

/// What is done before and after the detour, which begins in the middle of a fall.
fn way() -> [Vec<Act>; 2] {
    use Hand::{Left, Right};
    [
        vec![
            (
                vec![SimCommand::LoadTask("tablesetup/default.xml".into())],
                40,
            ),
            (vec![SimCommand::StartRecording], 7),
            (vec![grasp(Right, "RedBlock")], 5),
            (vec![move_to(Right, (-1.5, 0.2, 5.0))], 40),
            (vec![SimCommand::Release(Right)], 9),
        ],
        vec![
            (vec![grasp(Left, "GreenBlock")], 1),
            (vec![move_to(Left, (4.0, 2.0, 3.0))], 45),
            (vec![SimCommand::Release(Left)], 80),
            (vec![SimCommand::FinishRecording], 1),
        ],
    ]
}

fn detour() -> Vec<Act> {
    vec![
        (vec![grasp(Hand::Left, "RedBlock")], 20),
        (vec![move_to(Hand::Left, (-5.0, -4.0, 2.0))], 33),
        (vec![grasp(Hand::Both, "GreenBlock")], 3),
        (vec![SimCommand::Destroy(Hand::Both)], 28),
    ]
}

struct Demonstration {
    app: App,
    folder: PathBuf,
}

impl Demonstration {
    fn new(name: &str) -> Self {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        let _ = fs::remove_dir_all(&folder);
        let recorder = RecorderPlugin {
            folder: folder.clone(),
            ..default()
        };
        Self {
            app: headless_app_with(TabletopSimPlugins.build().set(recorder)),
            folder,
        }
    }

    fn act(&mut self, acts: &[Act]) {
        for (commands, ticks) in acts {
            for command in commands {
                self.app.world_mut().write_message(command.clone());
            }
            self.app.step(*ticks);
        }
    }

    fn undoable(&self) -> usize {
        self.app.world().resource::<History>().undoable
    }
}

#[test]
fn what_was_undone_left_no_trace_on_disk() {
    let [before, mut after] = way();
    let mut straight = Demonstration::new("straight");
    straight.act(&before);
    straight.act(&after);

    let mut with_detour = Demonstration::new("with_detour");
    with_detour.act(&before);
    let segments = with_detour.undoable();
    with_detour.act(&detour());
    let undone = with_detour.undoable() - segments;
    assert!(undone >= 3, "only {undone} segments were begun");
    // In the tick that undoes, the way goes on.
    let commands = &mut after[0].0;
    commands.splice(0..0, vec![SimCommand::Undo; undone]);
    with_detour.act(&after);

    let text = fs::read_to_string(straight.folder.join("3.txt")).unwrap();
    assert!(text.contains("grasp,LeftHand,GreenBlock"), "{text}");
    let difference = first_difference(&straight.folder, &with_detour.folder).unwrap();
    assert_eq!(difference, None);
}

#[test]
fn what_was_undone_and_redone_is_there_again() {
    let [before, _] = way();
    let finish = [(vec![SimCommand::FinishRecording], 1)];
    let mut straight = Demonstration::new("straight_on");
    straight.act(&before);
    straight.act(&detour());
    straight.act(&finish);

    let mut there_and_back = Demonstration::new("there_and_back");
    there_and_back.act(&before);
    there_and_back.act(&detour());
    let undone = 3;
    let mut commands = vec![SimCommand::Undo; undone];
    commands.extend(vec![SimCommand::Redo; undone]);
    commands.push(SimCommand::FinishRecording);
    there_and_back.act(&[(commands, 1)]);

    let difference = first_difference(&straight.folder, &there_and_back.folder).unwrap();
    assert_eq!(difference, None);
}
