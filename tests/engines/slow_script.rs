//! Recordings of acts while the simulation waits for a script, as in the window.

use std::{fs, time::Duration};

use bevy::prelude::*;
use tabletop::{
    core::{Agent, ScriptCommand},
    prelude::*,
    script::{EngineChoice, EngineKind, ScriptPlugin, ScriptSettings, Waiting},
};
use tabletop_harness::test_with;

use crate::{
    demonstration::{assert_replays, fresh_folder},
    window::Window,
};

/// A script of which every call takes several frames.
const SCRIPT: &str = "import time
def init(aux): pass
def callback(sensor, motor, aux):
    time.sleep(0.02)
    motor.jointVelocities = [[0.2] * 7] * 2
";

fn is_waiting(world: &World) -> bool {
    matches!(world.resource(), Agent::Waiting { .. })
}

fn is_online(world: &World) -> bool {
    matches!(world.resource(), Agent::Online { .. })
}

impl Window {
    /// Gives a command while a call of the script is waited for, and lets this many frames pass.
    fn give_while_waiting(&mut self, command: impl Into<SimCommand>, frames: usize) {
        self.frames_until(is_waiting);
        self.give(command);
        self.frames(frames);
    }
}

#[test_with(Python)]
fn commands_given_while_a_script_is_waited_for_are_recorded_in_their_tick() {
    let place = fresh_folder("slow_script");
    fs::create_dir_all(&place).unwrap();
    let script = place.join("robot.py");
    fs::write(&script, SCRIPT).unwrap();
    let settings = ScriptSettings {
        agent: Some(script),
        engine: EngineChoice::Kind(EngineKind::Python),
        waiting: Waiting::Frame(Duration::from_millis(1)),
        ..default()
    };
    let mut window = Window::open("slow_script_demo", |plugins| {
        plugins.set(ScriptPlugin { settings })
    });
    window.give(SceneCommand::Load("tablesetup/default.xml".into()));
    window.frames(10);
    window.write(ScriptCommand::Start);
    window.frames_until(is_online);

    let hand = Hand::Any;
    let object = "RedBlock".to_owned();
    window.give_while_waiting(RecordingCommand::Start, 300);
    window.give_while_waiting(HandCommand::Grasp { hand, object }, 300);
    window.give_while_waiting(ClockCommand::SetPaused(true), 60);
    window.give(ClockCommand::SetPaused(false));
    window.give_while_waiting(HandCommand::Release(hand), 300);
    window.give_while_waiting(RecordingCommand::Finish, 100);
    assert_replays(&window.folder);
    for segment in ["0/0.png", "1.txt", "2.txt"] {
        assert!(window.folder.join(segment).exists(), "{segment}");
    }
}
