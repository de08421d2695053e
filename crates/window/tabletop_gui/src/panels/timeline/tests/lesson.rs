//! The lesson below the recording.

use super::*;

/// A stack that was shown in the recording of [`timeline`].
fn task() -> ShownTask {
    let property = |name: &str, value: &str, is_required| ShownProperty {
        name: name.into(),
        value: value.into(),
        is_required,
    };
    ShownTask {
        folder: "demo".into(),
        steps: vec![
            ShownStep {
                sentence: "Put the red block on the blue block.".into(),
                grasp: SimTick(280),
                release: SimTick(460),
                color: Some(Rgb::RED),
                ..default()
            },
            ShownStep {
                sentence: "Put the green block aside.".into(),
                grasp: SimTick(500),
                release: SimTick(501),
                ..default()
            },
        ],
        roles: vec![
            ShownRole {
                id: "Red".into(),
                noun: "the red block".into(),
                required: Required::Some,
                properties: vec![
                    property("shape", "block", true),
                    property("color", "red", false),
                ],
            },
            ShownRole {
                id: "Blue".into(),
                noun: "the blue block".into(),
                required: Required::AsShown,
                properties: vec![property("color", "blue", false)],
            },
        ],
        fault: None,
    }
}

fn taught(stage: TimelineStage) -> Harness<'static, Desk> {
    let mut desk = Desk::new(stage);
    desk.task = task();
    let mut harness = Harness::builder()
        .with_size(vec2(680.0, 760.0))
        .build_ui_state(Desk::show, desk);
    harness.run();
    harness
}

#[test]
fn a_click_on_a_sentence_goes_to_where_its_step_begins() {
    let mut harness = taught(TimelineStage::Open);
    let sentences = harness.get_all_by_label("1. Put the red block on the blue block.");
    assert_eq!(sentences.count(), 2, "along the time, and in the list");
    let lane = harness
        .get_all_by_label("2. Put the green block aside.")
        .next();
    lane.unwrap().click();
    harness.run();
    assert_eq!(harness.state().requests, [Request::GoTo(SimTick(500))]);
}

#[test]
fn sentences_of_another_recording_are_not_along_the_time() {
    let mut harness = taught(TimelineStage::Open);
    harness.state_mut().task.folder = "other".into();
    harness.run();
    let sentences = harness.get_all_by_label("1. Put the red block on the blue block.");
    assert_eq!(sentences.count(), 1);
}

#[test]
fn the_robot_is_started_stopped_and_everything_put_back() {
    for stage in [
        TimelineStage::Finished,
        TimelineStage::Open,
        TimelineStage::Absent,
    ] {
        let mut harness = taught(stage);
        for (name, order) in [
            ("Let the robot do it", TaskOrder::Imitate),
            ("Put everything back", TaskOrder::PutBack),
        ] {
            assert_eq!(click(&mut harness, name), [Request::Task(order)]);
        }
        assert_eq!(click(&mut harness, "Stop"), []);
        harness.state_mut().imitating = Imitating::Preparing;
        harness.run();
        assert_eq!(click(&mut harness, "Let the robot do it"), []);
        assert_eq!(
            click(&mut harness, "Stop"),
            [Request::Task(TaskOrder::Stop)]
        );
    }
}

#[test]
fn nothing_is_wider_than_the_panel() {
    for width in [640.0, 1000.0, 1260.0] {
        let mut desk = Desk::new(TimelineStage::Open);
        desk.task = task();
        desk.task.folder = ["/home/someone"; 12].concat().into();
        let show = |ui: &mut Ui, (desk, widths): &mut (Desk, [f32; 2])| {
            let room = ui.available_width();
            Desk::show(ui, desk);
            *widths = [ui.min_rect().width(), room];
        };
        let mut harness = Harness::builder()
            .with_size(vec2(width, 760.0))
            .build_ui_state(show, (desk, [0.0; 2]));
        harness.run();
        let (_, [shown, room]) = *harness.state();
        assert!(shown <= room, "{shown} in {room}");
    }
}

#[test]
fn each_property_of_each_object_can_be_required_or_not() {
    let mut harness = taught(TimelineStage::Open);
    assert!(harness.query_by_label("Red: color red").is_none());
    click(&mut harness, "What must be the same");
    harness.run();
    let require = |role: &str, property: &str, is_required| TaskOrder::Require {
        role: role.into(),
        property: property.into(),
        is_required,
    };
    let free = |role: &str| TaskOrder::Free {
        role: role.into(),
        is_free: true,
    };
    for (name, order) in [
        ("Red: shape block", require("Red", "shape", false)),
        ("Red: color red", require("Red", "color", true)),
        ("Red: any", free("Red")),
        ("Blue: color blue", require("Blue", "color", true)),
        ("Blue: any", free("Blue")),
    ] {
        assert_eq!(click(&mut harness, name), [Request::Task(order)], "{name}");
    }
}

#[test]
fn a_recording_that_is_not_understood_is_reported() {
    let mut harness = taught(TimelineStage::Finished);
    harness.state_mut().task = ShownTask {
        fault: Some("demo/states.csv:3: expected 14 values".into()),
        ..default()
    };
    harness.run();
    let fault = "demo/states.csv:3: expected 14 values";
    assert!(harness.query_by_label(fault).is_some());
    assert!(harness.query_by_label("Let the robot do it").is_none());
}
