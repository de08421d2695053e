//! Recordings of what is done while the simulation waits for a script, as it does in the window.

use std::{fs, path::Path, time::Duration};

use bevy::{prelude::*, time::TimeUpdateStrategy};
use tabletop::{
    core::{Agent, AgentOrder, HeadCamera, TICK_SECONDS},
    prelude::*,
    recorder::{Channels, RecorderPlugin},
    replay::Replay,
    script::{EngineChoice, EngineKind, ScriptPlugin, ScriptSettings, Waiting},
};

/// A script of which every call takes several frames.
const SCRIPT: &str = "import time
def init(aux): pass
def callback(sensor, motor, aux):
    time.sleep(0.02)
    motor.jointVelocities = [[0.2] * 7] * 2
";

struct Window {
    app: App,
}

impl Window {
    fn open(folder: &Path, script: &Path) -> Self {
        let recorder = RecorderPlugin {
            folder: folder.to_owned(),
            ..default()
        };
        let settings = ScriptSettings {
            agent: Some(script.to_owned()),
            engine: EngineChoice::Kind(EngineKind::Python),
            waiting: Waiting::Frame(Duration::from_millis(1)),
            ..default()
        };
        let plugins = TabletopSimPlugins.build();
        let mut app = App::new();
        app.add_plugins(MinimalPlugins)
            .add_plugins(plugins.set(recorder).set(ScriptPlugin { settings }))
            .insert_resource(HeadCamera {
                width: 40,
                height: 30,
                ..default()
            })
            .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f32(
                TICK_SECONDS,
            )));
        app.finish();
        app.cleanup();
        Self { app }
    }

    fn frames_until(&mut self, is_so: impl Fn(&Agent) -> bool) {
        for _ in 0..10_000 {
            if is_so(self.app.world().resource()) {
                return;
            }
            self.app.update();
        }
        panic!("{:?}", self.app.world().resource::<Agent>());
    }

    /// Tells something while a call of the script is waited for, and lets so many frames go by.
    fn tell_while_waiting(&mut self, command: SimCommand, frames: usize) {
        self.frames_until(|agent| matches!(agent, Agent::Waiting { .. }));
        self.app.world_mut().write_message(command);
        (0..frames).for_each(|_| self.app.update());
    }
}

#[test]
fn what_is_told_while_a_script_is_waited_for_is_recorded_in_its_tick() {
    let place = Path::new(env!("CARGO_TARGET_TMPDIR")).join("slow_script");
    let _not_there = fs::remove_dir_all(&place);
    fs::create_dir_all(&place).unwrap();
    let script = place.join("robot.py");
    fs::write(&script, SCRIPT).unwrap();
    let folder = place.join("demo");
    let mut window = Window::open(&folder, &script);
    let world = window.app.world_mut();
    world.write_message(SimCommand::LoadTask("tablesetup/default.xml".into()));
    (0..10).for_each(|_| window.app.update());
    window.app.world_mut().write_message(AgentOrder::Start);
    window.frames_until(|agent| matches!(agent, Agent::Online { .. }));

    let hand = Hand::Any;
    let object = "RedBlock".to_owned();
    window.tell_while_waiting(SimCommand::StartRecording, 300);
    window.tell_while_waiting(SimCommand::Grasp { hand, object }, 300);
    window.tell_while_waiting(SimCommand::SetPaused(true), 60);
    window
        .app
        .world_mut()
        .write_message(SimCommand::SetPaused(false));
    window.tell_while_waiting(SimCommand::Release(hand), 300);
    window.tell_while_waiting(SimCommand::FinishRecording, 100);
    let replay = Replay::read(&folder).unwrap();
    assert_eq!(replay.cut_off_at(), None);
    let replayed = place.join("replayed");
    replay
        .record(replayed.clone(), replay.camera(), Channels::default())
        .unwrap();
    assert_eq!(replay.first_difference(&replayed).unwrap(), None);
    for segment in ["0/0.png", "1.txt", "2.txt"] {
        assert!(folder.join(segment).exists(), "{segment}");
    }
}
