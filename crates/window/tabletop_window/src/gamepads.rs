//! The gamepads that are plugged in.

use std::{
    sync::mpsc::{self, Receiver, Sender},
    thread,
};

use bevy::{
    platform::cell::SyncCell,
    prelude::*,
    winit::{EventLoopProxy, EventLoopProxyWrapper, WinitUserEvent},
};
use gilrs::{Axis, Button, EventType, Gilrs};
use tabletop_user::{Gamepad, GamepadControl, StickWay};

pub(super) fn plugin(app: &mut App) {
    app.add_systems(Startup, listen)
        .add_systems(PreUpdate, read.run_if(resource_exists::<GamepadEvents>));
}

/// What the gamepads have told since the last frame.
#[derive(Resource)]
struct GamepadEvents(SyncCell<Receiver<EventType>>);

/// Listens in a thread of its own, which wakes a resting window.
fn listen(waker: Res<EventLoopProxyWrapper>, mut commands: Commands) {
    let gilrs = match Gilrs::new() {
        Ok(gilrs) => gilrs,
        Err(error) => {
            warn!("Gamepads cannot be read: {error}");
            return;
        }
    };
    let (sender, receiver) = mpsc::channel();
    let waker = EventLoopProxy::clone(&waker);
    thread::spawn(move || forward(gilrs, &sender, &waker));
    commands.insert_resource(GamepadEvents(SyncCell::new(receiver)));
}

fn forward(mut gilrs: Gilrs, sender: &Sender<EventType>, waker: &EventLoopProxy<WinitUserEvent>) {
    while let Some(event) = gilrs.next_event_blocking(None) {
        let is_over =
            sender.send(event.event).is_err() || waker.send_event(WinitUserEvent::WakeUp).is_err();
        if is_over {
            return;
        }
    }
}

fn read(mut events: ResMut<GamepadEvents>, mut gamepad: ResMut<Gamepad>) {
    gamepad.begin_frame();
    for event in events.0.get().try_iter() {
        push(&mut gamepad, event);
    }
}

/// Pushes what an event says. Of a button that is just up or down, it says 0 or 1.
fn push(gamepad: &mut Gamepad, event: EventType) {
    use StickWay::{Down, Left, Right, Up};
    match event {
        EventType::ButtonChanged(button, push, _) => {
            if let Some(control) = control(button) {
                gamepad.push(control, push);
            }
        }
        EventType::AxisChanged(axis, push, _) => match axis {
            Axis::LeftStickX => gamepad.push_stick(GamepadControl::LeftStick, [Left, Right], push),
            Axis::LeftStickY => gamepad.push_stick(GamepadControl::LeftStick, [Down, Up], push),
            Axis::RightStickX => {
                gamepad.push_stick(GamepadControl::RightStick, [Left, Right], push);
            }
            Axis::RightStickY => gamepad.push_stick(GamepadControl::RightStick, [Down, Up], push),
            Axis::LeftZ | Axis::RightZ | Axis::DPadX | Axis::DPadY | Axis::Unknown => {}
        },
        EventType::Disconnected => gamepad.let_go(),
        EventType::Connected
        | EventType::ButtonPressed(..)
        | EventType::ButtonRepeated(..)
        | EventType::ButtonReleased(..)
        | EventType::Dropped
        | EventType::ForceFeedbackEffectCompleted
        | _ => {}
    }
}

const fn control(button: Button) -> Option<GamepadControl> {
    Some(match button {
        Button::South => GamepadControl::South,
        Button::West => GamepadControl::West,
        Button::North => GamepadControl::North,
        Button::LeftTrigger => GamepadControl::LeftBumper,
        Button::RightTrigger => GamepadControl::RightBumper,
        Button::LeftTrigger2 => GamepadControl::LeftTrigger,
        Button::RightTrigger2 => GamepadControl::RightTrigger,
        Button::Select => GamepadControl::Select,
        Button::Start => GamepadControl::Start,
        Button::DPadUp => GamepadControl::PadUp,
        Button::DPadDown => GamepadControl::PadDown,
        Button::DPadLeft => GamepadControl::PadLeft,
        Button::DPadRight => GamepadControl::PadRight,
        Button::East
        | Button::C
        | Button::Z
        | Button::Mode
        | Button::LeftThumb
        | Button::RightThumb
        | Button::Unknown => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_control_that_does_an_action_is_on_a_gamepad() {
        let buttons = [
            Button::South,
            Button::West,
            Button::North,
            Button::LeftTrigger,
            Button::RightTrigger,
            Button::LeftTrigger2,
            Button::RightTrigger2,
            Button::Select,
            Button::Start,
            Button::DPadUp,
            Button::DPadDown,
            Button::DPadLeft,
            Button::DPadRight,
        ];
        let controls = buttons.map(control);
        for (wanted, action) in GamepadControl::ACTIONS {
            let is_stick = matches!(
                wanted,
                GamepadControl::LeftStick(_) | GamepadControl::RightStick(_)
            );
            assert!(is_stick || controls.contains(&Some(wanted)), "{action}");
        }
    }
}
