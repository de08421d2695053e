//! Python as an engine, with a real python3.

mod exchange;
mod faults;
mod processes;

use std::path::PathBuf;

use tabletop_engine::{EngineChoice, EngineConfig, EngineKind, EngineLocator};

use crate::common::{self, Folder, Session};

fn config(file: PathBuf) -> EngineConfig {
    let found = EngineLocator::system().find(&EngineChoice::Kind(EngineKind::Python));
    let found = found.unwrap_or_else(|error| panic!("these tests need python3: {error}"));
    let mut config = EngineConfig::new(found);
    config.agent = file;
    config.timeouts = common::patient();
    config
}

fn start(script: &str) -> (Folder, Session) {
    let folder = Folder::new(&[("robot.py", script)]);
    let session = Session::start(config(folder.0.join("robot.py"))).unwrap();
    (folder, session)
}

/// A script with an init that does nothing, and a callback of this line.
fn of_callback(line: &str) -> String {
    format!("import os, sys\ndef init(aux): pass\ndef callback(sensor, motor, aux):\n    {line}\n")
}
