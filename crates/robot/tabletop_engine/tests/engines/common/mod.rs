//! Shared helpers of the tests: engines that run scripts written on the spot, and a robot to move.

#![allow(dead_code, clippy::allow_attributes, reason = "each test uses a part")]
pub mod robot;

use std::{
    fs,
    path::{Path, PathBuf},
    sync::atomic::{AtomicU32, Ordering},
    time::Duration,
};

use tabletop_engine::{
    Aux, EngineChoice, EngineConfig, EngineError, EngineHandle, EngineKind, EngineLocator,
    InitReply, Reply, ScriptError, Sensor, StepReply, Timeouts, Trigger,
};

/// Longer than anything takes here, also on a machine that is busy with other things.
pub const PATIENCE: Duration = Duration::from_secs(300);

/// A folder for a test's files.
pub struct Folder(pub PathBuf);

impl Folder {
    pub fn new(files: &[(&str, &str)]) -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let count = COUNT.fetch_add(1, Ordering::Relaxed);
        let folder =
            std::env::temp_dir().join(format!("tabletop-test-{}-{count}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        for (name, text) in files {
            fs::write(folder.join(name), text).unwrap();
        }
        Self(folder)
    }

    /// A pair of scripts that agentBehavior.m names.
    pub fn pair(init: &str, callback: &str) -> Self {
        Self::new(&[
            (
                "agentBehavior.m",
                "function [i, c] = agentBehavior()\ni = @testInit;\nc = @testCallback;\nend\n",
            ),
            ("testInit.m", init),
            ("testCallback.m", callback),
        ])
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        drop(fs::remove_dir_all(&self.0));
    }
}

/// A folder with a program of this text, and the program.
#[cfg(unix)]
pub fn executable(name: &str, text: &str) -> (Folder, PathBuf) {
    let folder = Folder::new(&[("text", text)]);
    let program = folder.0.join(name);
    // Another process writes it: processes that other tests start would inherit the open file from this one, and it could not be run.
    let mut install = std::process::Command::new("install");
    install.args(["-m", "755"]).arg(folder.0.join("text"));
    assert!(install.arg(&program).status().unwrap().success());
    (folder, program)
}

/// An Octave that polls or not, for the scripts of a folder.
pub fn octave(agent: &Path, trigger: Trigger) -> EngineConfig {
    let found = EngineLocator::system().find(&EngineChoice::Kind(EngineKind::Octave));
    let found =
        found.unwrap_or_else(|error| panic!("these tests need GNU Octave (octave-cli): {error}"));
    let mut config = EngineConfig::new(found);
    config.trigger = trigger;
    config.agent = agent.to_owned();
    config.timeouts = patient();
    config
}

/// Timeouts that end before the tests' patience does.
pub fn patient() -> Timeouts {
    let most = PATIENCE * 4 / 5;
    Timeouts {
        start: most,
        init: most,
        step: most,
    }
}

pub const TRIGGERS: [Trigger; 2] = [Trigger::Stdin, Trigger::Poll];

/// An engine whose replies are waited for.
pub struct Session {
    pub engine: EngineHandle,
    pub description: String,
}

impl Session {
    pub fn start(config: EngineConfig) -> Result<Self, EngineError> {
        let engine = EngineHandle::start(config)?;
        let reply = next(&engine)?;
        let Reply::Started { description } = reply else {
            panic!("{reply:?}");
        };
        Ok(Self {
            engine,
            description,
        })
    }

    /// An Octave that has started.
    pub fn octave(agent: &Path, trigger: Trigger) -> Self {
        Self::start(octave(agent, trigger)).unwrap()
    }

    pub fn init(&self) -> Result<InitReply, EngineError> {
        self.engine.init(limits());
        let reply = next(&self.engine)?;
        let Reply::Init(reply) = reply else {
            panic!("{reply:?}");
        };
        Ok(reply)
    }

    pub fn step(&self, sensor: &Sensor) -> Result<StepReply, EngineError> {
        self.engine.step(sensor.clone());
        let reply = next(&self.engine)?;
        let Reply::Step(reply) = reply else {
            panic!("{reply:?}");
        };
        Ok(*reply)
    }

    /// The printed lines, after waiting for one that holds `text`.
    pub fn printed(&self, text: &str) -> String {
        let mut all = String::new();
        for _ in 0..2000 {
            for line in self.engine.drain_console() {
                all += &line.text;
                all += "\n";
            }
            if all.contains(text) {
                break;
            }
            std::thread::sleep(Duration::from_millis(10));
        }
        all
    }
}

fn next(engine: &EngineHandle) -> Result<Reply, EngineError> {
    let reply = engine.recv_timeout(PATIENCE).unwrap();
    if let Reply::Failed(error) = reply {
        return Err(error);
    }
    Ok(reply)
}

/// The script's error, which the result must be.
pub fn script_error<T: std::fmt::Debug>(result: Result<T, EngineError>) -> ScriptError {
    match result {
        Err(EngineError::Script(error)) => error,
        other => panic!("{other:?}"),
    }
}

/// The sensor of a robot at rest.
pub fn at_rest() -> Sensor {
    Sensor::at_rest([2, 7])
}

/// The limits of the robot's joints.
pub fn limits() -> Aux {
    Aux {
        min_joint_angles: [[-1.7, -2.147, -3.054, -0.05, -3.059, -1.571, -3.059]; 2].into(),
        max_joint_angles: [[1.7, 1.047, 3.054, 2.618, 3.059, 2.094, 3.059]; 2].into(),
    }
}
