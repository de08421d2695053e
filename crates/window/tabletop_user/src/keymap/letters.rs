//! Letters printed on the keys.

use std::collections::BTreeMap;

use bevy::prelude::*;
use bevy_input::keyboard::{Key, KeyCode, KeyboardInput};

use super::Modifiers;

/// The letters that the user's keyboard has on its keys, as far as key presses have revealed them. With Ctrl, Alt or Super the letter
/// counts, so that Ctrl+Z is undo on every keyboard with Latin letters; otherwise the place of the key counts.
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
pub struct KeyLetters {
    letters: BTreeMap<KeyCode, KeyCode>,
}

impl KeyLetters {
    /// Learns the letter of a key from a press.
    pub fn learn(&mut self, input: &KeyboardInput) {
        let Key::Character(written) = &input.logical_key else {
            return;
        };
        if let Some(key) = key_that_writes(written) {
            self.letters.insert(input.key_code, key);
        }
    }

    /// The key of a US keyboard that has this key's meaning while these modifiers are held down.
    pub(super) fn with(&self, modifiers: Modifiers, key: KeyCode) -> KeyCode {
        let Modifiers {
            ctrl,
            alt,
            super_key,
            shift: _,
        } = modifiers;
        let letter = self.letters.get(&key).filter(|_| ctrl || alt || super_key);
        letter.copied().unwrap_or(key)
    }
}

/// The key of a US keyboard that writes a text.
fn key_that_writes(text: &str) -> Option<KeyCode> {
    use KeyCode::*;
    const LETTERS: [KeyCode; 26] = [
        KeyA, KeyB, KeyC, KeyD, KeyE, KeyF, KeyG, KeyH, KeyI, KeyJ, KeyK, KeyL, KeyM, KeyN, KeyO,
        KeyP, KeyQ, KeyR, KeyS, KeyT, KeyU, KeyV, KeyW, KeyX, KeyY, KeyZ,
    ];
    const DIGITS: [KeyCode; 10] = [
        Digit0, Digit1, Digit2, Digit3, Digit4, Digit5, Digit6, Digit7, Digit8, Digit9,
    ];
    let mut written = text.chars();
    let (char, None) = (written.next()?.to_ascii_lowercase(), written.next()) else {
        return None;
    };
    Some(match char {
        'a'..='z' => LETTERS[char as usize - 'a' as usize],
        '0'..='9' => DIGITS[char as usize - '0' as usize],
        '+' | '=' => Equal,
        '-' => Minus,
        ',' => Comma,
        '.' => Period,
        '/' => Slash,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy_input::ButtonState;

    fn struck(key_code: KeyCode, written: &str) -> KeyboardInput {
        KeyboardInput {
            key_code,
            logical_key: Key::Character(written.into()),
            state: ButtonState::Pressed,
            text: None,
            repeat: false,
            window: Entity::PLACEHOLDER,
        }
    }

    #[test]
    fn letters_count_with_ctrl_and_places_without() {
        let mut letters = KeyLetters::default();
        assert_eq!(letters.with(Modifiers::CTRL, KeyCode::KeyY), KeyCode::KeyY);
        // A German keyboard.
        letters.learn(&struck(KeyCode::KeyY, "z"));
        letters.learn(&struck(KeyCode::KeyZ, "Y"));
        letters.learn(&struck(KeyCode::BracketRight, "+"));
        for (key, letter) in [
            (KeyCode::KeyY, KeyCode::KeyZ),
            (KeyCode::KeyZ, KeyCode::KeyY),
            (KeyCode::BracketRight, KeyCode::Equal),
        ] {
            assert_eq!(letters.with(Modifiers::CTRL, key), letter);
            assert_eq!(letters.with(Modifiers::SHIFT, key), key);
        }
    }

    #[test]
    fn letters_of_no_us_key_leave_a_key_its_place() {
        let mut letters = KeyLetters::default();
        for written in ["я", "ß", "ab", ""] {
            letters.learn(&struck(KeyCode::KeyZ, written));
            assert_eq!(letters.with(Modifiers::CTRL, KeyCode::KeyZ), KeyCode::KeyZ);
        }
    }
}
