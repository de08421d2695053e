//! The robot's keys (report sections 5 and 5.1).

use KeyCode::{
    AltLeft, AltRight, Backslash, BracketLeft, BracketRight, ControlLeft, ControlRight, Digit0,
    Digit1, Digit2, Digit9, Equal, KeyG, KeyH, KeyI, KeyJ, KeyK, KeyL, KeyO, KeyP, KeyR, KeyT,
    KeyU, KeyY, Minus, Quote, Semicolon, ShiftLeft, ShiftRight,
};
use RobotJoint::*;
use bevy::prelude::*;
use bevy_egui::input::EguiWantsInput;
use tabletop_core::{KeySystems, Paused, Robot, RobotJoint, SimCommand};

use crate::{
    input::jog::{Directions, Jog},
    input::snapshot::Snapshots,
    panels::head_view::HeadView,
};

/// The keys of the joints, in the order in which they lie; with Shift they turn the other way.
const JOINT_KEYS: [(KeyCode, RobotJoint); 15] = [
    (KeyT, RightW2),
    (KeyY, RightW1),
    (KeyU, RightW0),
    (KeyI, RightE1),
    (KeyO, RightE0),
    (KeyP, RightS1),
    (BracketLeft, RightS0),
    (KeyG, LeftW2),
    (KeyH, LeftW1),
    (KeyJ, LeftW0),
    (KeyK, LeftE1),
    (KeyL, LeftE0),
    (Semicolon, LeftS1),
    (Quote, LeftS0),
    (BracketRight, HeadPan),
];

/// The keys of the grippers: 1 opens, -1 closes.
const GRIPPER_KEYS: [(KeyCode, RobotJoint, i8); 4] = [
    (Equal, RightGripper, 1),
    (Minus, RightGripper, -1),
    (Digit0, LeftGripper, 1),
    (Digit9, LeftGripper, -1),
];

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<EguiWantsInput>().add_systems(
        RunFixedMainLoop,
        (
            hold_joint_keys.in_set(RunFixedMainLoopSystems::BeforeFixedMainLoop),
            (
                show_or_hide.run_if(was_struck(KeyR)),
                show_next_face.run_if(was_struck(Backslash)),
                (|mut view: ResMut<HeadView>| view.toggle()).run_if(was_struck(Digit1)),
                (|mut snapshots: ResMut<Snapshots>| snapshots.take_one())
                    .run_if(was_struck(Digit2)),
            )
                .in_set(KeySystems)
                .run_if(Paused::is_running),
        ),
    );
}

/// With Ctrl or Alt, keys mean something else.
fn are_plain(keys: &ButtonInput<KeyCode>) -> bool {
    !keys.any_pressed([ControlLeft, ControlRight, AltLeft, AltRight])
}

fn was_struck(key: KeyCode) -> impl FnMut(Res<ButtonInput<KeyCode>>) -> bool + Clone {
    move |keys| keys.just_pressed(key) && are_plain(&keys)
}

fn show_or_hide(robot: Res<Robot>, mut commands: MessageWriter<SimCommand>) {
    commands.write(SimCommand::ShowRobot(!robot.is_shown));
}

fn show_next_face(robot: Res<Robot>, mut commands: MessageWriter<SimCommand>) {
    commands.write(SimCommand::ShowFace(robot.face.next()));
}

/// Reads the keys of joints and grippers, once a frame for all of its ticks.
fn hold_joint_keys(
    keys: Res<ButtonInput<KeyCode>>,
    wanted: Res<EguiWantsInput>,
    paused: Res<Paused>,
    mut jog: ResMut<Jog>,
) {
    let (held, struck) = if paused.0 || wanted.wants_any_keyboard_input() || !are_plain(&keys) {
        default()
    } else {
        let shift = keys.any_pressed([ShiftLeft, ShiftRight]);
        (
            directions(shift, |key| keys.pressed(key)),
            directions(shift, |key| keys.just_pressed(key)),
        )
    };
    jog.keys.update(held, struck);
}

/// Where these keys move the joints; those of a joint that contradict each other move nothing.
fn directions(shift: bool, is_on: impl Fn(KeyCode) -> bool) -> Directions {
    let turn = if shift { -1 } else { 1 };
    let of_joints = JOINT_KEYS.map(|(key, joint)| (key, joint, turn));
    let mut directions = Directions::default();
    for (key, joint, direction) in of_joints.into_iter().chain(GRIPPER_KEYS) {
        if is_on(key) {
            directions[joint.index()] += direction;
        }
    }
    directions
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        input::{jog, keys},
        test_world::TestWorld,
    };
    use KeyCode::{
        Escape, KeyA, KeyB, KeyC, KeyD, KeyM, KeyN, KeyQ, KeyS, KeyW, KeyZ, Slash, Space,
    };
    use bevy::time::TimeUpdateStrategy;
    use std::time::Duration;
    use tabletop_core::{Drive, Face};

    fn test_world() -> TestWorld {
        TestWorld::new(|app: &mut App| {
            app.init_resource::<HeadView>()
                .init_resource::<Snapshots>()
                .add_plugins((keys::plugin, jog::plugin, plugin));
        })
    }

    fn drive(joint: RobotJoint, velocity: f64) -> SimCommand {
        SimCommand::Drive(vec![(joint, Drive::Velocity(velocity))])
    }

    /// What is asked for in a frame in which these keys are held down.
    fn held(test: &mut TestWorld, keys: &[KeyCode]) -> Vec<SimCommand> {
        keys.iter().for_each(|&key| test.keys().press(key));
        let commands = test.hold_still();
        test.keys().release_all();
        test.keys().clear();
        test.hold_still();
        commands
    }

    #[test]
    fn each_key_moves_its_joint_as_the_report_says() {
        let mut test = test_world();
        for (key, joint, velocity) in [
            (KeyT, RightW2, -1.0),
            (KeyY, RightW1, 1.0),
            (KeyU, RightW0, -1.0),
            (KeyI, RightE1, 1.0),
            (KeyO, RightE0, -1.0),
            (KeyP, RightS1, 1.0),
            (BracketLeft, RightS0, -1.0),
            (KeyG, LeftW2, 1.0),
            (KeyH, LeftW1, 1.0),
            (KeyJ, LeftW0, 1.0),
            (KeyK, LeftE1, 1.0),
            (KeyL, LeftE0, 1.0),
            (Semicolon, LeftS1, 1.0),
            (Quote, LeftS0, 1.0),
            (BracketRight, HeadPan, 1.0),
        ] {
            assert_eq!(held(&mut test, &[key]), [drive(joint, velocity)], "{key:?}");
            for shift in [ShiftLeft, ShiftRight] {
                let commands = held(&mut test, &[shift, key]);
                assert_eq!(commands, [drive(joint, -velocity)], "{key:?}");
            }
        }
    }

    #[test]
    fn shift_makes_no_difference_to_a_gripper() {
        let mut test = test_world();
        for (key, joint, velocity) in [
            (Equal, RightGripper, 1.0),
            (Minus, RightGripper, -1.0),
            (Digit0, LeftGripper, 1.0),
            (Digit9, LeftGripper, -1.0),
        ] {
            for keys in [&[key][..], &[ShiftLeft, key]] {
                assert_eq!(held(&mut test, keys), [drive(joint, velocity)], "{key:?}");
            }
        }
        assert_eq!(held(&mut test, &[Digit0, Digit9]), []);
    }

    #[test]
    fn several_keys_make_one_order() {
        let mut test = test_world();
        let both = vec![
            (LeftE1, Drive::Velocity(1.0)),
            (RightE1, Drive::Velocity(1.0)),
        ];
        assert_eq!(held(&mut test, &[KeyI, KeyK]), [SimCommand::Drive(both)]);
    }

    #[test]
    fn every_tick_of_a_frame_gets_its_order() {
        let mut test = test_world();
        test.app
            .insert_resource(TimeUpdateStrategy::FixedTimesteps(3));
        test.keys().press(KeyK);
        for _ in 0..2 {
            assert_eq!(test.hold_still(), vec![drive(LeftE1, 1.0); 3]);
        }
        test.keys().release(KeyK);
        assert_eq!(test.hold_still(), []);
    }

    #[test]
    fn a_short_press_moves_for_one_tick_however_frames_and_ticks_fall() {
        for (milliseconds, ticks_later) in [(5, 20), (17, 4), (100, 2)] {
            let mut test = test_world();
            let frame = Duration::from_millis(milliseconds);
            test.app
                .insert_resource(TimeUpdateStrategy::ManualDuration(frame));
            // Down and up between two frames.
            test.keys().press(KeyK);
            test.keys().release(KeyK);
            let frames = (0..ticks_later).map(|_| test.hold_still());
            let commands: Vec<_> = frames.flatten().collect();
            assert_eq!(commands, [drive(LeftE1, 1.0)], "{milliseconds} ms");
        }
    }

    #[test]
    fn keys_are_deaf_during_a_pause_even_in_its_first_tick() {
        let mut test = test_world();
        for key in [KeyK, Space] {
            test.keys().press(key);
        }
        assert_eq!(test.hold_still(), [SimCommand::SetPaused(true)]);
        assert_eq!(held(&mut test, &[KeyK, KeyR, Backslash]), []);
        assert_eq!(held(&mut test, &[Space]), [SimCommand::SetPaused(false)]);
        assert_eq!(held(&mut test, &[KeyK]), [drive(LeftE1, 1.0)]);
    }

    #[test]
    fn ctrl_and_alt_mean_something_else() {
        let mut test = test_world();
        for modifier in [ControlLeft, AltRight] {
            assert_eq!(held(&mut test, &[modifier, KeyK, KeyR, Digit1]), []);
        }
        assert!(!test.app.world().resource::<HeadView>().is_shown());
    }

    #[test]
    fn keys_show_the_robot_and_its_faces_once_a_press() {
        let mut test = test_world();
        for (key, command) in [
            (KeyR, SimCommand::ShowRobot(true)),
            (Backslash, SimCommand::ShowFace(Face::Happy)),
        ] {
            test.keys().press(key);
            assert_eq!(test.hold_still(), [command]);
            assert_eq!(test.hold_still(), []);
            test.keys().release(key);
        }
        test.app.world_mut().resource_mut::<Robot>().is_shown = true;
        assert_eq!(held(&mut test, &[KeyR]), [SimCommand::ShowRobot(false)]);
    }

    #[test]
    fn keys_toggle_the_head_view_and_save_it_once_a_press() {
        let mut test = test_world();
        for is_shown in [true, false] {
            test.keys().press(Digit1);
            for _ in 0..3 {
                test.hold_still();
                let view = test.app.world().resource::<HeadView>();
                assert_eq!(view.is_shown(), is_shown);
            }
            test.keys().release(Digit1);
        }
        held(&mut test, &[Digit2]);
        assert!(test.app.world().resource::<Snapshots>().are_wanted());
    }

    #[test]
    fn no_key_means_two_things() {
        let others = [
            KeyW, KeyS, KeyA, KeyD, KeyQ, KeyZ, Slash, Space, Escape, KeyN, KeyB, KeyC, KeyM, KeyR,
            Backslash, Digit1, Digit2,
        ];
        let joints = JOINT_KEYS.map(|(key, _)| key);
        let grippers = GRIPPER_KEYS.map(|(key, ..)| key);
        let all = others.into_iter().chain(joints).chain(grippers);
        let distinct: std::collections::HashSet<_> = all.clone().collect();
        assert_eq!(distinct.len(), all.count());
    }
}
