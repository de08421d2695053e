//! The keymap: which keys do which actions.

mod action;
mod binding;
mod gamepad;
mod letters;
mod table;

pub use action::{Action, Way};
pub use binding::{BindingError, KeyBinding, Modifiers};
pub use gamepad::{Gamepad, GamepadControl, StickWay};
pub use letters::KeyLetters;
pub use table::{ActionGroup, JointKeyError, Situation};

use std::{cmp::Reverse, collections::BTreeMap};

use bevy::{ecs::system::SystemParam, prelude::*};
use bevy_input::{ButtonInput, keyboard::KeyCode};
use tabletop_core::{Hands, RobotLayout};

use self::table::ActionRow;
use crate::Chosen;

/// The keys of each action. A key is known by its place on the keyboard, not by its letter, unless
/// [Ctrl or the like](KeyLetters) is held down with it. The robot's layout decides which joints have actions.
#[derive(Resource, Clone, Debug, PartialEq, Eq)]
pub struct Keymap {
    groups: Vec<(ActionGroup, String)>,
    rows: Vec<ActionRow>,
    bindings: BTreeMap<Action, Vec<KeyBinding>>,
}

impl Default for Keymap {
    /// The keys for [Baxter](RobotLayout::baxter).
    fn default() -> Self {
        Self::of(RobotLayout::baxter()).0
    }
}

impl Keymap {
    /// The default keys for a robot, and those in its layout that do not exist.
    pub fn of(layout: &RobotLayout) -> (Self, Vec<JointKeyError>) {
        let (rows, faults) = table::rows(layout);
        let bindings = rows
            .iter()
            .map(|row| (row.action, row.default_keys.clone()));
        let keymap = Self {
            groups: table::groups(layout),
            bindings: bindings.collect(),
            rows,
        };
        (keymap, faults)
    }

    /// All actions.
    pub fn actions(&self) -> impl Iterator<Item = Action> {
        self.rows.iter().map(|row| row.action)
    }

    /// The groups of actions with their names on the screen, in the order in which they are listed.
    pub fn groups(&self) -> impl Iterator<Item = (ActionGroup, &str)> {
        let groups = self.groups.iter();
        groups.map(|(group, name)| (*group, name.as_str()))
    }

    /// The actions of a group.
    pub fn actions_of(&self, group: ActionGroup) -> impl Iterator<Item = Action> {
        let rows = self.rows.iter().filter(move |row| row.group == group);
        rows.map(|row| row.action)
    }

    /// The action with this name in files.
    pub fn find(&self, name: &str) -> Option<Action> {
        self.actions().find(|action| action.to_string() == name)
    }

    fn row(&self, action: Action) -> Option<&ActionRow> {
        self.rows.iter().find(|row| row.action == action)
    }

    /// The name of an action on the screen; empty if this robot cannot do it.
    pub fn label(&self, action: Action) -> &str {
        self.row(action).map_or("", |row| &row.label)
    }

    /// Description of an action, a sentence; empty if this robot cannot do it.
    pub fn description(&self, action: Action) -> &'static str {
        self.row(action).map_or("", |row| row.tooltip)
    }

    /// The situation in which an action is available.
    pub fn situation(&self, action: Action) -> Situation {
        self.row(action).map_or(Situation::Any, |row| row.situation)
    }

    /// True if an action continues while its key is held down.
    pub fn is_continuous(&self, action: Action) -> bool {
        self.row(action).is_some_and(|row| row.is_continuous)
    }

    /// The keys of an action unless the user binds others.
    pub fn default_bindings(&self, action: Action) -> &[KeyBinding] {
        self.row(action).map_or(&[], |row| &row.default_keys)
    }

    /// The keys of an action.
    pub fn bindings(&self, action: Action) -> &[KeyBinding] {
        self.bindings.get(&action).map_or(&[], Vec::as_slice)
    }

    /// Gives an action these keys in place of its old ones. If another action of the same situation has one of them, both keep it:
    /// see [`conflicts`](Self::conflicts).
    pub fn bind(&mut self, action: Action, bindings: impl IntoIterator<Item = KeyBinding>) {
        let bindings = bindings.into_iter().collect();
        self.bindings.insert(action, bindings);
    }

    /// Keys that two actions share in one situation, so that the second action is out of reach.
    pub fn conflicts(&self) -> Vec<(KeyBinding, Action, Action)> {
        let mut owners = BTreeMap::new();
        let mut conflicts = Vec::new();
        for ActionRow {
            action, situation, ..
        } in &self.rows
        {
            let action = *action;
            for &binding in self.bindings(action) {
                let owner = *owners.entry((binding, *situation)).or_insert(action);
                if owner != action {
                    conflicts.push((binding, owner, action));
                }
            }
        }
        conflicts
    }

    /// The action of a key pressed with these modifiers. Shift has no effect on a key unless a binding names it. Actions on the chosen
    /// object come first, then those on the held one.
    fn action(
        &self,
        key: KeyCode,
        held: Modifiers,
        is_present: impl Fn(Situation) -> bool,
    ) -> Option<Action> {
        let fitting = self.rows.iter().flat_map(|row| {
            let bindings = self.bindings(row.action).iter();
            bindings.map(move |binding| (*binding, row))
        });
        fitting
            .filter(|(binding, row)| {
                let fits = match row.situation {
                    Situation::Any | Situation::Choosing => binding.fits(held),
                    // Here Ctrl is a key of its own.
                    Situation::Holding => binding.fits(held) || binding.fits(held.without_ctrl()),
                };
                binding.key == key && fits && is_present(row.situation)
            })
            .min_by_key(|(binding, row)| {
                let uses_shift = binding.modifiers.shift;
                (Reverse(uses_shift), Reverse(row.situation))
            })
            .map(|(_, row)| row.action)
    }

    /// The keys of an action as the user reads them: `Ctrl+Shift+Z or Ctrl+Y`. Empty if it has none.
    pub fn hint(&self, action: Action) -> String {
        let labels = self.bindings(action).iter().map(|binding| binding.label());
        labels.collect::<Vec<_>>().join(" or ")
    }

    /// Description of an action with its keys: `Stops the simulation, or lets it run on (Space)`.
    pub fn tooltip(&self, action: Action) -> String {
        match (self.description(action), self.hint(action)) {
            (tooltip, hint) if hint.is_empty() => tooltip.to_owned(),
            (tooltip, hint) => format!("{tooltip} ({hint})"),
        }
    }
}

/// Systems that read [`Keys`], in [`RunFixedMainLoop`] before the ticks of a frame.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct KeySystems;

/// The owner of the keyboard. The panels set it.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum KeyboardFocus {
    /// The world: keys do their actions.
    #[default]
    World,
    /// An overlay, such as a dialog, a menu or an open list: keys are its own, and Esc closes it.
    Overlay,
    /// A field for text or a number: keys write into it.
    Text,
}

impl KeyboardFocus {
    /// True if a key still does its action.
    pub fn leaves(self, key: KeyCode) -> bool {
        match self {
            Self::World => true,
            Self::Overlay | Self::Text => binding::is_function_key(key),
        }
    }
}

/// The actions that the user asks for with the keyboard and gamepads in this frame.
#[derive(SystemParam)]
pub struct Keys<'w> {
    keymap: Res<'w, Keymap>,
    keys: Res<'w, ButtonInput<KeyCode>>,
    focus: Res<'w, KeyboardFocus>,
    letters: Res<'w, KeyLetters>,
    hands: Res<'w, Hands>,
    chosen: Res<'w, Chosen>,
    gamepad: Res<'w, Gamepad>,
}

impl Keys<'_> {
    /// True while a key or button of this action is held down.
    pub fn is_held(&self, action: Action) -> bool {
        let mut held = self.keys.get_pressed();
        held.any(|key| self.meaning(*key) == Some(action))
            || (self.gamepad.is_held(action) && self.reaches(action))
    }

    /// True if a key or button of this action went down in this frame, even if it is up again.
    pub fn was_struck(&self, action: Action) -> bool {
        let mut struck = self.keys.get_just_pressed();
        struck.any(|key| self.meaning(*key) == Some(action))
            || (self.gamepad.was_struck(action) && self.reaches(action))
    }

    /// How far sticks and triggers of gamepads are pushed: 1 all the way to the first action, -1 to the second.
    pub fn push(&self, plus: Action, minus: Action) -> f32 {
        let push = |action| match self.reaches(action) {
            true => self.gamepad.push_of(action),
            false => 0.0,
        };
        push(plus) - push(minus)
    }

    /// True if gamepads do an action now.
    fn reaches(&self, action: Action) -> bool {
        *self.focus == KeyboardFocus::World && self.is_present(self.keymap.situation(action))
    }

    fn is_present(&self, situation: Situation) -> bool {
        match situation {
            Situation::Any => true,
            Situation::Holding => self.hands.held_by(self.hands.selected).is_some(),
            Situation::Choosing => self.chosen.0.is_some(),
        }
    }

    /// The action of a key that is or was down in this frame.
    pub fn meaning(&self, key: KeyCode) -> Option<Action> {
        let modifiers = self.modifiers_of(key);
        let letter = self.letters.with(modifiers, key);
        let action = self
            .keymap
            .action(letter, modifiers, |situation| self.is_present(situation));
        action.filter(|_| self.focus.leaves(key))
    }

    /// 1 while the first action is held, -1 while the second is, 0 while none or both are.
    pub fn axis(&self, plus: Action, minus: Action) -> f32 {
        f32::from(i8::from(self.is_held(plus)) - i8::from(self.is_held(minus)))
    }

    /// The modifiers of a key. In a slow frame they may have come up since the key went down or up.
    fn modifiers_of(&self, key: KeyCode) -> Modifiers {
        let has_changed = self.keys.just_pressed(key) || !self.keys.pressed(key);
        Modifiers::that_are(|modifier| {
            let was_down = self.keys.just_pressed(modifier) || self.keys.just_released(modifier);
            self.keys.pressed(modifier) || (has_changed && was_down)
        })
    }
}

/// Run condition: a key of this action has gone down in this frame.
pub fn was_struck(action: Action) -> impl FnMut(Keys) -> bool + Clone {
    move |keys: Keys| keys.was_struck(action)
}

#[cfg(test)]
mod tests {
    use super::*;
    use KeyCode::*;
    use bevy::ecs::system::RunSystemOnce as _;

    use tabletop_core::{Hand, RobotJoint};

    fn world() -> World {
        let mut world = World::new();
        world.init_resource::<Keymap>();
        world.init_resource::<KeyboardFocus>();
        world.init_resource::<KeyLetters>();
        world.init_resource::<ButtonInput<KeyCode>>();
        world.init_resource::<Hands>();
        world.init_resource::<Chosen>();
        world.init_resource::<Gamepad>();
        world
    }

    fn press(world: &mut World, keys: &[KeyCode]) {
        let mut input = world.resource_mut::<ButtonInput<KeyCode>>();
        input.reset_all();
        keys.iter().for_each(|&key| input.press(key));
    }

    fn hold_something(world: &mut World) {
        let object = world.spawn_empty().id();
        let mut hands = world.resource_mut::<Hands>();
        hands.selected = Hand::Left;
        hands.set_held(Hand::Left, Some(object));
    }

    fn choose_something(world: &mut World) {
        let object = world.spawn_empty().id();
        world.insert_resource(Chosen(Some(object)));
    }

    /// Actions asked for with these keys held down.
    fn held(world: &mut World, keys: &[KeyCode]) -> Vec<Action> {
        press(world, keys);
        let held = |keys: Keys| {
            let all = Keymap::default();
            let all = all.actions();
            all.filter(|action| keys.is_held(*action))
                .collect::<Vec<_>>()
        };
        world.run_system_once(held).unwrap()
    }

    #[test]
    fn no_key_means_two_things_in_one_situation() {
        assert_eq!(Keymap::default().conflicts(), []);
    }

    #[test]
    fn every_default_key_triggers_its_action() {
        let mut world = world();
        let keymap = Keymap::default();
        for action in keymap.actions() {
            for binding in keymap.default_bindings(action) {
                match keymap.situation(action) {
                    Situation::Any => {}
                    Situation::Holding => hold_something(&mut world),
                    Situation::Choosing => choose_something(&mut world),
                }
                let Modifiers {
                    ctrl, alt, shift, ..
                } = binding.modifiers;
                let modifiers = [(ctrl, ControlRight), (alt, AltLeft), (shift, ShiftRight)];
                let modifiers = modifiers.into_iter().filter(|(is_used, _)| *is_used);
                let mut keys: Vec<_> = modifiers.map(|(_, key)| key).collect();
                keys.push(binding.key);
                assert_eq!(held(&mut world, &keys), [action], "{binding}");
                world.insert_resource(Hands::default());
                world.insert_resource(Chosen::default());
            }
        }
    }

    #[test]
    fn shift_changes_only_keys_that_have_a_meaning_with_it() {
        use Way::{Minus, Plus};
        let mut world = world();
        let w2 = |way| Action::Move(RobotJoint::RightW2.name(), way);
        assert_eq!(held(&mut world, &[KeyT]), [w2(Plus)]);
        assert_eq!(held(&mut world, &[ShiftLeft, KeyT]), [w2(Minus)]);
        let forward = Action::CameraForward;
        assert_eq!(held(&mut world, &[ShiftLeft, KeyW]), [forward]);
        assert_eq!(held(&mut world, &[ControlRight, KeyW]), []);
        assert_eq!(held(&mut world, &[AltLeft, KeyW]), []);
    }

    #[test]
    fn actions_on_the_held_object_come_first() {
        let mut world = world();
        let question_mark = [ShiftLeft, Slash];
        assert_eq!(held(&mut world, &question_mark), [Action::ShowHelp]);
        assert_eq!(held(&mut world, &[Slash]), []);
        hold_something(&mut world);
        let turned = [Action::PlaneClockwise, Action::PlaneUpright];
        assert_eq!(held(&mut world, &question_mark), turned);
        assert_eq!(held(&mut world, &[Slash]), [Action::PlaneCounterClockwise]);
        let mut both = held(&mut world, &[ControlLeft, Slash]);
        both.sort();
        assert_eq!(
            both,
            [Action::PlaneCounterClockwise, Action::PlanePerpendicular]
        );
    }

    #[test]
    fn arrows_move_the_chosen_object_and_else_turn_the_camera() {
        let mut world = world();
        assert_eq!(held(&mut world, &[ArrowLeft]), [Action::LookLeft]);
        assert_eq!(held(&mut world, &[Enter]), []);
        choose_something(&mut world);
        assert_eq!(held(&mut world, &[ArrowLeft]), [Action::ObjectLeft]);
        assert_eq!(
            held(&mut world, &[ShiftLeft, ArrowLeft]),
            [Action::TurnLeft]
        );
        assert_eq!(held(&mut world, &[Enter]), [Action::TakeOrRelease]);
        assert_eq!(held(&mut world, &[KeyW]), [Action::CameraForward]);
    }

    #[test]
    fn a_press_is_struck_once_and_held_until_it_is_released() {
        let mut world = world();
        let state = |world: &mut World| {
            let state = |keys: Keys| (keys.was_struck(Action::Pause), keys.is_held(Action::Pause));
            world.run_system_once(state).unwrap()
        };
        press(&mut world, &[Space]);
        assert_eq!(state(&mut world), (true, true));
        world.resource_mut::<ButtonInput<KeyCode>>().clear();
        assert_eq!(state(&mut world), (false, true));
        world.resource_mut::<ButtonInput<KeyCode>>().release(Space);
        assert_eq!(state(&mut world), (false, false));
    }

    #[test]
    fn a_stroke_within_a_frame_keeps_its_modifiers() {
        let mut world = world();
        let mut input = world.resource_mut::<ButtonInput<KeyCode>>();
        let keys = [ControlLeft, KeyZ];
        keys.iter().for_each(|&key| input.press(key));
        keys.iter().for_each(|&key| input.release(key));
        let struck = |keys: Keys| {
            let all = Keymap::default();
            let all = all.actions();
            all.filter(|action| keys.was_struck(*action))
                .collect::<Vec<_>>()
        };
        let struck = world.run_system_once(struck).unwrap();
        assert_eq!(struck, [Action::Undo]);
    }

    #[test]
    fn a_chord_keeps_ctrl_that_comes_up_in_the_frame_in_which_its_key_goes_down() {
        for is_ctrl_new in [true, false] {
            let mut world = world();
            let mut input = world.resource_mut::<ButtonInput<KeyCode>>();
            input.press(ControlLeft);
            if !is_ctrl_new {
                input.clear();
            }
            input.press(KeyZ);
            input.release(ControlLeft);
            let struck = |keys: Keys| {
                [Action::Undo, Action::CameraDown].map(|action| keys.was_struck(action))
            };
            assert_eq!(world.run_system_once(struck).unwrap(), [true, false]);
        }
    }

    #[test]
    fn keys_reach_only_what_is_in_front() {
        let mut world = world();
        let keys = [Space, KeyR, Escape, F1];
        let asked = |world: &mut World, focus: KeyboardFocus| {
            world.insert_resource(focus);
            held(world, &keys)
        };
        let [pause, quit, robot, help] = [
            Action::Pause,
            Action::Quit,
            Action::ShowRobot,
            Action::ShowHelp,
        ];
        let all = [pause, quit, robot, help];
        assert_eq!(asked(&mut world, KeyboardFocus::World), all);
        assert_eq!(asked(&mut world, KeyboardFocus::Overlay), [help]);
        assert_eq!(asked(&mut world, KeyboardFocus::Text), [help]);
    }

    #[test]
    fn a_gamepad_does_actions_where_keys_would() {
        let mut world = world();
        let mut pad = Gamepad::default();
        pad.push(GamepadControl::Select, 1.0);
        pad.push(GamepadControl::South, 1.0);
        pad.push_stick(
            GamepadControl::LeftStick,
            [StickWay::Left, StickWay::Right],
            -0.5,
        );
        world.insert_resource(pad);
        let asked = |world: &mut World| {
            let asked = |keys: Keys| {
                let struck = [Action::Pause, Action::TakeOrRelease];
                let push = keys.push(Action::ObjectRight, Action::ObjectLeft);
                (struck.map(|action| keys.was_struck(action)), push)
            };
            world.run_system_once(asked).unwrap()
        };
        assert_eq!(asked(&mut world), ([true, false], 0.0));
        choose_something(&mut world);
        assert_eq!(asked(&mut world), ([true, true], -0.5));
        world.insert_resource(KeyboardFocus::Overlay);
        assert_eq!(asked(&mut world), ([false, false], 0.0));
    }

    #[test]
    fn keys_can_be_bound_anew() {
        let mut world = world();
        let mut keymap = world.resource_mut::<Keymap>();
        keymap.bind(Action::Pause, ["Ctrl+KeyP".parse().unwrap()]);
        keymap.bind(Action::Quit, []);
        assert_eq!(keymap.hint(Action::Pause), "Ctrl+P");
        assert_eq!(keymap.hint(Action::Quit), "");
        assert_eq!(held(&mut world, &[Space]), []);
        assert_eq!(held(&mut world, &[Escape]), []);
        assert_eq!(held(&mut world, &[ControlLeft, KeyP]), [Action::Pause]);
    }

    #[test]
    fn a_key_that_is_bound_twice_is_a_conflict() {
        let mut keymap = Keymap::default();
        let space = "Space".parse().unwrap();
        keymap.bind(Action::ShowRobot, [space]);
        let conflict = (space, Action::Pause, Action::ShowRobot);
        assert_eq!(keymap.conflicts(), [conflict]);
    }

    #[test]
    fn hints_name_every_key() {
        let keymap = Keymap::default();
        assert_eq!(keymap.hint(Action::Redo), "Ctrl+Shift+Z or Ctrl+Y");
        let tooltip = "Stops the simulation, or lets it run on (Space)";
        assert_eq!(keymap.tooltip(Action::Pause), tooltip);
    }
}
