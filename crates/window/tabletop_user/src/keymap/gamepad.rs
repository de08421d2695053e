//! The gamepad: its buttons, sticks and triggers do actions, as keys do.

use std::collections::{BTreeMap, BTreeSet};

use bevy::prelude::*;

use super::Action;

/// A control of a gamepad. Buttons are named by their places.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[expect(missing_docs, reason = "the names say it")]
pub enum GamepadControl {
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
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[expect(missing_docs, reason = "the names say it")]
pub enum StickWay {
    Left,
    Right,
    Up,
    Down,
}

impl GamepadControl {
    /// The controls that do actions, and their actions.
    pub const ACTIONS: [(Self, Action); 21] = [
        (Self::RightBumper, Action::NextObject),
        (Self::LeftBumper, Action::PreviousObject),
        (Self::South, Action::TakeOrRelease),
        (Self::LeftStick(StickWay::Left), Action::ObjectLeft),
        (Self::LeftStick(StickWay::Right), Action::ObjectRight),
        (Self::LeftStick(StickWay::Up), Action::ObjectAway),
        (Self::LeftStick(StickWay::Down), Action::ObjectNearer),
        (Self::RightTrigger, Action::ObjectUp),
        (Self::LeftTrigger, Action::ObjectDown),
        (Self::RightStick(StickWay::Left), Action::TurnLeft),
        (Self::RightStick(StickWay::Right), Action::TurnRight),
        (Self::RightStick(StickWay::Up), Action::TipAway),
        (Self::RightStick(StickWay::Down), Action::TipNearer),
        (Self::PadLeft, Action::HandLeft),
        (Self::PadRight, Action::HandRight),
        (Self::PadDown, Action::HandBoth),
        (Self::PadUp, Action::HandAny),
        (Self::West, Action::Undo),
        (Self::North, Action::Redo),
        (Self::Start, Action::Record),
        (Self::Select, Action::Pause),
    ];

    fn of(action: Action) -> impl Iterator<Item = Self> {
        let controls = Self::ACTIONS.into_iter();
        controls.filter_map(move |(control, its)| (its == action).then_some(control))
    }

    /// True for a stick or a trigger, which is pushed more or less far; a button is up or down.
    const fn is_graded(self) -> bool {
        match self {
            Self::LeftTrigger | Self::RightTrigger | Self::LeftStick(_) | Self::RightStick(_) => {
                true
            }
            Self::South
            | Self::West
            | Self::North
            | Self::LeftBumper
            | Self::RightBumper
            | Self::Select
            | Self::Start
            | Self::PadUp
            | Self::PadDown
            | Self::PadLeft
            | Self::PadRight => false,
        }
    }
}

/// The controls of all gamepads together: how far each is pushed, and which went down in this frame.
#[derive(Resource, Clone, Debug, Default)]
pub struct Gamepad {
    pushes: BTreeMap<GamepadControl, f32>,
    struck: BTreeSet<GamepadControl>,
}

impl Gamepad {
    /// Begins a frame, in which nothing has gone down yet.
    pub fn begin_frame(&mut self) {
        self.struck.clear();
    }

    /// Pushes a control: 0 if it is let go, 1 as far as it goes.
    pub fn push(&mut self, control: GamepadControl, push: f32) {
        match push > 0.0 {
            true if self.pushes.insert(control, push.min(1.0)).is_none() => {
                self.struck.insert(control);
            }
            true => {}
            false => {
                self.pushes.remove(&control);
            }
        }
    }

    /// Pushes a stick along one of its axes, from -1 to 1.
    pub fn push_stick(
        &mut self,
        stick: fn(StickWay) -> GamepadControl,
        [minus, plus]: [StickWay; 2],
        push: f32,
    ) {
        self.push(stick(plus), push);
        self.push(stick(minus), -push);
    }

    /// Lets go of every control, as when a gamepad is unplugged.
    pub fn let_go(&mut self) {
        self.pushes.clear();
    }

    /// True while a control is pushed, or if one was in this frame.
    pub fn is_used(&self) -> bool {
        !self.pushes.is_empty() || !self.struck.is_empty()
    }

    /// True while a button of an action is down.
    pub(super) fn is_held(&self, action: Action) -> bool {
        buttons_of(action).any(|button| self.pushes.contains_key(&button))
    }

    /// True if a button of an action went down in this frame.
    pub(super) fn was_struck(&self, action: Action) -> bool {
        buttons_of(action).any(|button| self.struck.contains(&button))
    }

    /// How far a stick or a trigger of an action is pushed, from 0 to 1.
    pub(super) fn push_of(&self, action: Action) -> f32 {
        let graded = GamepadControl::of(action).filter(|control| control.is_graded());
        let pushes = graded.filter_map(|control| self.pushes.get(&control).copied());
        pushes.fold(0.0, f32::max)
    }
}

fn buttons_of(action: Action) -> impl Iterator<Item = GamepadControl> {
    GamepadControl::of(action).filter(|control| !control.is_graded())
}

#[cfg(test)]
mod tests {
    use super::{
        GamepadControl::{LeftStick, RightTrigger, Start},
        StickWay::{Down, Left, Right, Up},
        *,
    };

    #[test]
    fn no_control_does_two_actions() {
        let controls = GamepadControl::ACTIONS.map(|(control, _)| control);
        let unique: BTreeSet<_> = controls.into_iter().collect();
        assert_eq!(unique.len(), controls.len());
    }

    #[test]
    fn a_button_is_struck_once_and_held_until_it_comes_up() {
        let mut pad = Gamepad::default();
        let state = |pad: &Gamepad| (pad.was_struck(Action::Record), pad.is_held(Action::Record));
        pad.push(Start, 1.0);
        assert_eq!(state(&pad), (true, true));
        pad.begin_frame();
        pad.push(Start, 1.0);
        assert_eq!(state(&pad), (false, true));
        pad.push(Start, 0.0);
        assert_eq!(state(&pad), (false, false));
        pad.push(Start, 1.0);
        pad.push(Start, 0.0);
        assert_eq!(state(&pad), (true, false));
    }

    #[test]
    fn sticks_and_triggers_push_more_or_less_far() {
        let mut pad = Gamepad::default();
        pad.push_stick(LeftStick, [Left, Right], -0.5);
        pad.push_stick(LeftStick, [Down, Up], 1.0);
        pad.push(RightTrigger, 0.25);
        let pushes = |pad: &Gamepad| {
            let actions = [
                Action::ObjectLeft,
                Action::ObjectRight,
                Action::ObjectAway,
                Action::ObjectNearer,
                Action::ObjectUp,
            ];
            actions.map(|action| pad.push_of(action))
        };
        assert_eq!(pushes(&pad), [0.5, 0.0, 1.0, 0.0, 0.25]);
        assert!(!pad.is_held(Action::ObjectUp) && !pad.was_struck(Action::ObjectUp));
        pad.push_stick(LeftStick, [Left, Right], 0.5);
        assert_eq!(pushes(&pad), [0.0, 0.5, 1.0, 0.0, 0.25]);
        assert!(pad.is_used());
        pad.let_go();
        pad.begin_frame();
        assert_eq!(pushes(&pad), [0.0; 5]);
        assert!(!pad.is_used());
    }
}
