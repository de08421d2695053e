use bevy::time::TimeUpdateStrategy;
use bevy_egui::egui;
use egui_kittest::{
    Harness,
    kittest::{NodeT as _, Queryable as _},
};
use tabletop_core::CorePlugin;
use tabletop_user::UserPlugin;

use super::*;
use crate::panels::test_click::after_click;

#[test]
fn the_users_first_grasp_opens_the_panel_and_later_ones_leave_it_closed() {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, CorePlugin::default(), UserPlugin))
        .insert_resource(TimeUpdateStrategy::FixedTimesteps(1))
        .init_resource::<Panels>()
        .add_systems(Update, open_at_first_grasp);
    for (is_replaying, is_open) in [(true, false), (false, true), (false, false)] {
        app.insert_resource(Replaying(is_replaying));
        app.world_mut()
            .write_message(SimFact::Hand(HandFact::Grasped {
                cause: tabletop_core::CommandId(0),
                hand: Hand::Any,
                id: "red".into(),
            }));
        app.update();
        let mut panels = app.world_mut().resource_mut::<Panels>();
        assert_eq!(panels.is_open(Panel::DemonstrationTools), is_open);
        panels.set_open(Panel::DemonstrationTools, false);
    }
}

/// The content of the panel in a test, and everything that was asked of it.
#[derive(Clone, Debug, Default)]
struct Stage {
    hand: Hand,
    held: Option<&'static str>,
    is_recording: bool,
    history: History,
    keymap: Keymap,
    take: NextTake,
    plane: PlaneButtons,
    requests: Vec<Request>,
}

impl Stage {
    fn holding() -> Self {
        Self {
            held: Some("red"),
            ..default()
        }
    }

    fn recording(undoable: usize, redoable: usize) -> Self {
        Self {
            is_recording: true,
            history: History {
                undoable,
                redoable,
                ..default()
            },
            ..default()
        }
    }

    fn harness(self) -> Harness<'static, Self> {
        let frame = |ui: &mut Ui, stage: &mut Self| {
            let model = Model {
                hand: stage.hand,
                held: stage.held,
                turns: [10, 0, -20],
                is_recording: stage.is_recording,
                history: stage.history,
                keymap: &stage.keymap,
            };
            let input = show(ui, &model, &mut stage.take);
            stage.plane = input.plane;
            stage.requests.extend(input.request);
        };
        Harness::builder()
            .with_size(egui::vec2(Panel::DemonstrationTools.width(), 400.0))
            .build_ui_state(frame, self)
    }

    fn after_click(self, name: &str) -> Vec<Request> {
        after_click(self.harness(), name).requests
    }
}

#[test]
fn each_hand_can_be_selected() {
    for hand in Hand::ALL {
        let other = Hand::ALL.into_iter().find(|&other| other != hand);
        let stage = Stage {
            hand: other.unwrap(),
            ..default()
        };
        let requests = stage.after_click(&format!("{hand:?}"));
        assert_eq!(requests, [Request::Select(hand)]);
    }
}

#[test]
fn the_held_object_is_named_released_and_destroyed() {
    let harness = Stage::holding().harness();
    assert!(harness.query_by_label("red").is_some());
    for (name, request) in [("Release", Request::Release), ("Destroy", Request::Destroy)] {
        assert_eq!(Stage::holding().after_click(name), [request]);
    }
}

#[test]
fn each_slider_turns_the_held_object() {
    for (axis, (name, degrees)) in [("X", 10), ("Y", 0), ("Z", -20)].into_iter().enumerate() {
        for (step, way) in [(1, "up"), (-1, "down")] {
            let requests = Stage::holding().after_click(&format!("{name} {way} by 1°"));
            let degrees = degrees + step;
            assert_eq!(requests, [Request::TurnTo { axis, degrees }]);
        }
    }
}

#[test]
fn an_empty_hand_can_do_nothing_with_objects() {
    let harness = Stage::default().harness();
    assert!(harness.query_by_label(EMPTY).is_some());
    for name in ["Release", "Destroy", "X up by 1°", "Z down by 1°"] {
        assert_eq!(Stage::default().after_click(name), [], "{name}");
    }
}

#[test]
fn the_plane_turns_while_its_buttons_are_held_down() {
    for (name, expected) in [("CCW", (true, false)), ("CW", (false, true))] {
        let mut harness = Stage::holding().harness();
        let at = harness.get_by_label(name).rect().center();
        let plane = |harness: &Harness<Stage>| {
            let plane = harness.state().plane;
            (plane.counter_clockwise, plane.clockwise)
        };
        harness.hover_at(at);
        harness.drag_at(at);
        harness.run();
        harness.run();
        assert_eq!(plane(&harness), expected);
        harness.drop_at(at);
        harness.run();
        assert_eq!(plane(&harness), (false, false));
    }
}

#[test]
fn a_recording_is_started_or_finished_undone_and_redone() {
    for (stage, allowed) in [
        (Stage::default(), &["Start"][..]),
        (Stage::recording(0, 0), &["Finish"]),
        (Stage::recording(2, 0), &["Finish", "Undo"]),
        (Stage::recording(0, 1), &["Finish", "Redo"]),
    ] {
        for (name, request) in [
            ("Start", Request::Start),
            ("Finish", Request::Finish),
            ("Undo", Request::Undo),
            ("Redo", Request::Redo),
        ] {
            let requests = stage.clone().after_click(name);
            let expected = allowed.contains(&name).then_some(request);
            assert_eq!(requests, expected.into_iter().collect::<Vec<_>>(), "{name}");
        }
    }
}

#[test]
fn every_request_becomes_its_command() {
    let mut turns = TurnSums::default();
    let hand = Hand::Left;
    for (request, expected) in [
        (
            Request::Select(Hand::Both),
            SimCommand::Hand(HandCommand::Select(Hand::Both)),
        ),
        (
            Request::Release,
            SimCommand::Hand(HandCommand::Release(hand)),
        ),
        (
            Request::Destroy,
            SimCommand::Hand(HandCommand::Destroy(hand)),
        ),
        (
            Request::TurnTo {
                axis: 2,
                degrees: 30,
            },
            SimCommand::Hand(HandCommand::Turn {
                hand,
                axis: Vec3::Z,
                degrees: 30.0,
            }),
        ),
        (
            Request::Start,
            SimCommand::Recording(RecordingCommand::Start),
        ),
        (
            Request::Finish,
            SimCommand::Recording(RecordingCommand::Finish),
        ),
        (Request::Undo, SimCommand::History(HistoryCommand::Undo)),
        (Request::Redo, SimCommand::History(HistoryCommand::Redo)),
    ] {
        assert_eq!(command(request, hand, &mut turns), Some(expected));
    }
}

#[test]
fn tooltips_name_the_keys() {
    let mut harness = Stage::recording(1, 0).harness();
    harness.get_by_label("Undo").hover();
    harness.run_steps(8);
    let reported = harness.query_by_label_contains("(Ctrl+Z)");
    assert!(reported.is_some());
}

#[test]
fn the_next_take_is_named_before_it_begins_and_its_notes_stay_open() {
    let mut harness = Stage::default().harness();
    for (field, text) in [("Name:", "tower/1"), ("Notes:", "slowly")] {
        harness.get_by_label(field).focus();
        harness.run();
        harness.get_by_label(field).type_text(text);
        harness.run();
    }
    let take = &harness.state().take;
    assert_eq!((&*take.name, &*take.notes), ("tower-1", "slowly"));
    let recording = Stage::recording(0, 0).harness();
    assert!(
        recording
            .get_by_label("Name:")
            .accesskit_node()
            .is_disabled()
    );
    assert!(
        !recording
            .get_by_label("Notes:")
            .accesskit_node()
            .is_disabled()
    );
}

#[test]
fn the_name_of_the_takes_gets_the_keyboard_when_it_is_called() {
    let mut harness = Stage::default().harness();
    crate::widgets::focus::call(&harness.ctx, take::name_id());
    harness.run();
    harness.event(egui::Event::Text("tower".into()));
    harness.run();
    assert_eq!(harness.state().take.name, "tower");
}

#[test]
fn a_long_id_is_seen_to_its_end() {
    let mut stage = Stage::holding();
    let held = "the third red block from the left, which is the smallest one";
    stage.held = Some(held);
    let mut harness = stage.harness();
    harness.run();
    let id = harness.get_by_label(held).rect();
    assert!(id.right() <= Panel::DemonstrationTools.width(), "{id}");
    assert!(id.height() > 25.0, "{id}");
}
