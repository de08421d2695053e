//! The robot's keys (report sections 5 and 5.1).

use bevy::prelude::*;
use tabletop_core::{Actor, CommandWriter, Paused, Robot, RobotCommand, RobotLayout};
use tabletop_user::{Action, HeadView, KeySystems, Keys, Way, was_struck};

use crate::{
    jog::{Directions, Jog},
    snapshot::Snapshots,
};

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(
        RunFixedMainLoop,
        (
            hold_joint_keys.in_set(RunFixedMainLoopSystems::BeforeFixedMainLoop),
            (
                show_or_hide.run_if(was_struck(Action::ShowRobot)),
                show_next_face.run_if(was_struck(Action::ShowNextFace)),
                (|mut view: ResMut<HeadView>| view.toggle())
                    .run_if(was_struck(Action::ShowHeadView)),
                (|mut snapshots: ResMut<Snapshots>| snapshots.take_one())
                    .run_if(was_struck(Action::SaveHeadView)),
            )
                .in_set(KeySystems)
                .run_if(Paused::is_running),
        ),
    );
}

fn show_or_hide(robot: Res<Robot>, mut commands: CommandWriter) {
    commands.write(Actor::Key, RobotCommand::Show(!robot.is_shown));
}

fn show_next_face(robot: Res<Robot>, mut commands: CommandWriter) {
    commands.write(Actor::Key, RobotCommand::ShowFace(robot.face.next()));
}

/// Reads the keys of joints and grippers, once a frame for all of its ticks.
fn hold_joint_keys(
    keys: Keys,
    paused: Res<Paused>,
    layout: Res<RobotLayout>,
    mut jog: ResMut<Jog>,
) {
    let (held, struck) = match paused.0 {
        true => default(),
        false => (
            directions(&layout, |action| keys.is_held(action)),
            directions(&layout, |action| keys.was_struck(action)),
        ),
    };
    jog.keys.update(held, struck);
}

/// The directions in which these actions move the joints; those of a joint that contradict each other move nothing.
fn directions(layout: &RobotLayout, is_on: impl Fn(Action) -> bool) -> Directions {
    Directions::of(layout, |joint| {
        let joint = layout.joint(joint);
        let is_on = |way| i8::from(is_on(Action::Move(joint.name, way)));
        is_on(Way::Plus) - is_on(Way::Minus)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{jog, keys, test_world::TestWorld};
    use KeyCode::{
        AltRight, Backslash, BracketLeft, BracketRight, ControlLeft, Digit0, Digit1, Digit2,
        Digit9, Equal, KeyG, KeyH, KeyI, KeyJ, KeyK, KeyL, KeyO, KeyP, KeyR, KeyT, KeyU, KeyY,
        Minus, Quote, Semicolon, ShiftLeft, ShiftRight, Space,
    };
    use bevy::{
        input::{
            ButtonState, InputPlugin,
            keyboard::{Key, KeyboardFocusLost, KeyboardInput},
        },
        time::TimeUpdateStrategy,
    };
    use std::time::Duration;
    use tabletop_core::RobotJoint::{self, *};
    use tabletop_core::{ClockCommand, Drive, Face, SimCommand};

    fn test_world() -> TestWorld {
        TestWorld::new(|app: &mut App| {
            app.init_resource::<HeadView>()
                .init_resource::<Snapshots>()
                .add_plugins((keys::plugin, jog::plugin, plugin));
        })
    }

    fn drive(joint: RobotJoint, velocity: f64) -> SimCommand {
        SimCommand::Robot(RobotCommand::drive([(joint, Drive::Velocity(velocity))]))
    }

    /// The commands of a frame in which these keys are held down.
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
        let both = [
            (LeftE1, Drive::Velocity(1.0)),
            (RightE1, Drive::Velocity(1.0)),
        ];
        assert_eq!(
            held(&mut test, &[KeyI, KeyK]),
            [SimCommand::Robot(RobotCommand::drive(both))]
        );
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
        assert_eq!(
            test.hold_still(),
            [SimCommand::Clock(ClockCommand::SetPaused(true))]
        );
        assert_eq!(held(&mut test, &[KeyK, KeyR, Backslash]), []);
        assert_eq!(
            held(&mut test, &[Space]),
            [SimCommand::Clock(ClockCommand::SetPaused(false))]
        );
        assert_eq!(held(&mut test, &[KeyK]), [drive(LeftE1, 1.0)]);
    }

    #[test]
    fn keys_come_up_when_the_window_loses_the_focus() {
        let mut test = TestWorld::new(|app: &mut App| {
            app.init_resource::<HeadView>()
                .init_resource::<Snapshots>()
                .add_plugins((InputPlugin, jog::plugin, plugin));
        });
        test.app.world_mut().write_message(KeyboardInput {
            key_code: KeyK,
            logical_key: Key::Character("k".into()),
            state: ButtonState::Pressed,
            text: None,
            repeat: false,
            window: Entity::PLACEHOLDER,
        });
        assert_eq!(test.hold_still(), [drive(LeftE1, 1.0)]);
        assert_eq!(test.hold_still(), [drive(LeftE1, 1.0)]);
        test.app.world_mut().write_message(KeyboardFocusLost);
        assert_eq!(test.hold_still(), []);
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
            (KeyR, SimCommand::Robot(RobotCommand::Show(true))),
            (
                Backslash,
                SimCommand::Robot(RobotCommand::ShowFace(Face::Happy)),
            ),
        ] {
            test.keys().press(key);
            assert_eq!(test.hold_still(), [command]);
            assert_eq!(test.hold_still(), []);
            test.keys().release(key);
        }
        test.app.world_mut().resource_mut::<Robot>().is_shown = true;
        assert_eq!(
            held(&mut test, &[KeyR]),
            [SimCommand::Robot(RobotCommand::Show(false))]
        );
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
}
