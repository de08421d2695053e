mod edits;
mod lesson;
mod meaning;

use std::fs::File;

use bevy_egui::egui::{Pos2, Vec2, vec2};
use egui_kittest::{Harness, kittest::Queryable as _};
use tabletop_core::{
    Act, Arm, Hand, Manipulator, Required, ShownProperty, ShownRole, ShownStep, TimelineGrip,
    TimelinePicture, TimelineSegment, Verb,
};
use tabletop_geometry::Rgb;
use tabletop_user::{Pace, TaskOrder, TimelineEdit};

use super::*;
use crate::pictures::Pictures;

/// The model and the requests of a test.
struct Desk {
    timeline: Timeline,
    playback: Playback,
    shown: SimTick,
    is_paused: bool,
    pace: Pace,
    history: History,
    keymap: Keymap,
    task: ShownTask,
    taught: TaughtProgram,
    imitating: Imitating,
    editing: Editing,
    view: View,
    requests: Vec<Request>,
}

impl Desk {
    fn new(stage: TimelineStage) -> Self {
        let timeline = match stage {
            TimelineStage::Absent => Timeline::default(),
            stage @ (TimelineStage::Running | TimelineStage::Finished | TimelineStage::Open) => {
                Timeline {
                    stage,
                    ..timeline()
                }
            }
        };
        Self {
            timeline,
            playback: Playback::default(),
            shown: SimTick(100),
            is_paused: true,
            pace: Pace::Normal,
            history: History {
                undoable: 2,
                redoable: 1,
                ..default()
            },
            keymap: Keymap::default(),
            task: ShownTask::default(),
            taught: TaughtProgram::default(),
            imitating: Imitating::Idle,
            editing: Editing::default(),
            view: View::default(),
            requests: Vec::new(),
        }
    }

    fn show(ui: &mut Ui, desk: &mut Self) {
        let model = Model {
            timeline: &desk.timeline,
            playback: desk.playback,
            shown: desk.shown,
            is_paused: desk.is_paused,
            pace: desk.pace,
            history: desk.history,
            keymap: &desk.keymap,
            task: &desk.task,
            taught: &desk.taught,
            imitating: &desk.imitating,
            editing: &desk.editing,
        };
        let requests = show(ui, &model, &mut desk.view);
        desk.requests.extend(requests);
    }
}

/// Ten seconds from tick 100 on: a block is grasped after 3 s and released after 6 s.
fn timeline() -> Timeline {
    let segment = |start, verb| TimelineSegment {
        start: SimTick(start),
        act: Option::map(verb, |verb| Act {
            manipulator: Manipulator::Hand(Hand::Left),
            verb,
            object: Some("RedBlock".into()),
        }),
        color: Some(Rgb::new(1.0, 0.0, 0.0)),
    };
    let picture = |tick| TimelinePicture {
        tick: SimTick(tick),
        path: "no such picture.png".into(),
        serial: tick as usize,
    };
    Timeline {
        stage: TimelineStage::Open,
        folder: "demo".into(),
        start: SimTick(100),
        end: SimTick(700),
        segments: vec![
            segment(100, None),
            segment(280, Some(Verb::Grasp)),
            segment(460, Some(Verb::Release)),
        ],
        pictures: (0..=40).map(|frame| picture(100 + 15 * frame)).collect(),
        grips: vec![TimelineGrip {
            tick: SimTick(400),
            act: Act {
                manipulator: Manipulator::Gripper(Arm::Left.name()),
                verb: Verb::Grasp,
                object: Some("Ball".into()),
            },
        }],
    }
}

fn harness(desk: Desk) -> Harness<'static, Desk> {
    let mut harness = Harness::builder()
        .with_size(vec2(680.0, 480.0))
        .build_ui_state(Desk::show, desk);
    harness.run();
    harness
}

/// The requests of a click on the widget of this name.
fn click(harness: &mut Harness<Desk>, name: &str) -> Vec<Request> {
    harness.get_by_label(name).click();
    harness.run();
    std::mem::take(&mut harness.state_mut().requests)
}

fn place_of(harness: &Harness<Desk>, name: &str) -> Pos2 {
    harness.get_by_label(name).rect().center()
}

#[test]
fn every_button_of_an_open_recording_makes_its_request() {
    let mut desk = Desk::new(TimelineStage::Open);
    desk.shown = SimTick(500);
    let mut harness = harness(desk);
    let at = |tick| Request::StopAt(SimTick(tick));
    for (name, request) in [
        ("Play", Request::Play),
        ("Step", Request::Step),
        ("Back one tick", at(499)),
        ("Back one frame", at(485)),
        ("Forward one frame", at(515)),
        ("Previous segment", Request::GoTo(SimTick(460))),
        ("Next segment", Request::GoTo(SimTick(700))),
        ("Pace ¼×", Request::SetPace(Pace::Quarter)),
        ("Pace ½×", Request::SetPace(Pace::Half)),
        ("Pace 2×", Request::SetPace(Pace::Double)),
        ("Pace 4×", Request::SetPace(Pace::Fourfold)),
        ("Pace 8×", Request::SetPace(Pace::Eightfold)),
        ("Loop", Request::Loop(true)),
        ("Close", Request::Close),
    ] {
        assert_eq!(click(&mut harness, name), [request], "{name}");
    }
    assert_eq!(click(&mut harness, "Pace 1×"), [], "it is on already");
    harness.state_mut().pace = Pace::Quarter;
    harness.run();
    let normal = Request::SetPace(Pace::Normal);
    assert_eq!(click(&mut harness, "Pace 1×"), [normal]);
    harness.state_mut().is_paused = false;
    harness.state_mut().playback.loops = true;
    harness.run();
    assert_eq!(click(&mut harness, "Pause"), [Request::Pause]);
    assert_eq!(click(&mut harness, "Loop"), [Request::Loop(false)]);
}

#[test]
fn the_way_back_leads_to_the_beginning_of_the_segment_and_then_to_the_one_before() {
    let mut harness = harness(Desk::new(TimelineStage::Open));
    for (shown, before, after) in [
        (500, 460, 700),
        (470, 280, 700),
        (100, 100, 280),
        (300, 100, 460),
    ] {
        harness.state_mut().shown = SimTick(shown);
        harness.run();
        let to = |tick| [Request::GoTo(SimTick(tick))];
        assert_eq!(click(&mut harness, "Previous segment"), to(before));
        assert_eq!(click(&mut harness, "Next segment"), to(after));
    }
}

#[test]
fn a_click_on_a_segment_or_a_picture_goes_there() {
    let mut harness = harness(Desk::new(TimelineStage::Open));
    let requests = click(&mut harness, "Segment 1: LeftHand grasps RedBlock");
    let [Request::GoTo(tick)] = requests[..] else {
        panic!("{requests:?}");
    };
    assert!(tick.0.abs_diff(370) < 5, "{tick:?}, in its middle");
    let picture = Request::GoTo(SimTick(100));
    let requests = harness.query_all_by_label_contains("Picture of ").count();
    assert!(requests > 3, "{requests} pictures");
    harness.state_mut().timeline.pictures.truncate(1);
    harness.run();
    assert_eq!(click(&mut harness, "Picture of 0.00 s"), [picture]);
}

#[test]
fn while_the_mouse_drags_the_picture_is_large_and_then_the_world_follows() {
    let mut harness = harness(Desk::new(TimelineStage::Open));
    let ruler = harness.get_by_label("Time").rect();
    let at = |part: f32| ruler.lerp_inside(vec2(part, 0.5));
    harness.hover_at(at(0.1));
    harness.drag_at(at(0.1));
    harness.run();
    harness.hover_at(at(0.5));
    harness.run();
    assert!(harness.query_by_label("Large picture of 5.00 s").is_some());
    assert_eq!(harness.state().requests, []);
    harness.drop_at(at(0.5));
    harness.run();
    let there = Request::GoTo(SimTick(400));
    assert_eq!(harness.state().requests, [there]);
    harness.run();
    assert!(harness.query_by_label("Large picture of 5.00 s").is_none());
}

#[test]
fn of_a_running_recording_the_past_is_looked_at_and_undone() {
    let mut desk = Desk::new(TimelineStage::Running);
    desk.shown = SimTick(700);
    let mut harness = harness(desk);
    assert!(harness.query_by_label("Back one tick").is_none());
    assert_eq!(click(&mut harness, "Undo back to here"), [Request::Undo(1)]);
    assert_eq!(click(&mut harness, "Redo"), [Request::Redo]);
    let segment = "Segment 1: LeftHand grasps RedBlock";
    let place = harness.get_all_by_label(segment).next().unwrap().rect();
    harness.hover_at(place.center());
    harness.drag_at(place.center());
    harness.drop_at(place.center());
    harness.run();
    assert_eq!(harness.state().requests, [], "the world stays");
    let seen = harness.query_all_by_label_contains("Large picture of ");
    assert_eq!(seen.count(), 1);
    assert_eq!(click(&mut harness, "Undo back to here"), [Request::Undo(2)]);
    let seen = harness.query_all_by_label_contains("Large picture of ");
    assert_eq!(seen.count(), 0, "the present is seen again");
    assert_eq!(click(&mut harness, "Segment 0: Beginning"), []);
    assert_eq!(
        click(&mut harness, "Undo back to here"),
        [],
        "not the first one"
    );
    assert_eq!(click(&mut harness, "Back to now"), []);
    assert_eq!(harness.state().view.looked_at, None);
}

#[test]
fn a_finished_recording_can_be_opened() {
    let mut harness = harness(Desk::new(TimelineStage::Finished));
    assert_eq!(click(&mut harness, "Open"), [Request::Open("demo".into())]);
    assert!(harness.query_by_label("Undo back to here").is_none());
}

#[test]
fn without_a_recording_the_clock_is_there_and_how_to_get_one() {
    let mut harness = harness(Desk::new(TimelineStage::Absent));
    assert!(harness.query_by_label(ABSENT).is_some());
    assert_eq!(click(&mut harness, "Step"), [Request::Step]);
    assert_eq!(
        click(&mut harness, "Pace 2×"),
        [Request::SetPace(Pace::Double)]
    );
    assert!(harness.query_by_label("Time").is_none());
}

#[test]
fn while_the_world_is_being_brought_to_a_moment_buttons_wait() {
    let mut desk = Desk::new(TimelineStage::Open);
    desk.playback.goal = Some(SimTick(400));
    let mut harness = harness(desk);
    assert_eq!(click(&mut harness, "Step"), []);
    assert!(harness.query_by_label("going to 5.00 s …").is_some());
}

#[test]
fn grips_are_on_the_timeline() {
    let harness = harness(Desk::new(TimelineStage::Open));
    let grip = harness.get_by_label("5.00 s: left gripper grasps Ball");
    let ruler = harness.get_by_label("Time").rect();
    assert!((grip.rect().center().x - ruler.center().x).abs() < 1.0);
}

#[test]
fn the_panels_reads_and_writes_do_not_conflict() {
    let mut system = IntoSystem::into_system(show_panel);
    system.initialize(&mut World::new());
}

#[test]
fn each_widget_is_found_by_its_name() {
    let harness = harness(Desk::new(TimelineStage::Open));
    for name in ["Play", "Loop", "Close", "Pace 2×"] {
        let place = place_of(&harness, name);
        assert!(place.x > 0.0 && place.y < 60.0, "{name} is at {place}");
    }
}

#[test]
fn pictures_are_read_from_their_files_a_few_a_frame() {
    let path = std::env::temp_dir().join(format!("tabletop_film_{}.png", std::process::id()));
    let mut encoder = png::Encoder::new(File::create(&path).unwrap(), 4, 2);
    encoder.set_color(png::ColorType::Rgba);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&[200; 4 * 2 * 4]).unwrap();
    writer.finish().unwrap();
    let mut pictures = Pictures::default();
    pictures.begin_frame(&timeline().folder);
    let context = egui::Context::default();
    let picture = |serial| TimelinePicture {
        tick: SimTick(1),
        path: path.clone(),
        serial,
    };
    let size = pictures.texture(&context, &picture(0)).unwrap().size_vec2();
    assert_eq!(size, Vec2::new(4.0, 2.0));
    let read = (1..10).filter(|&serial| pictures.texture(&context, &picture(serial)).is_some());
    assert_eq!(read.count(), 3);
    pictures.begin_frame(&timeline().folder);
    assert!(pictures.texture(&context, &picture(9)).is_some());
    std::fs::remove_file(&path).unwrap();
    assert!(
        pictures.texture(&context, &picture(9)).is_some(),
        "it was read"
    );
    assert!(pictures.texture(&context, &picture(11)).is_none());
}

#[test]
fn the_playhead_is_seen_in_each_theme() {
    for theme in [egui::Theme::Dark, egui::Theme::Light] {
        let mut harness = harness(Desk::new(TimelineStage::Open));
        harness.ctx.set_theme(theme);
        harness.run();
        let ink = harness.ctx.global_style().visuals.strong_text_color();
        let mut shapes = harness.output().shapes.iter();
        let is_seen = shapes.any(|clipped| {
            matches!(&clipped.shape, egui::Shape::LineSegment { stroke, .. } if stroke.color == ink)
        });
        assert!(is_seen, "{theme:?}");
    }
}
