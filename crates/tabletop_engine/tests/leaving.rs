//! Scripts that are left by a "break" outside a loop, as MATLAB allows.

mod common;

use std::fs;

use common::{Folder, Session, TRIGGERS};
use tabletop_engine::Sensor;

#[test]
fn only_the_word_that_leaves_is_replaced() {
    let callback = "n = n + 1; % here we break\nmotor.headVelocity = n;\n\
                    for k = 1:3, break, end, if n < 3, disp('break'), break, end\n\
                    \tif n < 4, break; end % or break\naux.exit = k;\n";
    for trigger in TRIGGERS {
        let folder = Folder::pair("n = 0;", callback);
        let session = Session::octave(&folder.0, trigger);
        for _ in 0..2 {
            session.init().unwrap();
            let exits = [(); 4].map(|()| session.step(&Sensor::default()).unwrap().exit);
            assert_eq!(exits, [false, false, false, true]);
            let printed = session.printed("\nbreak\nbreak\n");
            assert!(printed.contains("\nbreak\nbreak\n"), "{printed}");
            assert!(!printed.contains("warning"), "{printed}");
        }
    }
}

#[test]
fn scripts_that_the_pair_calls_may_be_left_as_well() {
    for trigger in TRIGGERS {
        let folder = Folder::pair("n = 0; part", "part; motor.headVelocity = n; helper(n);");
        fs::write(
            folder.0.join("part.m"),
            "n = n + 1;\nif true\n break;\nend\nn = 100;\n",
        )
        .unwrap();
        let helper = "function helper(n)\nif n > 0\n  break\nend\nerror('too far');\nend\n";
        fs::write(folder.0.join("helper.m"), helper).unwrap();
        let session = Session::octave(&folder.0, trigger);
        session.init().unwrap();
        let motor = session.step(&Sensor::default()).unwrap().motor;
        assert_eq!(motor.head_velocity, Some(2.0));
    }
}
