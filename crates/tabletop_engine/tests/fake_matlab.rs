//! The start of MATLAB, with a stand-in of that name that runs the text after "-r" in Octave.

#![cfg(unix)]
mod common;

use std::{fs, os::unix::fs::PermissionsExt as _};

use common::{Folder, Session, limits};
use tabletop_engine::{EngineChoice, EngineConfig, EngineKind, EngineLocator, Platform, Trigger};

#[test]
fn a_matlab_on_the_path_is_started_and_driven() {
    let stand_in = "#!/bin/sh\n[ \"$1 $2 $3\" = '-nosplash -nodesktop -r' ] || exit 9\nexec octave-cli -q --eval \"$4\"\n";
    let bin = Folder::new(&[("matlab", stand_in)]);
    let program = bin.0.join("matlab");
    fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
    let surroundings = EngineLocator {
        platform: Platform::Linux,
        path: vec![bin.0.clone()],
        variable: None,
        root: bin.0.clone(),
    };
    let found = surroundings.find(&EngineChoice::Auto).unwrap();
    assert_eq!((found.kind, &found.program), (EngineKind::Matlab, &program));
    let mut config = EngineConfig::new(found);
    assert_eq!(config.trigger, Trigger::Poll);
    let folder = Folder::pair(
        "aux.drawMarkers = aux.maxJointAngles(:, 1:3);",
        "motor.headVelocity = 1; aux.exit = 1;",
    );
    config.agent = folder.0.clone();
    let session = Session::start(config).unwrap();
    assert!(
        session
            .description
            .ends_with(&format!("({})", program.display()))
    );
    let reply = session.init().unwrap();
    assert_eq!(reply.draw_markers[1], limits().max_joint_angles[1][..3]);
    let reply = session.step(&common::at_rest()).unwrap();
    assert!(reply.exit && reply.motor.head_velocity == Some(1.0));
}

#[test]
fn a_program_that_is_no_engine_is_reported() {
    let bin = Folder::new(&[(
        "matlab",
        "#!/bin/sh\necho licence has expired >&2\nexit 7\n",
    )]);
    let program = bin.0.join("matlab");
    fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
    let found = EngineLocator::system()
        .find(&EngineChoice::Program(program))
        .unwrap();
    let error = Session::start(EngineConfig::new(found))
        .err()
        .unwrap()
        .to_string();
    assert!(
        error.contains('7') && error.contains("licence has expired"),
        "{error}"
    );
}
