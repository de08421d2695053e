//! The folder of the scripts, and files in it and beside it.

use std::{fs, path::Path};

use tabletop_engine::{EngineConfig, Stream, Trigger};
use tabletop_harness::test_with;

#[cfg(unix)]
use crate::common::executable;
use crate::common::{self, Folder, Session, octave, script_error};

/// Why the scripts cannot be initialized.
fn fault(config: EngineConfig) -> String {
    let session = Session::start(config).unwrap();
    script_error(session.init()).message
}

fn fault_of(agent: &Path) -> String {
    fault(octave(agent, Trigger::Stdin))
}

#[test_with(Octave)]
fn a_script_that_would_be_mistaken_for_another_is_reported() {
    let named = Folder::pair("", "helper;");
    fs::write(named.0.join("helper.m"), "").unwrap();
    let current = Folder::new(&[("helper.m", "error('the wrong one');")]);
    let mut config = octave(&named.0, Trigger::Stdin);
    config.working_dir.clone_from(&current.0);
    let message = fault(config);
    let [wrong, right] = [&current, &named].map(|folder| folder.0.join("helper.m"));
    let expected = format!(
        "{} would run in place of {}",
        wrong.display(),
        right.display()
    );
    assert!(message.starts_with(&expected), "{message}");
    let mut config = octave(".".as_ref(), Trigger::Stdin);
    config.working_dir.clone_from(&named.0);
    Session::start(config).unwrap().init().unwrap();
}

#[test_with(Octave)]
fn a_path_that_is_no_script_folder_is_reported() {
    let folder = Folder::pair("", "");
    let file = folder.0.join("testInit.m");
    assert_eq!(
        fault_of(&file),
        format!("{} is a file; name its folder", file.display())
    );
    let missing = folder.0.join("nosuch");
    assert_eq!(
        fault_of(&missing),
        format!("there is no {}", missing.display())
    );
    assert_eq!(
        fault_of("".as_ref()),
        "the name of the scripts' folder is empty"
    );
    let colon = folder.0.join("a:b");
    fs::create_dir(&colon).unwrap();
    assert!(fault_of(&colon).contains("because its name holds ':'"));
    let empty = folder.0.join("empty");
    fs::create_dir(&empty).unwrap();
    assert_eq!(
        fault_of(&empty),
        format!("there is no agentBehavior.m in {}", empty.display())
    );
}

#[test_with(Octave)]
fn a_script_that_is_missing_is_reported() {
    for name in ["testInit", "testCallback"] {
        let folder = Folder::pair("", "");
        fs::remove_file(folder.0.join(format!("{name}.m"))).unwrap();
        let there = folder.0.display();
        assert_eq!(
            fault_of(&folder.0),
            format!("there is no {name}.m in {there}, which agentBehavior.m names")
        );
        let mut config = octave(&folder.0, Trigger::Stdin);
        config.pair = Some(["testInit".into(), "testCallback".into()]);
        assert_eq!(fault(config), format!("there is no {name}.m in {there}"));
    }
}

fn behavior(text: &str) -> Folder {
    let folder = Folder::pair("speed = 2;", "motor.headVelocity = speed;");
    fs::write(folder.0.join("agentBehavior.m"), text).unwrap();
    folder
}

#[test_with(Octave)]
fn scripts_may_be_named_in_many_ways() {
    for text in [
        "function [i, c] = agentBehavior(), i = 'testInit'; c = \"testCallback\"; end",
        "function [i, c] = agentBehavior(), i = @() evalin('base', 'testInit'); c = @testCallback; end",
        "function [i, c] = agentBehavior(), i = @testInit; c = @mine; end\n\
         function mine(), global motor, motor.headVelocity = 2; end",
    ] {
        let folder = behavior(text);
        let session = Session::octave(&folder.0, Trigger::Stdin);
        session.init().unwrap();
        let motor = session.step(&common::at_rest()).unwrap().motor;
        assert_eq!(motor.head_velocity, Some(2.0), "{text}");
    }
}

#[test_with(Octave)]
fn values_that_are_no_function_handle_are_reported() {
    for (text, message) in [
        (
            "function [i, c] = agentBehavior(), i = @testInit; c = ['abc'; 'def'] == 'a'; end",
            "agentBehavior: callback is 2x3 logical; it must be a function handle",
        ),
        (
            "function [i, c] = agentBehavior(), i = 1; c = []; end",
            "agentBehavior: init is 1x1 double; it must be a function handle",
        ),
        (
            "function [i, c] = agentBehavior(), i = ''; c = ''; end",
            "agentBehavior: init is 0x0 char; it must be a function handle",
        ),
    ] {
        assert_eq!(fault_of(&behavior(text).0), message);
    }
    let message = fault_of(&behavior("init = @testInit;\ncallback = @testCallback;\n").0);
    assert!(
        message.ends_with("\"function [init, callback] = agentBehavior()\""),
        "{message}"
    );
}

#[test_with(Octave)]
fn scripts_of_windows_are_read() {
    let folder = Folder::pair("", "");
    let file = folder.0.join("testCallback.m");
    let text = b"name = '\xe4'; % Gr\xf6\xdfe\nmotor.headVelocity = numel(name);\nif true, break, end % \xe4";
    fs::write(&file, text).unwrap();
    let detour = folder.0.join("..").join(folder.0.file_name().unwrap());
    let file = detour.join("testCallback.m");
    let session = Session::octave(&detour, Trigger::Stdin);
    session.init().unwrap();
    let motor = session.step(&common::at_rest()).unwrap().motor;
    assert_eq!(motor.head_velocity, Some(2.0), "the letter in UTF-8");
    let lines = session.engine.drain_console();
    assert!(
        lines.iter().all(|line| line.stream != Stream::Error),
        "{lines:?}"
    );
    let expected = format!("{} is not UTF-8; the scripts of", file.display());
    assert!(lines[0].text.starts_with(&expected), "{lines:?}");
    fs::write(folder.0.join("helper.m"), "% Größe\n").unwrap();
    session.init().unwrap();
    let note = format!("{} is not UTF-8, unlike others", file.display());
    assert!(session.printed(&note).contains(&note));
}

#[cfg(unix)]
#[test_with(Octave)]
fn the_users_startup_file_does_no_harm() {
    let home = Folder::new(&[]);
    let script = format!(
        "#!/bin/sh\nHOME={} exec octave-cli \"$@\"\n",
        home.0.display()
    );
    let (_bin, program) = executable("octave-cli", &script);
    let folder = Folder::new(&[]);
    let scripts = folder.0.join("scripts");
    fs::create_dir(&scripts).unwrap();
    for (name, text) in [
        (
            "agentBehavior.m",
            "function [i, c] = agentBehavior(), i = @first; c = @next; end",
        ),
        (
            "first.m",
            "x = 3; save([aux.path 'x.mat'], 'x'); load([aux.path 'x.mat']);",
        ),
        ("next.m", "motor.headVelocity = x; nosuch"),
    ] {
        fs::write(scripts.join(name), text).unwrap();
    }
    for (trigger, startup) in [
        (Trigger::Stdin, "pause\ncd /\ndebug_on_error(true);\n"),
        (Trigger::Poll, "cd /\ndebug_on_error(true);\n"),
    ] {
        fs::write(home.0.join(".octaverc"), startup).unwrap();
        let mut config = octave("scripts".as_ref(), trigger);
        config.working_dir.clone_from(&folder.0);
        config.engine.program.clone_from(&program);
        let session = Session::start(config).unwrap();
        session.init().unwrap();
        assert!(scripts.join("x.mat").exists());
        assert!(
            script_error(session.step(&common::at_rest()))
                .message
                .contains("nosuch")
        );
    }
}
