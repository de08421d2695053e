//! Keys as egui gets them, instead of by `bevy_egui`, which gives all keys of a frame the modifiers of its end, so that a quick Ctrl+A would write
//! an a, and which has no clipboard here.

use bevy::{
    input::keyboard::{Key, KeyboardFocusLost, KeyboardInput},
    prelude::*,
};
use bevy_egui::{
    EguiInputSet, EguiOutput, EguiPostUpdateSet, EguiPreUpdateSet,
    egui::{self, Event, OutputCommand},
    helpers::{bevy_to_egui_key, bevy_to_egui_physical_key},
    input::{EguiContextMessageReader, EguiInputEvent, ModifierKeysState},
};
use tabletop_user::KeyboardFocus;

use crate::clipboard::Clipboard;

/// Gives egui the keys. Needs its plugin.
#[derive(Clone, Copy, Debug, Default)]
pub struct TypingPlugin;

impl Plugin for TypingPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Clipboard>()
            .add_systems(
                PreUpdate,
                type_keys
                    .in_set(EguiInputSet::ReadBevyMessages)
                    .in_set(EguiPreUpdateSet::ProcessInput),
            )
            .add_systems(PostUpdate, copy.after(EguiPostUpdateSet::ProcessOutput));
    }
}

fn type_keys(
    mut modifiers: Local<ModifierKeysState>,
    mut keys: EguiContextMessageReader<KeyboardInput>,
    mut focus_lost: MessageReader<KeyboardFocusLost>,
    focus: Res<KeyboardFocus>,
    clipboard: Res<Clipboard>,
    mut events: MessageWriter<EguiInputEvent>,
) {
    if focus_lost.read().count() > 0 {
        // Nobody says that they come up.
        *modifiers = ModifierKeysState::default();
    }
    let is_typing = *focus == KeyboardFocus::Text;
    for (key, context) in keys.read(|key| key.window) {
        hold(&mut modifiers, key);
        let edit = is_typing.then(|| edit(key, &modifiers, || clipboard.paste()));
        let of_key = written(key, &modifiers).into_iter();
        let of_key = of_key.chain(struck(key, &modifiers)).chain(edit.flatten());
        events.write_batch(of_key.map(|event| EguiInputEvent { context, event }));
    }
}

/// Puts what is copied in a text field on the clipboard.
fn copy(outputs: Query<&EguiOutput>, clipboard: Res<Clipboard>) {
    for output in &outputs {
        for command in &output.platform_output.commands {
            match command {
                OutputCommand::CopyText(text) => clipboard.copy(text.clone()),
                OutputCommand::CopyImage(_) | OutputCommand::OpenUrl(_) => {}
            }
        }
    }
}

/// Heeds a modifier that goes down or up.
fn hold(modifiers: &mut ModifierKeysState, key: &KeyboardInput) {
    let held = [
        (Key::Shift, &mut modifiers.shift),
        (Key::Control, &mut modifiers.ctrl),
        (Key::Alt, &mut modifiers.alt),
        (Key::Super, &mut modifiers.win),
    ];
    let this = match &key.logical_key {
        // Its old name.
        key if *key == Key::Meta => &Key::Super,
        key => key,
    };
    if let Some((_, modifier)) = held.into_iter().find(|(key, _)| key == this) {
        *modifier = key.state.is_pressed();
    }
}

/// The text that a key writes.
fn written(key: &KeyboardInput, modifiers: &ModifierKeysState) -> Option<Event> {
    if !key.state.is_pressed() || !modifiers.text_input_is_allowed() {
        return None;
    }
    if key.logical_key == Key::Space {
        return Some(Event::Text(" ".into()));
    }
    let Key::Character(text) = &key.logical_key else {
        return None;
    };
    (!text.contains(char::is_control)).then(|| Event::Text(text.to_string()))
}

/// The key itself: by its letter, or by its place on a keyboard without Latin letters.
fn struck(key: &KeyboardInput, modifiers: &ModifierKeysState) -> Option<Event> {
    Some(Event::Key {
        key: letter(key)?,
        physical_key: bevy_to_egui_physical_key(&key.key_code),
        pressed: key.state.is_pressed(),
        repeat: false,
        modifiers: modifiers.to_egui_modifiers(),
    })
}

fn letter(key: &KeyboardInput) -> Option<egui::Key> {
    bevy_to_egui_key(&key.logical_key).or_else(|| bevy_to_egui_physical_key(&key.key_code))
}

/// What a key does with the clipboard.
fn edit(
    key: &KeyboardInput,
    modifiers: &ModifierKeysState,
    paste: impl FnOnce() -> Option<String>,
) -> Option<Event> {
    let is_chord = modifiers.to_egui_modifiers().command && !modifiers.text_input_is_allowed();
    if !key.state.is_pressed() || !is_chord {
        return None;
    }
    let letter = letter(key)?;
    if letter == egui::Key::V {
        return paste().map(Event::Paste);
    }
    let edits = [(egui::Key::C, Event::Copy), (egui::Key::X, Event::Cut)];
    let edit = edits.into_iter().find(|(key, _)| *key == letter);
    edit.map(|(_, event)| event)
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::{ecs::message::MessageCursor, input::ButtonState};
    use bevy_egui::input::WindowToEguiContextMap;

    struct Keyboard {
        app: App,
        window: Entity,
        cursor: MessageCursor<EguiInputEvent>,
    }

    impl Keyboard {
        fn new() -> Self {
            let mut app = App::new();
            app.add_message::<KeyboardInput>()
                .add_message::<KeyboardFocusLost>()
                .add_message::<EguiInputEvent>()
                .init_resource::<WindowToEguiContextMap>()
                .init_resource::<KeyboardFocus>()
                .add_plugins(TypingPlugin);
            let window = app.world_mut().spawn_empty().id();
            let context = app.world_mut().spawn_empty().id();
            let mut contexts = app.world_mut().resource_mut::<WindowToEguiContextMap>();
            let of_window = contexts.window_to_contexts.entry(window);
            of_window.or_default().insert(context);
            Self {
                app,
                window,
                cursor: MessageCursor::default(),
            }
        }

        fn report(&mut self, key_code: KeyCode, logical_key: Key, is_pressed: bool) {
            let state = match is_pressed {
                true => ButtonState::Pressed,
                false => ButtonState::Released,
            };
            self.app.world_mut().write_message(KeyboardInput {
                key_code,
                logical_key,
                state,
                text: None,
                repeat: false,
                window: self.window,
            });
        }

        fn report_letter(&mut self, key: KeyCode, letter: &str) {
            for is_pressed in [true, false] {
                self.report(key, Key::Character(letter.into()), is_pressed);
            }
        }

        /// What egui gets in a frame.
        fn frame(&mut self) -> Vec<Event> {
            self.app.update();
            let events = self.app.world().resource::<Messages<EguiInputEvent>>();
            let new = self.cursor.read(events);
            new.map(|written| written.event.clone()).collect()
        }
    }

    fn is_press(event: &Event, letter: egui::Key, with_ctrl: bool) -> bool {
        matches!(
            event,
            Event::Key { key, pressed: true, modifiers, .. }
                if *key == letter && modifiers.ctrl == with_ctrl
        )
    }

    fn texts(events: &[Event]) -> String {
        let texts = events.iter().filter_map(|event| {
            let Event::Text(text) = event else {
                return None;
            };
            Some(text.as_str())
        });
        texts.collect()
    }

    #[test]
    fn a_chord_in_one_slow_frame_writes_nothing() {
        let mut keyboard = Keyboard::new();
        keyboard.report_letter(KeyCode::KeyB, "b");
        keyboard.report(KeyCode::ControlLeft, Key::Control, true);
        keyboard.report_letter(KeyCode::KeyA, "a");
        keyboard.report(KeyCode::ControlLeft, Key::Control, false);
        keyboard.report_letter(KeyCode::KeyD, "d");
        let events = keyboard.frame();
        assert_eq!(texts(&events), "bd");
        for (letter, with_ctrl) in [
            (egui::Key::B, false),
            (egui::Key::A, true),
            (egui::Key::D, false),
        ] {
            let mut pressed = events.iter();
            assert!(pressed.any(|event| is_press(event, letter, with_ctrl)));
        }
    }

    #[test]
    fn a_modifier_is_held_from_frame_to_frame_until_the_window_loses_the_keyboard() {
        let mut keyboard = Keyboard::new();
        keyboard.report(KeyCode::ControlLeft, Key::Control, true);
        keyboard.frame();
        keyboard.report_letter(KeyCode::KeyA, "a");
        assert_eq!(texts(&keyboard.frame()), "");
        keyboard.app.world_mut().write_message(KeyboardFocusLost);
        keyboard.report_letter(KeyCode::KeyA, "a");
        assert_eq!(texts(&keyboard.frame()), "a");
    }

    #[test]
    fn a_text_field_copies_and_cuts() {
        for (focus, expected) in [
            (KeyboardFocus::Text, vec![Event::Copy, Event::Cut]),
            (KeyboardFocus::World, vec![]),
        ] {
            let mut keyboard = Keyboard::new();
            keyboard.app.insert_resource(focus);
            keyboard.report(KeyCode::ControlLeft, Key::Control, true);
            keyboard.report_letter(KeyCode::KeyC, "c");
            keyboard.report_letter(KeyCode::KeyX, "x");
            let mut events = keyboard.frame();
            events.retain(|event| matches!(event, Event::Copy | Event::Cut));
            assert_eq!(events, expected, "{focus:?}");
        }
    }

    #[test]
    fn ctrl_v_pastes_and_altgr_writes() {
        let key = KeyboardInput {
            key_code: KeyCode::KeyV,
            logical_key: Key::Character("v".into()),
            state: ButtonState::Pressed,
            text: None,
            repeat: false,
            window: Entity::PLACEHOLDER,
        };
        let mut modifiers = ModifierKeysState::default();
        let pasted = |modifiers: &ModifierKeysState| edit(&key, modifiers, || Some("text".into()));
        assert_eq!(pasted(&modifiers), None);
        modifiers.ctrl = true;
        assert_eq!(pasted(&modifiers), Some(Event::Paste("text".into())));
        modifiers.alt = true;
        assert_eq!(pasted(&modifiers), None);
        assert_eq!(written(&key, &modifiers), Some(Event::Text("v".into())));
    }
}
