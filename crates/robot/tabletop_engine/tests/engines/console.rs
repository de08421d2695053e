//! Output of scripts.

use std::{
    fs, thread,
    time::{Duration, Instant},
};

use tabletop_engine::{ConsoleLimit, RgbImage, Sensor, Stream, Trigger};
use tabletop_harness::test_with;

use crate::common::{self, Folder, Session, TRIGGERS, octave};

#[test_with(Octave)]
fn printed_text_arrives_apart_from_replies() {
    for trigger in TRIGGERS {
        let folder = Folder::pair(
            "disp('from init'); x = 3",
            "printf('no end of line'); fprintf(stderr, 'a warning\\n'); sensor\nfprintf('%s\\n', char(1)); fprintf('done');",
        );
        let session = Session::octave(&folder.0, trigger);
        session.init().unwrap();
        let printed = session.printed("x = 3");
        assert!(printed.contains("from init\nx = 3\n"), "{printed}");
        session.step(&common::at_rest()).unwrap();
        let printed = session.printed("timeElapsed");
        assert!(
            printed.contains("no end of line") && printed.contains("timeElapsed: 0\n"),
            "{printed}"
        );
    }
}

#[test_with(Octave)]
fn a_flood_of_output_neither_blocks_nor_piles_up() {
    let folder = Folder::pair("", "for k = 1:200000, printf('line %d\\n', k); end");
    let session = Session::octave(&folder.0, Trigger::Stdin);
    let start = Instant::now();
    session.init().unwrap();
    session.step(&common::at_rest()).unwrap();
    session.step(&common::at_rest()).unwrap();
    let lines = session.engine.drain_console();
    // 200 lines and a remark in each second that has begun.
    let most = 201 * (start.elapsed().as_secs() as usize + 2);
    assert!(lines.len() <= most, "{} of {most}", lines.len());
    assert!(
        lines
            .iter()
            .any(|line| line.stream == Stream::Note && line.text.contains("left out"))
    );
}

#[test_with(Octave)]
fn all_that_is_printed_can_be_had() {
    let folder = Folder::pair(
        "n = 0;",
        "n = n + 1; printf('tick %d\\n', n); disp(repmat('x', 1, 9000));",
    );
    let mut config = octave(&folder.0, Trigger::Stdin);
    config.console_limit = ConsoleLimit::Whole;
    let session = Session::start(config).unwrap();
    session.init().unwrap();
    for _ in 0..1200 {
        session.step(&common::at_rest()).unwrap();
    }
    session.engine.stop();
    while session.engine.is_alive() {
        thread::sleep(Duration::from_millis(10));
    }
    let mut lines = session.engine.drain_console();
    lines.retain(|line| !line.text.is_empty());
    assert_eq!(lines.len(), 2400);
    assert_eq!(lines[2398].text, "tick 1200");
    assert_eq!(lines[2399].text.len(), 9000);
}

#[test_with(Octave)]
fn a_flood_is_noted_now_and_then() {
    let folder = Folder::pair("", "for k = 1:1000, printf('line %d\\n', k); end");
    let session = Session::octave(&folder.0, Trigger::Stdin);
    session.init().unwrap();
    let mut lines = Vec::new();
    for _ in 0..20 {
        session.step(&common::at_rest()).unwrap();
        lines.extend(session.engine.drain_console());
    }
    let notes = lines
        .iter()
        .filter(|line| line.stream == Stream::Note)
        .count();
    assert!(
        (1..15).contains(&notes) && lines.len() < 4000,
        "{notes} {}",
        lines.len()
    );
}

#[test_with(Octave)]
fn a_printed_struct_shows_its_fields() {
    let folder = Folder::pair(
        "s.number = 0.25; s.row = [2 0.5]; s.long = 1:14; s.thin = sparse(3); s.name = 'it is'; s.yes = true; s.all = zeros(2, 7); s.inner.x = 1; s.list = {1, 2}; s.go = @sin;\n\
         s, inner = s.inner\nmany(3).x = 1\nstruct()\ntext = disp(s.inner); disp(s.inner); nested = {s}",
        "sensor",
    );
    for trigger in TRIGGERS {
        let session = Session::octave(&folder.0, trigger);
        session.init().unwrap();
        let printed = session.printed("nested");
        for line in [
            "s =\n",
            "    number: 0.2500\n",
            "    row: [2 0.5]\n",
            "    long: [1x14 double]\n",
            "    thin: 3\n",
            "    name: 'it is'\n",
            "    yes: 1\n",
            "    all: [2x7 double]\n",
            "    inner: [1x1 struct]\n",
            "    list: [1x2 cell]\n",
            "    go: @sin\n",
            "inner =\n    x: 1\n",
            "many =\n    1x3 struct array with fields:\n    x\n",
        ] {
            assert!(printed.contains(line), "{line}: {printed}");
        }
        let sensor = Sensor {
            picture: RgbImage::new(200, 150, vec![9; 90_000]),
            tracker_loc: Some(vec![("l-S1".into(), [1.0, 2.0, 3.0])]),
            ..common::at_rest()
        };
        session.step(&sensor).unwrap();
        let printed = session.printed("trackerLoc");
        assert!(
            printed.contains("rgbVision: [150x200x3 double]\n"),
            "{printed}"
        );
        assert!(
            printed.contains("trackerLoc: [1x1 containers.Map]\n"),
            "{printed}"
        );
        assert!(printed.lines().count() < 20, "{printed}");
    }
}

#[test_with(Octave)]
fn shown_output_is_not_reported_again() {
    for trigger in TRIGGERS {
        let folder = Folder::pair(
            "fprintf(stderr, 'a warning\\n');",
            "fprintf(stderr, 'unseen\\n'); exit(3)",
        );
        let session = Session::octave(&folder.0, trigger);
        session.init().unwrap();
        assert!(session.printed("a warning").contains("a warning"));
        let error = session.step(&common::at_rest()).unwrap_err().to_string();
        assert!(
            error.contains("unseen") && !error.contains("a warning"),
            "{error}"
        );
        let rest = session.engine.drain_console();
        assert!(
            rest.iter().all(|line| !line.text.contains("unseen")),
            "{rest:?}"
        );
    }
}

#[test_with(Octave)]
fn warnings_name_no_line_of_the_driver() {
    for trigger in TRIGGERS {
        let folder = Folder::pair("warning('from init');", "helper;");
        fs::write(
            folder.0.join("helper.m"),
            "function helper()\nwarning('deeper');\nend\n",
        )
        .unwrap();
        let session = Session::octave(&folder.0, trigger);
        session.init().unwrap();
        session.step(&common::at_rest()).unwrap();
        let printed = session.printed("testCallback at line 1");
        assert!(
            printed.contains("from init") && printed.contains("helper at line 2"),
            "{printed}"
        );
        assert!(!printed.contains("tabletop_"), "{printed}");
    }
}

#[test_with(Octave)]
fn a_struct_in_a_cell_keeps_its_values() {
    let folder = Folder::pair("s.a = 17; t = {s}, disp end", "");
    let session = Session::octave(&folder.0, Trigger::Stdin);
    session.init().unwrap();
    let printed = session.printed("end");
    assert!(printed.contains("a = 17"), "{printed}");
}

#[test_with(Octave)]
fn actions_of_the_driver_are_not_reported() {
    let folder = Folder::pair(
        "try, norm(1, 2, 3, 4), catch, end\nx = debug_on_error();\npath(path, tempdir); p = path; path(p);\ndisp ready",
        "",
    );
    let session = Session::octave(&folder.0, Trigger::Stdin);
    session.init().unwrap();
    assert_eq!(session.printed("ready"), "ready\n");
}

#[test_with(Octave)]
fn shadowed_functions_are_noted() {
    let folder = Folder::pair("disp ready", "");
    fs::write(folder.0.join("cumsum.m"), "function cumsum, end").unwrap();
    let session = Session::octave(&folder.0, Trigger::Stdin);
    session.init().unwrap();
    let printed = session.printed("ready");
    assert!(printed.contains("cumsum.m shadows"), "{printed}");
}

#[test_with(Octave)]
fn a_line_without_an_end_is_not_lost() {
    let folder = Folder::pair("", "fprintf(2, 'dots'); error('no');");
    let session = Session::octave(&folder.0, Trigger::Stdin);
    session.init().unwrap();
    session.step(&common::at_rest()).unwrap_err();
    session.engine.stop();
    assert!(session.printed("dots").contains("dots"));
}

#[test_with(Octave)]
fn a_function_that_shares_no_variables_is_noted() {
    let own = "% mine\n\nfunction testCallback\nmotor.headVelocity = 1;\n";
    for (callback, notes) in [
        (own, 1),
        ("function testCallback\nglobal motor\n", 0),
        ("x = 1;", 0),
    ] {
        let folder = Folder::pair("disp ready", callback);
        let session = Session::octave(&folder.0, Trigger::Stdin);
        session.init().unwrap();
        let printed = session.printed("ready");
        assert_eq!(
            printed.matches("without \"global").count(),
            notes,
            "{printed}"
        );
    }
}
