//! What scripts print.

mod common;

use common::{Folder, Session, TRIGGERS};
use tabletop_engine::{Sensor, Stream, Trigger};

#[test]
fn what_scripts_print_arrives_apart_from_replies() {
    for trigger in TRIGGERS {
        let folder = Folder::pair(
            "disp('from init'); x = 3",
            "printf('no end of line'); fprintf(stderr, 'a warning\\n'); sensor\nfprintf('%s\\n', char(1)); fprintf('done');",
        );
        let session = Session::octave(&folder.0, trigger);
        session.init().unwrap();
        let printed = session.printed("x = 3");
        assert!(printed.contains("from init\nx = 3\n"), "{printed}");
        session.step(&Sensor::default()).unwrap();
        let printed = session.printed("timeElapsed");
        assert!(
            printed.contains("no end of line") && printed.contains("timeElapsed: 1x1 scalar"),
            "{printed}"
        );
    }
}

#[test]
fn a_flood_of_output_neither_blocks_nor_piles_up() {
    let folder = Folder::pair("", "for k = 1:200000, printf('line %d\\n', k); end");
    let session = Session::octave(&folder.0, Trigger::Stdin);
    session.init().unwrap();
    session.step(&Sensor::default()).unwrap();
    session.step(&Sensor::default()).unwrap();
    let lines = session.engine.drain_console();
    assert!(lines.len() < 1100, "{}", lines.len());
    assert!(
        lines
            .iter()
            .any(|line| line.stream == Stream::Note && line.text.contains("left out"))
    );
}
