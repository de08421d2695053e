use egui_kittest::{
    Harness,
    kittest::{NodeT as _, Queryable as _},
};
use tabletop_user::{Errand, RecordingDigest};

use super::*;

struct Stage {
    shelf: Shelf,
    view: RecordingsView,
    requests: Vec<Request>,
}

fn recording(name: &str, sentence: &str) -> ShelvedRecording {
    ShelvedRecording {
        folder: Path::new("shelf").join(name),
        name: name.into(),
        digest: Some(Ok(RecordingDigest {
            ticks: 90,
            segments: 3,
            is_finished: true,
            sentences: vec!["Put the red block on the table.".into(), sentence.into()],
            notes: String::new(),
            picture: None,
        })),
    }
}

fn harness() -> Harness<'static, Stage> {
    let stage = Stage {
        shelf: Shelf {
            folder: "shelf".into(),
            recordings: vec![
                recording("tower-02", "Put the blue block on the red block."),
                recording("tower-01", "Put the green block on the red block."),
                ShelvedRecording {
                    folder: "shelf/odd".into(),
                    name: "odd".into(),
                    digest: Some(Err("session.jsonl:1: expected a header".into())),
                },
            ],
            ..default()
        },
        view: RecordingsView::default(),
        requests: Vec::new(),
    };
    let frame = |ui: &mut Ui, stage: &mut Stage| {
        let requests = show(ui, &stage.shelf, Path::new("shelf"), &mut stage.view);
        stage.requests.extend(requests);
    };
    Harness::builder()
        .with_size([Panel::Recordings.width(), 760.0])
        .build_ui_state(frame, stage)
}

fn clicked(harness: &mut Harness<Stage>, names: &[&str]) -> Vec<Request> {
    for name in names {
        harness.get_by_label(name).click();
        harness.run();
    }
    std::mem::take(&mut harness.state_mut().requests)
}

fn typed(harness: &mut Harness<Stage>, field: &str, text: &str) {
    harness.get_by_label(field).focus();
    harness.run();
    harness.get_by_label(field).type_text(text);
    harness.run();
}

#[test]
fn a_recording_is_opened_renamed_and_discarded() {
    let folder = || PathBuf::from("shelf/tower-01");
    let mut harness = harness();
    assert_eq!(clicked(&mut harness, &["tower-01"]), []);
    assert_eq!(clicked(&mut harness, &["Open"]), [Request::Open(folder())]);
    assert!(
        harness
            .get_by_label("Rename")
            .accesskit_node()
            .is_disabled()
    );
    typed(&mut harness, "Name:", "-best");
    let renamed = clicked(&mut harness, &["Rename"]);
    let [Request::Order(ShelfOrder::Rename(from, name))] = &renamed[..] else {
        panic!("{renamed:?}");
    };
    assert_eq!(*from, folder());
    assert!(
        name.contains("-best") && name.contains("tower-01"),
        "{name}"
    );
    let discard = Request::Order(ShelfOrder::Discard(folder()));
    assert_eq!(clicked(&mut harness, &["Delete"]), [discard]);
}

#[test]
fn notes_are_kept_when_their_field_is_left() {
    let mut harness = harness();
    clicked(&mut harness, &["tower-02"]);
    typed(&mut harness, "Notes:", "crooked");
    assert_eq!(harness.state().requests, []);
    let noted = clicked(&mut harness, &["Refresh"]);
    let note = ShelfOrder::Note("shelf/tower-02".into(), "crooked".into());
    assert!(noted.contains(&Request::Order(note)), "{noted:?}");
}

#[test]
fn two_are_compared_and_what_only_one_has_stands_out() {
    let mut harness = harness();
    clicked(&mut harness, &["tower-01"]);
    let view = &mut harness.state_mut().view;
    view.selected.push("shelf/tower-02".into());
    harness.run();
    for text in [
        "2. Put the green block on the red block.",
        "2. Put the blue block on the red block.",
    ] {
        assert!(harness.query_by_label(text).is_some(), "{text}");
    }
    assert_eq!(harness.query_all_by_label("1.5 s, 3 segments").count(), 2);
}

#[test]
fn work_is_begun_followed_and_cancelled() {
    let mut harness = harness();
    clicked(&mut harness, &["tower-01"]);
    let begun = clicked(&mut harness, &["Export", "Multiply", "Imitate"]);
    let outs: Vec<_> = begun
        .iter()
        .map(|request| {
            let Request::Order(ShelfOrder::Begin(errand)) = request else {
                panic!("{request:?}");
            };
            errand.out().display().to_string()
        })
        .collect();
    assert_eq!(
        outs,
        ["lerobot", "variations", "robot"].map(|kind| format!("shelf/tower-01-{kind}"))
    );
    harness.state_mut().shelf.errand = Some(RunningErrand {
        errand: Errand::Imitate {
            recording: "shelf/tower-01".into(),
            out: "shelf/tower-01-robot".into(),
        },
        progress: Some((3, 12)),
    });
    harness.run();
    let cancel = Request::Order(ShelfOrder::Cancel);
    assert_eq!(clicked(&mut harness, &["Cancel"]), [cancel]);
    assert!(
        harness
            .get_by_label("Export")
            .accesskit_node()
            .is_disabled()
    );
}

#[test]
fn a_folder_is_chosen_when_its_field_is_left() {
    let mut harness = harness();
    typed(&mut harness, "Folder:", "/mine");
    let chosen = clicked(&mut harness, &["tower-01"]);
    let [Request::Choose(folder)] = &chosen[..] else {
        panic!("{chosen:?}");
    };
    assert!(folder.display().to_string().contains("/mine"));
}
