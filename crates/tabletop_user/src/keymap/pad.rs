//! The gamepad: its buttons, sticks and triggers do actions, as keys do.

use bevy::{ecs::system::SystemParam, prelude::*};

use super::Action;

/// A control of a gamepad that does an action. Buttons are named by their places.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum PadControl {
    South,
    West,
    North,
    LeftBumper,
    RightBumper,
    Select,
    Start,
    PadUp,
    PadDown,
    PadLeft,
    PadRight,
    LeftTrigger,
    RightTrigger,
    LeftStick(StickWay),
    RightStick(StickWay),
}

/// A way in which a stick is pushed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum StickWay {
    Left,
    Right,
    Up,
    Down,
}

/// The controls and their actions.
pub const PAD_CONTROLS: [(PadControl, Action); 21] = [
    (PadControl::RightBumper, Action::NextObject),
    (PadControl::LeftBumper, Action::PreviousObject),
    (PadControl::South, Action::TakeOrRelease),
    (PadControl::LeftStick(StickWay::Left), Action::ObjectLeft),
    (PadControl::LeftStick(StickWay::Right), Action::ObjectRight),
    (PadControl::LeftStick(StickWay::Up), Action::ObjectAway),
    (PadControl::LeftStick(StickWay::Down), Action::ObjectNearer),
    (PadControl::RightTrigger, Action::ObjectUp),
    (PadControl::LeftTrigger, Action::ObjectDown),
    (PadControl::RightStick(StickWay::Left), Action::TurnLeft),
    (PadControl::RightStick(StickWay::Right), Action::TurnRight),
    (PadControl::RightStick(StickWay::Up), Action::TipAway),
    (PadControl::RightStick(StickWay::Down), Action::TipNearer),
    (PadControl::PadLeft, Action::HandLeft),
    (PadControl::PadRight, Action::HandRight),
    (PadControl::PadDown, Action::HandBoth),
    (PadControl::PadUp, Action::HandAny),
    (PadControl::West, Action::Undo),
    (PadControl::North, Action::Redo),
    (PadControl::Start, Action::Record),
    (PadControl::Select, Action::Pause),
];

/// The gamepads that are connected; without the feature `gamepad`, none.
#[derive(SystemParam)]
pub struct Gamepads<'w, 's> {
    #[cfg(feature = "gamepad")]
    pads: Query<'w, 's, &'static bevy_input::gamepad::Gamepad>,
    #[cfg(not(feature = "gamepad"))]
    none: Query<'w, 's, (), With<NoPad>>,
}

#[cfg(not(feature = "gamepad"))]
#[derive(Component)]
struct NoPad;

impl Gamepads<'_, '_> {
    /// True while a button of this action is held down.
    pub fn is_held(&self, action: Action) -> bool {
        controls_of(action).any(|control| self.holds(control))
    }

    /// True if a button of this action went down in this frame.
    pub fn was_struck(&self, action: Action) -> bool {
        controls_of(action).any(|control| self.strikes(control))
    }

    /// How far, from 0 to 1, a stick or a trigger of this action is pushed.
    pub fn push(&self, action: Action) -> f32 {
        let pushes = controls_of(action).map(|control| self.push_of(control));
        pushes.fold(0.0, f32::max)
    }
}

fn controls_of(action: Action) -> impl Iterator<Item = PadControl> {
    let controls = PAD_CONTROLS.into_iter();
    controls.filter_map(move |(control, its)| (its == action).then_some(control))
}

#[cfg(not(feature = "gamepad"))]
impl Gamepads<'_, '_> {
    fn holds(&self, _: PadControl) -> bool {
        !self.none.is_empty()
    }

    fn strikes(&self, _: PadControl) -> bool {
        !self.none.is_empty()
    }

    fn push_of(&self, _: PadControl) -> f32 {
        f32::from(u8::from(!self.none.is_empty()))
    }
}

#[cfg(feature = "gamepad")]
mod connected {
    use bevy_input::gamepad::{GamepadAxis, GamepadButton};

    use super::{Gamepads, PadControl, StickWay};

    /// Where a control is read.
    enum Source {
        Button(GamepadButton),
        Trigger(GamepadButton),
        /// An axis, and the sign of its way.
        Stick(GamepadAxis, f32),
    }

    impl PadControl {
        const fn source(self) -> Source {
            let button = match self {
                Self::South => GamepadButton::South,
                Self::West => GamepadButton::West,
                Self::North => GamepadButton::North,
                Self::LeftBumper => GamepadButton::LeftTrigger,
                Self::RightBumper => GamepadButton::RightTrigger,
                Self::Select => GamepadButton::Select,
                Self::Start => GamepadButton::Start,
                Self::PadUp => GamepadButton::DPadUp,
                Self::PadDown => GamepadButton::DPadDown,
                Self::PadLeft => GamepadButton::DPadLeft,
                Self::PadRight => GamepadButton::DPadRight,
                Self::LeftTrigger => return Source::Trigger(GamepadButton::LeftTrigger2),
                Self::RightTrigger => return Source::Trigger(GamepadButton::RightTrigger2),
                Self::LeftStick(way) => {
                    return way.source(GamepadAxis::LeftStickX, GamepadAxis::LeftStickY);
                }
                Self::RightStick(way) => {
                    return way.source(GamepadAxis::RightStickX, GamepadAxis::RightStickY);
                }
            };
            Source::Button(button)
        }
    }

    impl StickWay {
        const fn source(self, x: GamepadAxis, y: GamepadAxis) -> Source {
            match self {
                Self::Left => Source::Stick(x, -1.0),
                Self::Right => Source::Stick(x, 1.0),
                Self::Up => Source::Stick(y, 1.0),
                Self::Down => Source::Stick(y, -1.0),
            }
        }
    }

    impl Gamepads<'_, '_> {
        pub(super) fn holds(&self, control: PadControl) -> bool {
            match control.source() {
                Source::Button(button) => self.pads.iter().any(|pad| pad.pressed(button)),
                Source::Trigger(_) | Source::Stick(..) => false,
            }
        }

        pub(super) fn strikes(&self, control: PadControl) -> bool {
            match control.source() {
                Source::Button(button) => self.pads.iter().any(|pad| pad.just_pressed(button)),
                Source::Trigger(_) | Source::Stick(..) => false,
            }
        }

        pub(super) fn push_of(&self, control: PadControl) -> f32 {
            let pads = self.pads.iter();
            let pushes = pads.filter_map(|pad| match control.source() {
                Source::Button(_) => None,
                Source::Trigger(trigger) => pad.get(trigger),
                Source::Stick(axis, sign) => Some(sign * pad.get(axis)?),
            });
            pushes.fold(0.0, f32::max)
        }
    }
}
