use std::path::Path;

use super::*;
use egui_kittest::{Harness, kittest::Queryable as _};
use tabletop_core::{ObjectEdit, ObjectSpec, Shape};
use tabletop_geometry::{Pose, Rgb};

struct Stage {
    files: Files,
    keymap: Keymap,
    objects: Vec<PresentObject>,
    selection: Selection,
    requests: Vec<Request>,
}

fn harness(tasks: &[&str]) -> Harness<'static, Stage> {
    let tasks = tasks.iter().map(|name| TaskFile {
        name: (*name).to_owned(),
        path: Path::new("tablesetup").join(name),
    });
    let stage = Stage {
        files: Files {
            tasks: tasks.collect(),
            recent: vec!["/tasks/mine.xml".into(), "/recordings/demo".into()],
            reloads: false,
        },
        keymap: Keymap::default(),
        objects: Vec::new(),
        selection: Selection::default(),
        requests: Vec::new(),
    };
    let frame = |ui: &mut Ui, stage: &mut Stage| {
        let model = Model {
            objects: &stage.objects,
            tasks: &stage.files.tasks,
            recent: &stage.files.recent,
            reloads: stage.files.reloads,
            keymap: &stage.keymap,
        };
        stage
            .requests
            .extend(show(ui, &model, &mut stage.selection));
    };
    Harness::builder()
        .with_size([320.0, 900.0])
        .build_ui_state(frame, stage)
}

/// Clicks on the widgets of these names, one after the other, and returns their requests.
fn clicked(harness: &mut Harness<Stage>, names: &[&str]) -> Vec<Request> {
    for name in names {
        harness.get_by_label(name).click();
        harness.run();
    }
    std::mem::take(&mut harness.state_mut().requests)
}

fn load(name: &str) -> Request {
    Request::Load(Path::new("tablesetup").join(name))
}

const LIST: Request = Request::File(FileRequest::ListTasks);

#[test]
fn the_first_task_file_is_loaded_or_the_one_that_is_chosen() {
    let mut harness = harness(&["a.xml", "b.xml", "c.xml"]);
    assert_eq!(clicked(&mut harness, &["Load XML"]), [load("a.xml")]);
    let chosen = clicked(&mut harness, &["Task file", "b.xml", "Load XML"]);
    assert_eq!(chosen, [LIST, load("b.xml")]);
}

#[test]
fn a_chosen_file_that_has_gone_is_not_loaded() {
    let mut harness = harness(&["a.xml", "b.xml"]);
    clicked(&mut harness, &["Task file", "b.xml"]);
    harness.state_mut().files.tasks.pop();
    assert_eq!(clicked(&mut harness, &["Load XML"]), [load("a.xml")]);
    harness.state_mut().files.tasks.clear();
    harness.run();
    assert_eq!(clicked(&mut harness, &["Load XML"]), []);
}

#[test]
fn every_preset_can_be_executed() {
    let mut harness = harness(&[]);
    assert_eq!(
        clicked(&mut harness, &["Execute"]),
        [Request::Make(Preset::BigBlock)]
    );
    for (text, entry) in ENTRIES {
        let wanted = clicked(&mut harness, &["Preset objects", text, "Execute"]);
        let expected = match entry {
            Entry::Make(preset) => Request::Make(preset),
            Entry::Clear => Request::Clear,
        };
        assert_eq!(wanted, [expected], "{text}");
    }
}

#[test]
fn files_are_opened_and_saved() {
    for (names, request) in [
        (&["Open…"][..], FileRequest::AskToOpen),
        (&["Save as…"], FileRequest::AskToSave),
        (
            &["Recent", "mine.xml"],
            FileRequest::Open("/tasks/mine.xml".into()),
        ),
        (
            &["Recent", "demo"],
            FileRequest::Open("/recordings/demo".into()),
        ),
        (&["Reload when the file changes"], FileRequest::Reload(true)),
    ] {
        let mut harness = harness(&["a.xml"]);
        assert_eq!(clicked(&mut harness, names), [Request::File(request)]);
    }
}

#[test]
fn without_recent_files_there_is_no_list_of_them() {
    let mut harness = harness(&["a.xml"]);
    harness.state_mut().files.recent.clear();
    harness.run();
    assert_eq!(clicked(&mut harness, &["Recent"]), []);
    assert!(harness.query_by_label("mine.xml").is_none());
}

fn with_objects() -> Harness<'static, Stage> {
    let mut harness = harness(&["a.xml"]);
    harness.state_mut().objects = [("ball", None), ("block", None), ("cap", Some("LeftHand"))]
        .map(|(id, holder)| PresentObject {
            spec: ObjectSpec::new(
                id,
                Pose::at(Vec3::new(id.len() as f32 * 2.0, 0.0, 0.5)),
                1.0,
                Shape::Sphere {
                    radius: 0.5,
                    color: Rgb::RED,
                },
            ),
            holder: holder.map(str::to_owned),
        })
        .into();
    harness.run();
    harness
}

/// The edits that come of clicks on these widgets.
fn edits(harness: &mut Harness<Stage>, names: &[&str]) -> Vec<ObjectEdit> {
    let requests = clicked(harness, names);
    requests
        .into_iter()
        .flat_map(|request| match request {
            Request::List(ListRequest::Edit(edits)) => edits,
            Request::List(ListRequest::Choose(_)) => Vec::new(),
            Request::Load(_) | Request::Make(_) | Request::Clear | Request::File(_) => {
                panic!("{request:?}")
            }
        })
        .collect()
}

fn add_of(edits: &[ObjectEdit]) -> &ObjectSpec {
    let [ObjectEdit::Add(spec)] = edits else {
        panic!("{edits:?}");
    };
    spec
}

#[test]
fn objects_are_made_duplicated_copied_and_deleted() {
    let mut harness = with_objects();
    let made = edits(&mut harness, &["New object", "Ring"]);
    assert_eq!(add_of(&made).shape.name(), "ring");
    let delete = edits(&mut harness, &["ball", "Delete"]);
    assert_eq!(delete, [ObjectEdit::Remove("ball".into())]);
    let copy = edits(&mut harness, &["Duplicate"]);
    let (copy, block) = (add_of(&copy), &harness.state().objects[1].spec);
    assert_eq!(copy.id, "ball");
    let apart = copy.pose.location.distance(block.pose.location);
    assert!(apart > 1.0, "in the place of the block: {apart}");
    assert_eq!(edits(&mut harness, &["Copy"]), []);
    assert_eq!(add_of(&edits(&mut harness, &["block", "Paste"])).id, "ball");
    assert_eq!(edits(&mut harness, &["cap", "Delete"]), [], "it is held");
}

#[test]
fn a_property_is_changed_when_its_field_is_left() {
    let mut harness = with_objects();
    edits(&mut harness, &["block"]);
    harness.get_by_label("Id").focus();
    harness.run();
    harness.get_by_label("Id").type_text("s");
    harness.run();
    assert_eq!(harness.state().requests, []);
    harness.key_press(bevy_egui::egui::Key::Enter);
    harness.run();
    let changed = edits(&mut harness, &[]);
    let [ObjectEdit::Change { object, spec }] = &changed[..] else {
        panic!("{changed:?}");
    };
    assert_eq!((&**object, spec.id.contains('s')), ("block", true));
    assert_eq!(spec.pose, harness.state().objects[1].spec.pose);
}

#[test]
fn a_renamed_object_stays_selected_also_when_undo_brings_back_its_id() {
    let mut harness = with_objects();
    edits(&mut harness, &["block"]);
    for id in ["s", "t"] {
        harness.get_by_label("Id").focus();
        harness.run();
        harness.get_by_label("Id").type_text(id);
        harness.key_press(bevy_egui::egui::Key::Enter);
        harness.run();
        let changed = edits(&mut harness, &[]);
        let [ObjectEdit::Change { spec, .. }] = &changed[..] else {
            panic!("{changed:?}");
        };
        harness.run();
        let before = harness.state().objects.clone();
        harness.state_mut().objects[1].spec = (**spec).clone();
        harness.run();
        assert!(harness.query_by_label("Id").is_some(), "renamed");
        harness.state_mut().objects = before;
        harness.run();
        assert!(harness.query_by_label("Id").is_some(), "undone");
    }
}

#[test]
fn what_is_selected_in_the_list_is_chosen_for_the_keyboard() {
    let mut harness = with_objects();
    let chosen = Request::List(ListRequest::Choose("block".into()));
    assert_eq!(clicked(&mut harness, &["block"]), [chosen]);
}

#[test]
fn several_are_moved_together() {
    let mut harness = with_objects();
    let list = &mut harness.state_mut().selection.objects;
    list.select_for_move(&["ball", "block"], [0.0, 2.0, 0.0]);
    harness.run();
    let moved = edits(&mut harness, &["Move"]);
    let places: Vec<_> = moved
        .iter()
        .map(|edit| match edit {
            ObjectEdit::Change { spec, .. } => spec.pose.location.y,
            ObjectEdit::Add(_) | ObjectEdit::Remove(_) => panic!("{edit:?}"),
        })
        .collect();
    assert_eq!(places, [2.0, 2.0]);
}
