//! A key with its modifiers.

use std::{fmt, str::FromStr};

use bevy::reflect::{
    FromReflect as _, Typed as _,
    enums::{DynamicEnum, DynamicVariant},
};
use bevy_input::keyboard::KeyCode::{self, *};
use thiserror::Error;

/// The modifier keys that are held down with another key.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Modifiers {
    /// Either Ctrl key.
    pub ctrl: bool,
    /// Either Alt key.
    pub alt: bool,
    /// Either Shift key.
    pub shift: bool,
    /// Either Super key: the one with the Windows logo, or Command.
    pub super_key: bool,
}

/// A key, by its place on the keyboard, with its modifiers. As text: `Space`, `Ctrl+Shift+KeyZ`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct KeyBinding {
    /// The modifiers.
    pub modifiers: Modifiers,
    /// The key.
    pub key: KeyCode,
}

/// The error of a text that is no key binding.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum BindingError {
    /// There is no such key.
    #[error("there is no key `{0}`; keys are named as on a US keyboard: KeyA, Digit1, Space, F1")]
    UnknownKey(String),
    /// There is no such modifier.
    #[error("there is no modifier `{0}`; it can be Ctrl, Alt, Shift or Super")]
    UnknownModifier(String),
}

impl Modifiers {
    /// No modifier.
    pub const NONE: Self = Self {
        ctrl: false,
        alt: false,
        shift: false,
        super_key: false,
    };
    /// Ctrl alone.
    pub const CTRL: Self = Self {
        ctrl: true,
        ..Self::NONE
    };
    /// Alt alone.
    pub const ALT: Self = Self {
        alt: true,
        ..Self::NONE
    };
    /// Shift alone.
    pub const SHIFT: Self = Self {
        shift: true,
        ..Self::NONE
    };

    /// These and Shift.
    pub const fn with_shift(self) -> Self {
        Self {
            shift: true,
            ..self
        }
    }

    /// These, but not Ctrl.
    pub(super) const fn without_ctrl(self) -> Self {
        Self {
            ctrl: false,
            ..self
        }
    }

    /// The modifiers of which at least one key is on.
    pub(super) fn that_are(is_on: impl core::ops::Fn(KeyCode) -> bool) -> Self {
        Self {
            ctrl: is_on(ControlLeft) || is_on(ControlRight),
            alt: is_on(AltLeft) || is_on(AltRight),
            shift: is_on(ShiftLeft) || is_on(ShiftRight),
            super_key: is_on(SuperLeft) || is_on(SuperRight),
        }
    }
}

impl KeyBinding {
    /// A key with modifiers.
    pub const fn new(modifiers: Modifiers, key: KeyCode) -> Self {
        Self { modifiers, key }
    }

    /// True if pressing the key with these modifiers is this binding. Superfluous Shift is ignored, and so is everything held with a
    /// key that is itself a modifier.
    pub(super) fn fits(self, held: Modifiers) -> bool {
        let expected = Modifiers {
            shift: held.shift,
            ..self.modifiers
        };
        is_modifier(self.key) || (expected == held && (held.shift || !self.modifiers.shift))
    }

    /// Its label for the user: `Ctrl+Shift+Z`, with the key's letter on a US keyboard.
    pub fn label(self) -> String {
        format!("{}{}", self.modifiers, label(self.key))
    }
}

impl fmt::Display for Modifiers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let held = [
            (self.ctrl, "Ctrl+"),
            (self.alt, "Alt+"),
            (self.shift, "Shift+"),
            (self.super_key, "Super+"),
        ];
        held.into_iter()
            .filter(|(is_held, _)| *is_held)
            .try_for_each(|(_, name)| f.write_str(name))
    }
}

impl fmt::Display for KeyBinding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{:?}", self.modifiers, self.key)
    }
}

impl FromStr for KeyBinding {
    type Err = BindingError;

    fn from_str(text: &str) -> Result<Self, BindingError> {
        let (modifiers, key) = match text.rsplit_once('+') {
            Some((modifiers, key)) => (Some(modifiers), key),
            None => (None, text),
        };
        let mut binding = Self::new(Modifiers::NONE, key_named(key.trim())?);
        let modifiers = modifiers.into_iter().flat_map(|text| text.split('+'));
        for modifier in modifiers.map(str::trim) {
            let Modifiers {
                ctrl,
                alt,
                shift,
                super_key,
            } = &mut binding.modifiers;
            match modifier {
                "Ctrl" => *ctrl = true,
                "Alt" => *alt = true,
                "Shift" => *shift = true,
                "Super" => *super_key = true,
                _ => return Err(BindingError::UnknownModifier(modifier.to_owned())),
            }
        }
        Ok(binding)
    }
}

fn key_named(name: &str) -> Result<KeyCode, BindingError> {
    let unknown = || BindingError::UnknownKey(name.to_owned());
    let keys = KeyCode::type_info().as_enum().map_err(|_| unknown())?;
    // Keys without a name have a number, which differs from system to system.
    let variant = keys
        .variant(name)
        .filter(|key| key.as_unit_variant().is_ok());
    let variant = variant.ok_or_else(unknown)?;
    let key = DynamicEnum::new(variant.name(), DynamicVariant::Unit);
    KeyCode::from_reflect(&key).ok_or_else(unknown)
}

const fn is_modifier(key: KeyCode) -> bool {
    matches!(
        key,
        ControlLeft
            | ControlRight
            | AltLeft
            | AltRight
            | ShiftLeft
            | ShiftRight
            | SuperLeft
            | SuperRight
    )
}

/// True if a key never writes text.
pub(super) fn is_function_key(key: KeyCode) -> bool {
    (F1..=F35).contains(&key)
}

/// The letter that a US keyboard has at the place of a key.
#[expect(
    clippy::wildcard_enum_match_arm,
    reason = "Bevy knows many more keys than need a name of their own"
)]
fn label(key: KeyCode) -> String {
    let label = match key {
        Backquote => "`",
        Backslash => "\\",
        BracketLeft => "[",
        BracketRight => "]",
        Comma => ",",
        Equal => "=",
        Minus => "-",
        Period => ".",
        Quote => "'",
        Semicolon => ";",
        Slash => "/",
        Escape => "Esc",
        ArrowLeft => "←",
        ArrowRight => "→",
        ArrowUp => "↑",
        ArrowDown => "↓",
        PageUp => "Page up",
        PageDown => "Page down",
        ControlLeft => "left Ctrl",
        ControlRight => "right Ctrl",
        ShiftLeft => "left Shift",
        ShiftRight => "right Shift",
        AltLeft => "left Alt",
        AltRight => "right Alt",
        SuperLeft => "left Super",
        SuperRight => "right Super",
        NumpadAdd => "keypad +",
        NumpadSubtract => "keypad -",
        NumpadMultiply => "keypad *",
        NumpadDivide => "keypad /",
        NumpadDecimal => "keypad .",
        key => {
            let name = format!("{key:?}");
            let shortened = [("Key", ""), ("Digit", ""), ("Numpad", "keypad ")]
                .into_iter()
                .find_map(|(prefix, short)| Some(short.to_owned() + name.strip_prefix(prefix)?));
            return shortened.unwrap_or(name);
        }
    };
    label.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn binding(text: &str) -> KeyBinding {
        text.parse().unwrap()
    }

    #[test]
    fn a_binding_is_read_as_it_is_written() {
        for text in [
            "Space",
            "Shift+KeyT",
            "Ctrl+Shift+KeyZ",
            "Ctrl+Alt+Shift+Super+F11",
        ] {
            assert_eq!(binding(text).to_string(), text);
        }
        assert_eq!(binding("Shift + Ctrl+ KeyZ"), binding("Ctrl+Shift+KeyZ"));
    }

    #[test]
    fn unknown_keys_and_modifiers_are_named() {
        for (text, unknown) in [
            ("", BindingError::UnknownKey(String::new())),
            ("KeyÄ", BindingError::UnknownKey("KeyÄ".into())),
            ("Ctrl+", BindingError::UnknownKey(String::new())),
            (
                "Unidentified",
                BindingError::UnknownKey("Unidentified".into()),
            ),
            ("Cmd+KeyZ", BindingError::UnknownModifier("Cmd".into())),
            ("+KeyZ", BindingError::UnknownModifier(String::new())),
        ] {
            assert_eq!(text.parse::<KeyBinding>(), Err(unknown), "{text}");
        }
    }

    #[test]
    fn labels_are_those_of_a_us_keyboard() {
        for (text, label) in [
            ("Space", "Space"),
            ("Ctrl+Shift+KeyZ", "Ctrl+Shift+Z"),
            ("Digit1", "1"),
            ("Shift+Slash", "Shift+/"),
            ("ArrowLeft", "←"),
            ("F11", "F11"),
            ("Numpad0", "keypad 0"),
            ("Ctrl+NumpadAdd", "Ctrl+keypad +"),
            ("ControlLeft", "left Ctrl"),
        ] {
            assert_eq!(binding(text).label(), label);
        }
    }

    #[test]
    fn only_shift_may_be_held_in_vain() {
        let held = |ctrl, shift| Modifiers {
            ctrl,
            shift,
            ..Modifiers::NONE
        };
        for (text, ctrl, shift, fits) in [
            ("KeyW", false, false, true),
            ("KeyW", false, true, true),
            ("KeyW", true, false, false),
            ("Shift+KeyW", false, false, false),
            ("Shift+KeyW", false, true, true),
            ("Ctrl+KeyW", true, true, true),
            ("Ctrl+KeyW", false, false, false),
            ("ControlLeft", true, true, true),
        ] {
            assert_eq!(binding(text).fits(held(ctrl, shift)), fits, "{text}");
        }
    }

    proptest! {
        #[test]
        fn no_text_is_misread(text in "(Ctrl|Alt|Shift|Super|\\+| |Key[A-Z]|F[1-9]|[a-z]|Space){0,6}") {
            if let Ok(binding) = text.parse::<KeyBinding>() {
                prop_assert_eq!(binding.to_string().parse::<KeyBinding>(), Ok(binding));
            }
        }

        #[test]
        fn every_binding_is_read_again(
            ctrl: bool, alt: bool, shift: bool, super_key: bool,
            key in prop::sample::select(vec![KeyT, Space, ArrowLeft, Digit0, F35, NumpadAdd, ControlLeft, Escape]),
        ) {
            let binding = KeyBinding::new(Modifiers { ctrl, alt, shift, super_key }, key);
            prop_assert_eq!(binding.to_string().parse::<KeyBinding>(), Ok(binding));
        }
    }
}
