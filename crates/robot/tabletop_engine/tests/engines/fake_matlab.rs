//! The start of MATLAB, with a stand-in of that name that runs the text after "-r" in Octave.

use tabletop_engine::{EngineChoice, EngineConfig, EngineKind, EngineLocator, Platform, Trigger};
use tabletop_harness::test_with;

use crate::common::{self, Folder, Session, executable, limits};

#[test_with(Octave)]
fn a_matlab_on_the_path_is_started_and_driven() {
    let stand_in = "#!/bin/sh\n[ \"$1 $2 $3\" = '-nosplash -nodesktop -r' ] || exit 9\nexec octave-cli -q --eval \"$4\"\n";
    let (bin, program) = executable("matlab", stand_in);
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
