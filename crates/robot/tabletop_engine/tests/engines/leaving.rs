//! Scripts that are left by a "break" outside a loop, as MATLAB allows.

use std::fs;

use tabletop_engine::Stream;
use tabletop_harness::test_with;

use crate::common::{self, Folder, Session, TRIGGERS, octave, script_error};

#[test_with(Octave)]
fn only_the_word_that_leaves_is_replaced() {
    let callback = "n = n + 1; % here we break\nmotor.headVelocity = n;\n\
                    for k = 1:3, break, end, if n < 3, disp('break'), break, end\n\
                    \tif n < 4, break; end % or break\naux.exit = k;\n";
    for trigger in TRIGGERS {
        let folder = Folder::pair("n = 0;", callback);
        let session = Session::octave(&folder.0, trigger);
        for _ in 0..2 {
            session.init().unwrap();
            let exits = [(); 4].map(|()| session.step(&common::at_rest()).unwrap().exit);
            assert_eq!(exits, [false, false, false, true]);
            let printed = session.printed("\nbreak\nbreak\n");
            assert!(printed.contains("\nbreak\nbreak\n"), "{printed}");
            assert!(!printed.contains("warning"), "{printed}");
        }
    }
}

#[test_with(Octave)]
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
        let motor = session.step(&common::at_rest()).unwrap().motor;
        assert_eq!(motor.head_velocity, Some(2.0));
    }
}

#[test_with(Octave)]
fn a_script_that_may_be_left_is_still_in_its_folder() {
    let callback = "inside; disp(mfilename ('fullpath')); disp(mfilename(\"fullpathext\"));\n\
                    disp(mfilename); disp(which('testCallback')); which testCallback\n\
                    run([aux.path 'part.m']); source([aux.path 'part.m']); motor.headVelocity = n;\nif true, break, end\n";
    let folder = Folder::pair("n = 0;", callback);
    fs::create_dir(folder.0.join("private")).unwrap();
    fs::write(
        folder.0.join("private/inside.m"),
        "function inside, disp('inside'); end",
    )
    .unwrap();
    fs::write(
        folder.0.join("part.m"),
        "n = n + 1; disp(mfilename);\nif true, break, end\nn = 100;\n",
    )
    .unwrap();
    for trigger in TRIGGERS {
        let session = Session::octave(&folder.0, trigger);
        session.init().unwrap();
        let motor = session.step(&common::at_rest()).unwrap().motor;
        assert_eq!(motor.head_velocity, Some(2.0));
        let script = folder.0.join("testCallback").display().to_string();
        let printed = session.printed("part\npart\n");
        let expected = format!(
            "inside\n{script}\n{script}.m\ntestCallback\n{script}.m\n\
             'testCallback' is a script from the file {script}.m\npart\npart\n"
        );
        assert!(printed.contains(&expected), "{printed}");
    }
    fs::write(folder.0.join("part.m"), "error('no');\nif true, break, end").unwrap();
    let session = Session::octave(&folder.0, TRIGGERS[0]);
    session.init().unwrap();
    let error = script_error(session.step(&common::at_rest())).to_string();
    let place = format!("no\n  at {}:1\n", folder.0.join("part.m").display());
    assert!(error.starts_with(&place), "{error}");
}

#[test_with(Octave)]
fn break_leaves_a_script_with_any_path() {
    for init in [
        "addpath(aux.path);",
        "addpath(genpath(aux.path));",
        "restoredefaultpath;",
        "",
    ] {
        let folder = Folder::pair(
            init,
            "addpath(aux.path); n = 1; if true, break, end, n = 2;",
        );
        // Files that cannot be read do no harm until they are called.
        fs::create_dir(folder.0.join("data.m")).unwrap();
        fs::write(folder.0.join("._testInit.m"), b"\x80").unwrap();
        let session = Session::octave(&folder.0, TRIGGERS[0]);
        session.init().unwrap();
        for _ in 0..2 {
            session.step(&common::at_rest()).unwrap();
        }
        assert!(
            session
                .engine
                .drain_console()
                .iter()
                .all(|line| !line.text.contains("UTF-8"))
        );
    }
}

#[test_with(Octave)]
fn changes_to_a_script_are_noted() {
    let folder = Folder::pair("if true, break, end", "");
    let session = Session::octave(&folder.0, TRIGGERS[0]);
    session.init().unwrap();
    let notes: Vec<_> = session.engine.drain_console();
    let [note] = &notes[..] else {
        panic!("{notes:?}");
    };
    assert_eq!(note.stream, Stream::Note);
    assert!(note.text.starts_with("testInit.m:1: "), "{}", note.text);
}

#[test_with(Octave)]
fn a_break_that_cannot_leave_is_reported_with_its_replacement() {
    let elsewhere = Folder::pair("addpath([aux.path 'lib']);", "part");
    fs::create_dir(elsewhere.0.join("lib")).unwrap();
    fs::write(elsewhere.0.join("lib/part.m"), "if true, break, end").unwrap();
    let current = Folder::pair("", "if true, break, end");
    for (folder, working_dir) in [(&elsewhere, "."), (&current, current.0.to_str().unwrap())] {
        let mut config = octave(&folder.0, TRIGGERS[0]);
        config.working_dir = working_dir.into();
        let session = Session::start(config).unwrap();
        let result = session
            .init()
            .and_then(|_| session.step(&common::at_rest()));
        let error = script_error(result).to_string();
        assert!(error.contains("write \"return\""), "{error}");
    }
}
