//! A demonstration after undo goes on, bit for bit and byte for byte, like one that never took the detour.

use std::{fs, ops::Range};

use bevy::{app::PluginGroupBuilder, prelude::*};
use tabletop::{
    core::ObjectEdit, history::HistoryPlugin, prelude::*, recorder::write_notes,
    replay::first_difference,
};

use crate::{
    demonstration::{Demonstration, assert_replays, difference_of_replay},
    mechanisms,
    random::{Random, scene, script},
};

const TICKS: u64 = 150;

/// A demonstration of the random scene that is being recorded.
fn begun(name: &str) -> Demonstration {
    let mut demonstration = Demonstration::new(name);
    demonstration.tick(&[scene()]);
    demonstration.tick(&[SimCommand::Recording(RecordingCommand::Start)]);
    demonstration
}

fn assert_same_files(expected: &Demonstration, found: &Demonstration, seed: u64) {
    let difference = first_difference(&expected.folder, &found.folder).unwrap();
    assert_eq!(difference, None, "seed {seed}");
}

#[test]
fn undo_leaves_no_trace() {
    // In 3192 the robot is shown for the first time after the detour.
    let detours = take_detours("few", (0..50).chain([3192]));
    assert!(detours >= 33, "only {detours} detours were taken");
}

#[test]
#[ignore = "takes minutes"]
fn undo_of_many_detours_leaves_no_trace() {
    let detours = take_detours("many", 50..150);
    assert!(detours >= 66, "only {detours} detours were taken");
}

/// Compares demonstrations with a detour that was undone with those that never took it. Returns the number of detours.
fn take_detours(name: &str, seeds: impl Iterator<Item = u64>) -> usize {
    let mut detours = 0;
    'seeds: for seed in seeds {
        let mut random = Random(seed);
        let script = script(&mut random, TICKS);
        let turning_point = random.below(TICKS as usize - 20);
        let detour = self::script(&mut random, 5 + seed % 60);

        let mut straight = begun(&format!("straight_{name}"));
        let mut with_detour = begun(&format!("with_detour_{name}"));
        for (tick, commands) in script.iter().enumerate() {
            straight.tick(commands);
            if tick != turning_point {
                with_detour.tick(commands);
                continue;
            }
            let before = with_detour.undoable();
            with_detour.tick(&[SimCommand::Hand(HandCommand::Grasp {
                hand: Hand::Both,
                object: "ball".into(),
            })]);
            if with_detour.undoable() == before {
                continue 'seeds; // The ball is in these hands already, or gone.
            }
            detours += 1;
            for commands in &detour {
                with_detour.tick(commands);
            }
            let undos = with_detour.undoable() - before;
            let mut last = vec![SimCommand::History(HistoryCommand::Undo); undos];
            last.extend_from_slice(commands);
            with_detour.tick(&last);
            assert_eq!(
                with_detour.bits(),
                straight.bits(),
                "seed {seed}, right after undo"
            );
        }
        assert_eq!(with_detour.bits(), straight.bits(), "seed {seed}");
        for demonstration in [&mut straight, &mut with_detour] {
            demonstration.tick(&[SimCommand::Recording(RecordingCommand::Finish)]);
        }
        assert_same_files(&straight, &with_detour, seed);
    }
    detours
}

#[test]
fn undo_of_a_grasp_drops_the_object_that_was_released_for_it() {
    let begin = [
        (
            vec![SimCommand::Scene(SceneCommand::Load(
                "tablesetup/default.xml".into(),
            ))],
            1,
        ),
        (vec![SimCommand::Recording(RecordingCommand::Start)], 1),
        (vec![grasp(Hand::Left, "RedBlock")], 1),
        (vec![move_to(Hand::Left, (2.0, 0.0, 4.0))], 18),
    ];
    for pause in [false, true] {
        let mut straight = Demonstration::new("released");
        let mut with_detour = Demonstration::new("handed_over");
        straight.act(&begin);
        with_detour.act(&begin);
        with_detour.tick(&[grasp(Hand::Left, "GreenBlock")]);
        if pause {
            with_detour.tick(&[
                SimCommand::Clock(ClockCommand::SetPaused(true)),
                SimCommand::History(HistoryCommand::Undo),
            ]);
            with_detour.tick(&[]);
            with_detour.tick(&[SimCommand::Clock(ClockCommand::SetPaused(false))]);
        } else {
            with_detour.tick(&[SimCommand::History(HistoryCommand::Undo)]);
        }
        straight.tick(&[SimCommand::Hand(HandCommand::Release(Hand::Left))]);
        for tick in 0..30 {
            assert_eq!(with_detour.bits(), straight.bits(), "{tick} ticks later");
            straight.tick(&[]);
            with_detour.tick(&[]);
        }
    }
}

#[test]
fn an_object_released_before_an_undo_in_a_pause_falls_in_time_after_redo() {
    let mut demonstration = begun("undone_in_a_pause");
    let set_paused = |is_paused| ClockCommand::SetPaused(is_paused).into();
    demonstration.act(&[
        (vec![grasp(Hand::Left, "ball")], 2),
        (vec![move_to(Hand::Left, (2.0, 0.0, 4.0))], 30),
        (vec![grasp(Hand::Left, "block4")], 1),
        (vec![set_paused(true)], 1),
        (vec![HistoryCommand::Undo.into()], 1),
        (vec![set_paused(false)], 2),
        (vec![HistoryCommand::Redo.into()], 20),
        (vec![RecordingCommand::Finish.into()], 1),
    ]);
    assert_replays(&demonstration.folder);
}

/// A scene with a screw, and with a block.
fn set_scene() -> SimCommand {
    let block = ObjectSpec::new(
        "block",
        Pose::at(Vec3::new(-8.0, 4.0, 0.5)),
        1.0,
        Shape::Block {
            span: Vec3::ONE,
            color: Rgb::GRAY,
        },
    );
    let mut items = mechanisms::items(Vec3::Z * 2.0);
    items.push(SceneItem::Object(block));
    let scene = SceneSpec { items, ..default() };
    SceneCommand::Set(Box::new(scene)).into()
}

#[test]
fn a_screw_that_came_with_a_grasp_is_fastened_again_after_undo() {
    let mut demonstration = begun("screw_that_came");
    let set_paused = |is_paused| ClockCommand::SetPaused(is_paused).into();
    demonstration.act(&[
        (vec![set_scene(), grasp(Hand::Left, "block")], 1),
        (vec![set_paused(true)], 1),
        (vec![HistoryCommand::Undo.into()], 1),
        (vec![set_paused(false)], 20),
        (vec![RecordingCommand::Finish.into()], 1),
    ]);
    assert_replays(&demonstration.folder);
}

#[test]
fn scenes_that_are_given_with_an_undo_are_set_after_it() {
    let make = || {
        SimCommand::from(SceneCommand::Make {
            preset: Preset::Stack(2),
            seed: 1,
        })
    };
    let clear = || SimCommand::from(SceneCommand::Clear);
    let undo = || SimCommand::from(HistoryCommand::Undo);
    let redo = || SimCommand::from(HistoryCommand::Redo);
    // What is given with the grasp that is undone, and with the undo.
    let cases = [
        (vec![], vec![undo(), make()]),
        (vec![], vec![make(), clear(), undo()]),
        (vec![make()], vec![undo(), make()]),
        (vec![make()], vec![undo(), clear()]),
        (vec![make()], vec![undo(), redo(), make()]),
        (vec![set_scene()], vec![undo(), make()]),
        (vec![set_scene()], vec![undo(), set_scene()]),
        (
            vec![set_scene()],
            vec![undo(), clear(), grasp(Hand::Right, "block")],
        ),
    ];
    for (number, (kept, last)) in cases.into_iter().enumerate() {
        for redoes in [false, true] {
            let mut demonstration = begun(&format!("given_with_undo_{number}"));
            let first = [kept.clone(), vec![grasp(Hand::Left, "block")]].concat();
            demonstration.act(&[(vec![set_scene()], 40), (first, 30), (last.clone(), 20)]);
            let objects = demonstration.app.world().resource::<ObjectIndex>();
            let is_made = objects.get("smallblock").is_some();
            assert_eq!(is_made, last.last() == Some(&make()), "{last:?}");
            if redoes {
                demonstration.act(&[(vec![redo()], 20)]);
            }
            demonstration.act(&[(vec![RecordingCommand::Finish.into()], 1)]);
            assert_replays(&demonstration.folder);
        }
    }
}

#[test]
fn a_button_comes_up_after_a_pause_in_which_the_hand_over_of_its_tick_was_undone() {
    let begun = || {
        let mut demonstration = begun("comes_up");
        let block = |id: &str, x| {
            let color = Rgb::GRAY;
            let span = Vec3::ONE;
            let pose = Pose::at(Vec3::new(x, 4.0, 0.5));
            SceneItem::Object(ObjectSpec::new(id, pose, 1.0, Shape::Block { span, color }))
        };
        let mut items = mechanisms::items(Vec3::Z * 2.0);
        items.extend([block("one", -8.0), block("other", -6.0)]);
        let scene = SceneSpec { items, ..default() };
        let trigger = MechanismCommand::Trigger {
            hand: Hand::Right,
            control: "knob".into(),
            part: None,
        };
        demonstration.act(&[
            (vec![SceneCommand::Set(Box::new(scene)).into()], 60),
            (vec![trigger.into(), grasp(Hand::Left, "one")], 1),
        ]);
        demonstration
    };
    let is_pressed = |demonstration: &Demonstration| {
        let world = demonstration.app.world();
        let knob = world.resource::<ObjectIndex>().get("knob").unwrap();
        let spec = world.get::<ObjectSpec>(knob).unwrap();
        spec.control("knob").unwrap().state != 0
    };
    let mut straight = begun();
    let pressed = (0..100).map(|_| {
        straight.tick(&[]);
        is_pressed(&straight)
    });
    let pressed: Vec<_> = pressed.collect();
    let comes_up = pressed.windows(2).position(|ticks| ticks == [true, false]);
    let comes_up = comes_up.unwrap() as u64 + 1;

    let mut demonstration = begun();
    let set_paused = |is_paused| ClockCommand::SetPaused(is_paused).into();
    demonstration.act(&[(vec![], comes_up)]);
    assert!(is_pressed(&demonstration));
    demonstration.tick(&[grasp(Hand::Left, "other")]);
    assert!(!is_pressed(&demonstration));
    demonstration.act(&[
        (vec![set_paused(true)], 1),
        (vec![HistoryCommand::Undo.into()], 1),
        (vec![set_paused(false), grasp(Hand::Left, "other")], 20),
        (vec![RecordingCommand::Finish.into()], 1),
    ]);
    assert_replays(&demonstration.folder);
}

#[test]
fn a_control_that_shrinks_in_an_undo_leaves_room() {
    let task = r#"<tabletop xmlns="http://synapse.cs.umd.edu/tabletop-xml">
      <customControl id="dial" location="(0,0,0.5)">
        <state><block location="(0,0,0)" xspan="1" yspan="1" zspan="1" nextStateWhenTriggered="1"/></state>
        <state><block location="(0,0,0)" xspan="20" yspan="12" zspan="1"/></state>
      </customControl>
    </tabletop>"#;
    let scene = tabletop::xml::parse("dial.xml".as_ref(), task.as_bytes()).scene;
    let mut demonstration = Demonstration::new("shrunk");
    demonstration.tick(&[SceneCommand::Set(Box::new(scene)).into()]);
    demonstration.tick(&[RecordingCommand::Start.into()]);
    let trigger = MechanismCommand::Trigger {
        hand: Hand::Left,
        control: "dial".into(),
        part: None,
    };
    demonstration.tick(&[trigger.into()]);
    demonstration.tick(&[HistoryCommand::Undo.into()]);
    let preset = Preset::Stack(2);
    demonstration.tick(&[SceneCommand::Make { preset, seed: 1 }.into()]);
    demonstration.tick(&[RecordingCommand::Finish.into()]);
    assert!(
        demonstration
            .app
            .world()
            .resource::<ObjectIndex>()
            .get("smallblock")
            .is_some()
    );
    assert_replays(&demonstration.folder);
}

#[test]
fn redo_brings_back_undone_segments() {
    go_there_and_back_again("few", 1000..1007);
}

#[test]
#[ignore = "takes a minute"]
fn redo_brings_back_undone_segments_many_times() {
    go_there_and_back_again("many", 1007..1020);
}

/// Compares demonstrations that were undone and redone with those that were not.
fn go_there_and_back_again(name: &str, seeds: Range<u64>) {
    for seed in seeds {
        let script = script(&mut Random(seed), 80);
        let mut expected = begun(&format!("expected_{name}"));
        let mut world = begun(&format!("there_and_back_again_{name}"));
        for commands in &script {
            world.tick(commands);
            expected.tick(commands);
        }
        let segments = world.undoable();

        // A tick that undoes everything and brings it back simulates one tick more.
        let mut there_and_back = vec![SimCommand::History(HistoryCommand::Undo); segments];
        there_and_back.extend(vec![SimCommand::History(HistoryCommand::Redo); segments]);
        world.tick(&there_and_back);
        expected.tick(&[]);
        for _ in 0..40 {
            assert_eq!(
                world.bits(),
                expected.bits(),
                "seed {seed}, {segments} segments"
            );
            world.tick(&[]);
            expected.tick(&[]);
        }
        assert_eq!(world.undoable(), segments);
        for demonstration in [&mut expected, &mut world] {
            demonstration.tick(&[SimCommand::Recording(RecordingCommand::Finish)]);
        }
        assert_same_files(&expected, &world, seed);
    }
}

#[test]
fn a_recording_changes_nothing() {
    // In 7022 the scene changes while the robot is shown, and the robot then touches new objects.
    compare_with_unrecorded("few", (2000..2003).chain([7022]));
}

#[test]
#[ignore = "takes a minute"]
fn many_recordings_change_nothing() {
    compare_with_unrecorded("many", 2003..2010);
}

/// Compares a recorded run with an unrecorded one.
fn compare_with_unrecorded(name: &str, seeds: impl Iterator<Item = u64>) {
    for seed in seeds {
        let script = script(&mut Random(seed), 2 * TICKS);
        let mut recorded = begun(&format!("recorded_{name}"));
        let mut unrecorded = Demonstration::new(&format!("unrecorded_{name}"));
        unrecorded.tick(&[scene()]);
        unrecorded.tick(&[]);
        for (tick, commands) in script.iter().enumerate() {
            let mut commands = commands.clone();
            if tick == 200 {
                commands.push(scene());
            }
            recorded.tick(&commands);
            unrecorded.tick(&commands);
        }
        assert_eq!(recorded.bits(), unrecorded.bits(), "seed {seed}");
    }
}

/// Commands, and the number of ticks to simulate with them.
type Act = (Vec<SimCommand>, u64);

fn grasp(hand: Hand, object: &str) -> SimCommand {
    SimCommand::Hand(HandCommand::Grasp {
        hand,
        object: object.into(),
    })
}

fn move_to(hand: Hand, location: (f32, f32, f32)) -> SimCommand {
    SimCommand::Hand(HandCommand::MoveTo {
        hand,
        location: location.into(),
    })
}

/// The acts before and after the detour, which begins in the middle of a fall.
fn way() -> [Vec<Act>; 2] {
    use Hand::{Left, Right};
    [
        vec![
            (
                vec![SimCommand::Scene(SceneCommand::Load(
                    "tablesetup/default.xml".into(),
                ))],
                40,
            ),
            (vec![SimCommand::Recording(RecordingCommand::Start)], 7),
            (vec![grasp(Right, "RedBlock")], 5),
            (vec![move_to(Right, (-1.5, 0.2, 5.0))], 40),
            (vec![SimCommand::Hand(HandCommand::Release(Right))], 9),
        ],
        vec![
            (vec![grasp(Left, "GreenBlock")], 1),
            (vec![move_to(Left, (4.0, 2.0, 3.0))], 45),
            (vec![SimCommand::Hand(HandCommand::Release(Left))], 80),
            (vec![SimCommand::Recording(RecordingCommand::Finish)], 1),
        ],
    ]
}

fn detour() -> Vec<Act> {
    vec![
        (vec![grasp(Hand::Left, "RedBlock")], 20),
        (vec![move_to(Hand::Left, (-5.0, -4.0, 2.0))], 33),
        (vec![grasp(Hand::Both, "GreenBlock")], 3),
        (vec![SimCommand::Hand(HandCommand::Destroy(Hand::Both))], 28),
    ]
}

#[test]
fn undone_segments_leave_no_trace_on_disk() {
    let [before, mut after] = way();
    let mut straight = Demonstration::new("straight_way");
    straight.act(&before);
    straight.act(&after);

    let mut with_detour = Demonstration::new("way_with_detour");
    with_detour.act(&before);
    let segments = with_detour.undoable();
    with_detour.act(&detour());
    let undone = with_detour.undoable() - segments;
    assert!(undone >= 3, "only {undone} segments were begun");
    // In the tick that undoes, the way goes on.
    let commands = &mut after[0].0;
    commands.splice(
        0..0,
        vec![SimCommand::History(HistoryCommand::Undo); undone],
    );
    with_detour.act(&after);

    let text = fs::read_to_string(straight.folder.join("3.txt")).unwrap();
    assert!(text.contains("grasp,LeftHand,GreenBlock"), "{text}");
    let difference = first_difference(&straight.folder, &with_detour.folder).unwrap();
    assert_eq!(difference, None);
}

#[test]
fn redone_segments_are_there_again() {
    let [before, _] = way();
    let finish = [(vec![SimCommand::Recording(RecordingCommand::Finish)], 1)];
    let mut straight = Demonstration::new("straight_on");
    straight.act(&before);
    straight.act(&detour());
    straight.act(&finish);

    let mut there_and_back = Demonstration::new("there_and_back");
    there_and_back.act(&before);
    there_and_back.act(&detour());
    let undone = 3;
    let mut commands = vec![SimCommand::History(HistoryCommand::Undo); undone];
    commands.extend(vec![SimCommand::History(HistoryCommand::Redo); undone]);
    commands.push(SimCommand::Recording(RecordingCommand::Finish));
    there_and_back.act(&[(commands, 1)]);

    let difference = first_difference(&straight.folder, &there_and_back.folder).unwrap();
    assert_eq!(difference, None);
}

/// A random change of an object of the random scene.
fn edit(random: &mut Random) -> SimCommand {
    let object = random.of(&["block0", "block1", "ball", "log", "wall", "c-link2"]);
    let span = Vec3::splat(random.between(0.5, 2.0));
    let color = Rgb::GRAY;
    let place = Pose::at(Vec3::new(random.between(-9.0, 9.0), -1.0, 3.0));
    let spec = ObjectSpec::new(object, place, 2.0, Shape::Block { span, color });
    SceneCommand::Edit(vec![ObjectEdit::Change {
        object: object.into(),
        spec: Box::new(spec),
    }])
    .into()
}

#[test]
fn an_object_that_undo_brings_back_into_the_tick_in_which_it_was_made_falls() {
    let mut demonstration = Demonstration::with("undone_in_its_first_tick", keeps_always());
    let make = SceneCommand::Make {
        preset: Preset::BigBlock,
        seed: 1,
    };
    demonstration.tick(&[make.into(), SceneCommand::Clear.into()]);
    demonstration.act(&[
        (
            vec![HistoryCommand::Undo.into(), RecordingCommand::Start.into()],
            20,
        ),
        (vec![RecordingCommand::Finish.into()], 1),
    ]);
    assert_replays(&demonstration.folder);
}

/// The simulator, which can undo outside recordings, too.
fn keeps_always() -> PluginGroupBuilder {
    TabletopSimPlugins.build().set(HistoryPlugin {
        keeps_always: true,
        ..default()
    })
}

/// A recording after random acts outside recordings, of which some were undone, can be read and replays to the same bytes.
fn record_after_undo(name: &str, seeds: impl Iterator<Item = u64>) {
    for seed in seeds {
        let mut random = Random(seed);
        let name = format!("after_undo_{name}");
        let mut demonstration = Demonstration::with(&name, keeps_always());
        demonstration.tick(&[scene()]);
        for mut commands in script(&mut random, 100) {
            match random.below(16) {
                0 | 1 => commands.insert(0, HistoryCommand::Undo.into()),
                2 => commands.insert(0, HistoryCommand::Redo.into()),
                3 => commands.push(SceneCommand::Clear.into()),
                6 => commands.push(edit(&mut random)),
                4 => commands.push(scene()),
                _ => {}
            }
            demonstration.tick(&commands);
        }
        demonstration.tick(&[
            HistoryCommand::Undo.into(),
            ClockCommand::SetPaused(false).into(),
            // All may have been undone, and a recording needs a scene to begin with.
            scene(),
            RecordingCommand::Start.into(),
        ]);
        for commands in script(&mut random, 40) {
            demonstration.tick(&commands);
        }
        demonstration.tick(&[RecordingCommand::Finish.into()]);
        // What a person writes about a recording is no part of it.
        write_notes(&demonstration.folder, "some of it was undone").unwrap();
        let difference = difference_of_replay(&demonstration.folder);
        assert_eq!(difference, None, "seed {seed}");
    }
}

#[test]
fn a_recording_after_undo_outside_recordings_replays() {
    record_after_undo("few", 0..10);
}

#[test]
#[ignore = "takes minutes"]
fn many_recordings_after_undo_outside_recordings_replay() {
    record_after_undo("many", 20..400);
}
