//! Scripts that fail: each fault is reported exactly, with its place.

use std::fs;

use tabletop_engine::Trigger;
use tabletop_harness::test_with;

use crate::common::{self, Folder, Session, TRIGGERS, script_error};

#[test_with(Octave)]
fn an_error_is_reported_with_its_place() {
    for trigger in TRIGGERS {
        let folder = Folder::pair("x = 1;", "y = x;\nhelper(y);\n");
        fs::write(
            folder.0.join("helper.m"),
            "function helper(y)\nundefined_thing(y);\nend\n",
        )
        .unwrap();
        let session = Session::octave(&folder.0, trigger);
        session.init().unwrap();
        let error = script_error(session.step(&common::at_rest()));
        assert_eq!(error.id, "Octave:undefined-function");
        assert!(
            error.message.contains("'undefined_thing' undefined"),
            "{error}"
        );
        let places: Vec<_> = error
            .stack
            .iter()
            .map(|place| (place.file.clone(), place.line))
            .collect();
        assert_eq!(
            places,
            [
                (folder.0.join("helper.m"), 2),
                (folder.0.join("testCallback.m"), 2)
            ],
            "{error}"
        );
        // The engine lives on and starts afresh.
        fs::write(folder.0.join("helper.m"), "function helper(y)\nend\n").unwrap();
        session.init().unwrap();
    }
}

#[test_with(Octave)]
fn errors_of_all_kinds_are_reported() {
    let faults = [
        ("error('my:id', 'no %d', 3)", "my:id", "no 3"),
        (
            "[1 2 3] * [4 5 6]",
            "Octave:nonconformant-args",
            "operator *",
        ),
        (
            "x = zeros(1e6, 1e6, 'double') + 1;",
            "Octave:",
            "out of memory",
        ),
        (
            "answer = input('what? ');",
            "tabletop:input",
            "nobody can answer",
        ),
        ("keyboard", "tabletop:input", "nobody can type"),
        ("a = {}; a{3}", "Octave:index-out-of-bounds", "out of bound"),
    ];
    let folder = Folder::pair("", "");
    let session = Session::octave(&folder.0, Trigger::Stdin);
    for (script, id, message) in faults {
        fs::write(
            folder.0.join("testCallback.m"),
            format!("% line 1\n{script}\n"),
        )
        .unwrap();
        session.init().unwrap();
        let error = script_error(session.step(&common::at_rest()));
        assert!(
            error.id.starts_with(id) && error.message.contains(message),
            "{script}: {} {error}",
            error.id
        );
        assert_eq!(
            error.location().unwrap().to_string(),
            format!("{}:2", folder.0.join("testCallback.m").display())
        );
    }
}

#[test_with(Octave)]
fn endless_recursion_is_an_error() {
    for trigger in TRIGGERS {
        let folder = Folder::pair("", "deeper(1);");
        fs::write(
            folder.0.join("deeper.m"),
            "function deeper(n)\ndeeper(n + 1);\nend\n",
        )
        .unwrap();
        let session = Session::octave(&folder.0, trigger);
        session.init().unwrap();
        let error = script_error(session.step(&common::at_rest()));
        assert!(error.message.contains("max_recursion_depth"), "{error}");
    }
}

#[test_with(Octave)]
fn wrong_syntax_is_reported_with_its_place() {
    for script in ["x = 1;\nif x\n  y = = 3;\nend\n", "x = 1;\nbreak\ny = ;\n"] {
        let folder = Folder::pair("", script);
        let session = Session::octave(&folder.0, Trigger::Stdin);
        let error = script_error(
            session
                .init()
                .and_then(|_| session.step(&common::at_rest())),
        );
        assert!(error.message.contains("parse error"), "{error}");
        let place = error.location().unwrap();
        assert_eq!(place.file, folder.0.join("testCallback.m"));
        assert!(place.line >= 2, "{error}");
    }
}

#[test_with(Octave)]
fn missing_functions_are_reported() {
    let folder = Folder::new(&[(
        "agentBehavior.m",
        "function [i, c] = agentBehavior()\ni = @nosuch;\nc = @nosuch;\nend\n",
    )]);
    let session = Session::octave(&folder.0, Trigger::Stdin);
    let error = script_error(session.init());
    assert!(error.message.contains("nosuch"), "{error}");
    let folder = Folder::new(&[]);
    let session = Session::octave(&folder.0, Trigger::Stdin);
    let error = script_error(session.init());
    assert!(error.message.contains("agentBehavior"), "{error}");
}

#[test_with(Octave)]
fn a_folder_with_an_awkward_name_works() {
    let folder = Folder::new(&[]);
    let awkward = folder.0.join("it's a föl'der");
    fs::create_dir(&awkward).unwrap();
    for (name, text) in [
        (
            "agentBehavior.m",
            "function [i, c] = agentBehavior(), i = @a; c = @b; end",
        ),
        ("a.m", ""),
        ("b.m", "error('ü')"),
    ] {
        fs::write(awkward.join(name), text).unwrap();
    }
    for trigger in TRIGGERS {
        let session = Session::octave(&awkward, trigger);
        session.init().unwrap();
        let error = script_error(session.step(&common::at_rest()));
        assert_eq!(
            (
                error.message.as_str(),
                error.location().unwrap().file.clone()
            ),
            ("ü", awkward.join("b.m"))
        );
    }
}
