//! Scripts that wait for somebody who is not there.

use std::{fs, time::Duration};

use tabletop_harness::test_with;

use crate::common::{self, Folder, Session, TRIGGERS, octave, script_error};

#[test_with(Octave)]
fn nobody_answers_and_nobody_types() {
    let folder = Folder::pair("", "");
    let callback = folder.0.join("testCallback.m");
    for trigger in TRIGGERS {
        let mut config = octave(&folder.0, trigger);
        config.timeouts.step = Duration::from_secs(10);
        let session = Session::start(config).unwrap();
        for wait in [
            "pause",
            "pause();",
            "pause(Inf)",
            "kbhit();",
            "yes_or_no('sure? ');",
            "fgetl(stdin);",
            "fread(stdin, 1);",
            "input('what? ');",
            "keyboard",
        ] {
            fs::write(&callback, format!("pause(0);\n{wait}\n")).unwrap();
            session.init().unwrap();
            let error = script_error(session.step(&common::at_rest()));
            assert_eq!(error.id, "tabletop:input", "{wait}: {error}");
            let place = error.stack.last().unwrap().to_string();
            assert_eq!(place, format!("{}:2", callback.display()), "{wait}");
        }
    }
}

#[cfg(unix)]
#[test_with(Octave)]
fn processes_started_by_a_script_have_no_input() {
    let folder = Folder::pair(
        "",
        "[status, text] = system('cat; read x; echo got:$x; exit 3 # done');\n\
         assert(status == 3 && strcmp(strtrim(text), 'got:'));\n\
         status = system('cat'); assert(status == 0);\n\
         system('echo shown'); unix('cat');\n\
         fid = popen('cat; echo read', 'r'); assert(fgetl(fid), 'read'); pclose(fid);\n\
         fid = popen('cat', 'w'); fputs(fid, \"written\\n\"); pclose(fid);\n\
         motor.headVelocity = 1;",
    );
    for trigger in TRIGGERS {
        let mut config = octave(&folder.0, trigger);
        config.timeouts.step = Duration::from_secs(10);
        let session = Session::start(config).unwrap();
        session.init().unwrap();
        for _ in 0..2 {
            let motor = session.step(&common::at_rest()).unwrap().motor;
            assert_eq!(motor.head_velocity, Some(1.0));
        }
        let printed = session.printed("written");
        assert!(
            printed.contains("shown\n") && printed.contains("written\n"),
            "{printed}"
        );
    }
}

#[test_with(Octave)]
fn breakpoints_are_ignored() {
    let folder = Folder::pair(
        "dbstop in helper at 2; dbstop if error; debug_on_error(true);",
        "helper; motor.headVelocity = 1;",
    );
    let helper = "function helper()\nx = 1;\ny = 2;\nend\n";
    fs::write(folder.0.join("helper.m"), helper).unwrap();
    for trigger in TRIGGERS {
        let mut config = octave(&folder.0, trigger);
        config.timeouts.step = Duration::from_secs(10);
        let session = Session::start(config).unwrap();
        session.init().unwrap();
        let motor = session.step(&common::at_rest()).unwrap().motor;
        assert_eq!(motor.head_velocity, Some(1.0));
        let printed = session.printed("dbstop has no effect");
        assert!(
            printed.contains("warning: dbstop has no effect here"),
            "{printed}"
        );
        assert!(!printed.contains("dbstop at line"), "{printed}");
    }
}
