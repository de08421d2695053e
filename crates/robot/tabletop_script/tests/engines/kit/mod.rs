//! A robot at a table that scripts drive.

#![allow(dead_code, clippy::allow_attributes, reason = "each test uses a part")]

use std::{
    fs,
    path::{Path, PathBuf},
    sync::atomic::{AtomicU32, Ordering},
    time::{Duration, Instant},
};

use bevy::{ecs::message::MessageCursor, prelude::*, time::TimeUpdateStrategy};
use tabletop_camera::CameraPlugin;
use tabletop_core::{
    Agent, CorePlugin, Markers, Robot, SceneCommand, ScriptCommand, ScriptEvent, SimCommand,
    SimSystems, SimTick, StepApp as _, TICK_SECONDS, WriteCommand as _,
};
use tabletop_demonstrator::DemonstratorPlugin;
use tabletop_drive::DrivePlugin;
use tabletop_physics::PhysicsPlugin;
use tabletop_robot::RobotPlugin;
use tabletop_scene::ScenePlugin;
use tabletop_script::{EngineChoice, ScriptPlugin, ScriptSettings, Waiting};

/// Longer than anything takes here.
pub const PATIENCE: Duration = Duration::from_secs(300);

/// A folder for a test's files.
pub struct Folder(pub PathBuf);

impl Folder {
    pub fn new(files: &[(&str, &str)]) -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let count = COUNT.fetch_add(1, Ordering::Relaxed);
        let name = format!("tabletop-script-{}-{count}", std::process::id());
        let folder = Self(std::env::temp_dir().join(name));
        fs::create_dir_all(&folder.0).unwrap();
        for (name, text) in files {
            folder.write(name, text);
        }
        folder
    }

    /// A pair of scripts that agentBehavior.m names.
    pub fn pair(init: &str, callback: &str) -> Self {
        let names = "function [i, c] = agentBehavior()\ni = @testInit;\nc = @testCallback;\nend\n";
        Self::new(&[
            ("agentBehavior.m", names),
            ("testInit.m", init),
            ("testCallback.m", callback),
        ])
    }

    pub fn write(&self, name: &str, text: &str) {
        fs::write(self.0.join(name), text).unwrap();
    }

    /// Settings with which an Octave runs its scripts.
    pub fn settings(&self) -> ScriptSettings {
        octave(&self.0)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        drop(fs::remove_dir_all(&self.0));
    }
}

/// Settings with which an Octave runs the scripts of a folder.
pub fn octave(folder: &Path) -> ScriptSettings {
    let Ok(engine) = "octave".parse::<EngineChoice>();
    let mut settings = ScriptSettings {
        engine,
        agent: Some(folder.to_owned()),
        ..ScriptSettings::default()
    };
    settings.timeouts.start = PATIENCE;
    settings.timeouts.init = PATIENCE;
    settings.timeouts.step = PATIENCE;
    settings
}

/// Runs a script until it fails; returns why.
pub fn failure(settings: ScriptSettings) -> String {
    let mut stage = Stage::start(settings);
    stage.ticks_until(|stage| stage.failure().is_some());
    assert_eq!(stage.agent(), &Agent::Failed);
    stage.assert_at_rest();
    assert!(!stage.events.contains(&ScriptEvent::Stopped));
    stage.failure().unwrap().to_owned()
}

/// Positions of the robot's joints.
pub fn positions(robot: &Robot) -> Vec<f64> {
    robot.joints.iter().map(|joint| joint.position).collect()
}

/// Positions of all joints at the end of each tick in which a script was called.
#[derive(Resource, Default)]
pub struct Track(pub Vec<Vec<f64>>);

fn note(agent: Res<Agent>, robot: Res<Robot>, mut track: ResMut<Track>) {
    if matches!(*agent, Agent::Online { .. }) {
        track.0.push(positions(&robot));
    }
}

pub struct Stage {
    pub app: App,
    cursor: MessageCursor<ScriptEvent>,
    pub events: Vec<ScriptEvent>,
}

impl Stage {
    /// An empty table, the hidden robot, and a script that was commanded to start.
    pub fn start(settings: ScriptSettings) -> Self {
        let in_frames = settings.waiting != Waiting::Blocking;
        let mut app = App::new();
        app.add_plugins((
            MinimalPlugins,
            CorePlugin::default(),
            PhysicsPlugin::default(),
        ))
        .add_plugins((
            ScenePlugin,
            DemonstratorPlugin,
            RobotPlugin::default(),
            DrivePlugin,
            CameraPlugin,
        ))
        .add_plugins(ScriptPlugin { settings })
        .init_resource::<Track>()
        .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f32(
            TICK_SECONDS,
        )))
        .add_systems(FixedUpdate, note.in_set(SimSystems::Record));
        let mut stage = Self {
            app,
            cursor: MessageCursor::default(),
            events: Vec::new(),
        };
        stage.command(SceneCommand::Set(Box::default()));
        if in_frames {
            stage.app.finish();
            stage.app.cleanup();
            (0..3).for_each(|_| stage.frame());
        } else {
            stage.app.start().step(1);
        }
        stage.script(ScriptCommand::Start);
        stage
    }

    pub fn command(&mut self, command: impl Into<SimCommand>) {
        self.app.world_mut().write_command(command);
    }

    pub fn script(&mut self, command: ScriptCommand) {
        self.app.world_mut().write_message(command);
    }

    /// Simulates this number of ticks.
    pub fn ticks(&mut self, ticks: u64) {
        for _ in 0..ticks {
            self.app.step(1);
            self.listen();
        }
    }

    /// A frame of a program with a window.
    pub fn frame(&mut self) {
        self.app.update();
        self.listen();
    }

    /// Frames until something is so.
    pub fn frames_until(&mut self, is_so: impl Fn(&Self) -> bool) -> u32 {
        self.repeat_until(Self::frame, is_so)
    }

    /// Ticks until something is so.
    pub fn ticks_until(&mut self, is_so: impl Fn(&Self) -> bool) -> u32 {
        self.repeat_until(|stage| stage.ticks(1), is_so)
    }

    fn repeat_until(&mut self, step: impl Fn(&mut Self), is_so: impl Fn(&Self) -> bool) -> u32 {
        let start = Instant::now();
        let mut steps = 0;
        while !is_so(self) {
            assert!(
                start.elapsed() < PATIENCE,
                "{:?} {:?}",
                self.agent(),
                self.events
            );
            step(self);
            steps += 1;
        }
        steps
    }

    fn listen(&mut self) {
        let messages = self.app.world().resource::<Messages<ScriptEvent>>();
        self.events.extend(self.cursor.read(messages).cloned());
    }

    pub fn agent(&self) -> &Agent {
        self.app.world().resource()
    }

    pub fn is_online(&self) -> bool {
        matches!(self.agent(), Agent::Online { .. })
    }

    pub fn robot(&self) -> &Robot {
        self.app.world().resource()
    }

    pub fn markers(&self) -> usize {
        self.app.world().resource::<Markers>().0.len()
    }

    pub fn tick(&self) -> u64 {
        self.app.world().resource::<SimTick>().0
    }

    pub fn track(&self) -> &[Vec<f64>] {
        &self.app.world().resource::<Track>().0
    }

    /// Output of the script, and remarks about it.
    pub fn printed(&self) -> String {
        let lines = self.events.iter().filter_map(|event| match event {
            ScriptEvent::Printed { line, .. } | ScriptEvent::Noted { line } => Some(line.as_str()),
            ScriptEvent::Started { .. } | ScriptEvent::Stopped | ScriptEvent::Failed { .. } => None,
        });
        lines.collect::<Vec<_>>().join("\n")
    }

    /// The reason why the script has failed.
    pub fn failure(&self) -> Option<&str> {
        self.events.iter().find_map(|event| match event {
            ScriptEvent::Failed { reason } => Some(reason.as_str()),
            ScriptEvent::Started { .. }
            | ScriptEvent::Printed { .. }
            | ScriptEvent::Noted { .. }
            | ScriptEvent::Stopped => None,
        })
    }

    pub fn has_stopped(&self) -> bool {
        self.events.contains(&ScriptEvent::Stopped)
    }

    /// Nothing is left of a script: no marker, no motion; and the simulation goes on.
    pub fn assert_at_rest(&mut self) {
        self.ticks(1);
        assert_eq!(self.markers(), 0);
        let before = positions(self.robot());
        let tick = self.tick();
        self.ticks(5);
        assert_eq!(positions(self.robot()), before);
        assert!(
            self.robot()
                .joints
                .iter()
                .all(|joint| joint.velocity == 0.0)
        );
        assert_eq!(self.tick(), tick + 5);
    }
}
