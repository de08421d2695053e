//! Gamepads do what keys do.

use bevy::{
    input::{
        InputPlugin,
        gamepad::{
            GamepadAxis, GamepadButton, GamepadConnection, GamepadConnectionEvent,
            RawGamepadAxisChangedEvent, RawGamepadButtonChangedEvent, RawGamepadEvent,
        },
    },
    prelude::*,
    time::TimeUpdateStrategy,
};
use tabletop_core::{Hand, HandCommand, Hands, HistoryCommand, RecordingCommand, SimCommand};
use tabletop_user::{Chosen, Dragging};

use crate::{
    input::{history_keys, key_moves, keys, recording_keys},
    test_world::TestWorld,
};

struct Pad {
    test: TestWorld,
    pad: Entity,
}

impl Pad {
    fn new() -> Self {
        let mut test = TestWorld::new(|app: &mut App| {
            app.add_plugins((
                InputPlugin,
                history_keys::plugin,
                key_moves::plugin,
                keys::plugin,
                recording_keys::plugin,
            ));
        });
        let frame = std::time::Duration::from_millis(10);
        test.app
            .insert_resource(TimeUpdateStrategy::ManualDuration(frame))
            .insert_resource(Dragging {
                goes_on_top: false,
                ..default()
            });
        let pad = test.app.world_mut().spawn_empty().id();
        let connection = GamepadConnection::Connected {
            name: "a pad".into(),
            vendor_id: None,
            product_id: None,
        };
        let connected = GamepadConnectionEvent::new(pad, connection);
        test.app.world_mut().write_message(connected);
        test.hold_still();
        Self { test, pad }
    }

    /// The commands of a frame after this event.
    fn after(&mut self, event: RawGamepadEvent) -> Vec<SimCommand> {
        self.test.app.world_mut().write_message(event);
        self.test.hold_still()
    }

    fn strike(&mut self, button: GamepadButton) -> Vec<SimCommand> {
        let event = |value| {
            RawGamepadEvent::Button(RawGamepadButtonChangedEvent::new(self.pad, button, value))
        };
        let [down, up] = [event(1.0), event(0.0)];
        let commands = self.after(down);
        assert_eq!(self.after(up), []);
        commands
    }

    fn push(&mut self, axis: GamepadAxis, value: f32) -> Vec<SimCommand> {
        let event = RawGamepadAxisChangedEvent::new(self.pad, axis, value);
        self.after(RawGamepadEvent::Axis(event))
    }

    fn take(&mut self) {
        let chosen = self.test.app.world().resource::<Chosen>().0;
        let mut hands = self.test.app.world_mut().resource_mut::<Hands>();
        let hand = hands.selected;
        hands.set_held(hand, chosen);
    }

    /// How far the commands of a second move the held object.
    fn moved_in_a_second(&mut self) -> Vec3 {
        let frames = (0..100).flat_map(|_| self.test.hold_still());
        frames
            .map(|command| match command {
                SimCommand::Hand(HandCommand::MoveBy { offset, .. }) => offset,
                other => panic!("{other:?}"),
            })
            .sum()
    }
}

fn chosen() -> Pad {
    let mut pad = Pad::new();
    pad.test.block("red", Vec3::Z);
    assert_eq!(pad.strike(GamepadButton::RightTrigger), []);
    pad
}

#[test]
fn buttons_choose_take_let_go_undo_and_record() {
    let mut pad = chosen();
    let hand = Hand::Any;
    let grasp = HandCommand::Grasp {
        hand,
        object: "red".into(),
    };
    assert_eq!(pad.strike(GamepadButton::South), [grasp.into()]);
    pad.take();
    for (button, command) in [
        (GamepadButton::South, HandCommand::Release(hand).into()),
        (GamepadButton::West, HistoryCommand::Undo.into()),
        (GamepadButton::North, HistoryCommand::Redo.into()),
        (GamepadButton::Start, RecordingCommand::Start.into()),
        (
            GamepadButton::DPadLeft,
            HandCommand::Select(Hand::Left).into(),
        ),
    ] {
        assert_eq!(pad.strike(button), [command], "{button:?}");
    }
}

#[test]
fn sticks_and_triggers_move_the_held_object_the_faster_the_farther_they_are_pushed() {
    let mut pad = chosen();
    pad.take();
    for (push, least, most) in [(1.0, 2.8, 3.2), (0.5, 1.2, 1.7)] {
        pad.push(GamepadAxis::LeftStickX, push);
        let moved = pad.moved_in_a_second();
        assert!((least..most).contains(&moved.x), "{moved}");
        assert!(moved.yz().length() < 1e-4, "{moved}");
        pad.push(GamepadAxis::LeftStickX, 0.0);
    }
    let trigger = GamepadButton::LeftTrigger2;
    let press = RawGamepadButtonChangedEvent::new(pad.pad, trigger, 1.0);
    pad.after(RawGamepadEvent::Button(press));
    let moved = pad.moved_in_a_second();
    assert!((-3.2..-2.8).contains(&moved.z), "{moved}");
}

#[test]
fn a_stick_turns_the_held_object() {
    let mut pad = chosen();
    pad.take();
    pad.push(GamepadAxis::RightStickX, -1.0);
    let turns = (0..100).flat_map(|_| pad.test.hold_still());
    let degrees: f32 = turns
        .map(|command| match command {
            SimCommand::Hand(HandCommand::Turn { axis, degrees, .. }) => {
                assert_eq!(axis, Vec3::Z);
                degrees
            }
            other => panic!("{other:?}"),
        })
        .sum();
    assert!((55.0..65.0).contains(&degrees), "{degrees}");
}
