//! Names of joints and limbs.

use std::{borrow::Cow, fmt, str};

use bevy::reflect::Reflect;
use serde::{
    Deserialize, Deserializer, Serialize, Serializer,
    de::{DeserializeSeed, EnumAccess, Error, VariantAccess, Visitor},
};

/// Largest number of bytes of a name.
const MOST_BYTES: usize = 63;

/// A name in snake case, which is stored in place: a stranger's file may hold any number of names.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
struct Name {
    /// Its bytes, and zeros behind them.
    bytes: [u8; MOST_BYTES],
    count: u8,
}

/// The error of a text that is too long for a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a name of {0} bytes, expected at most {MOST_BYTES}")]
pub struct NameError(usize);

impl Name {
    fn new(name: &str) -> Result<Self, NameError> {
        let name = snake_case(name);
        match name.len() {
            0..=MOST_BYTES => Ok(Self::of_snake_case(&name)),
            count => Err(NameError(count)),
        }
    }

    /// A name of at most [`MOST_BYTES`].
    const fn of_snake_case(name: &str) -> Self {
        let from = name.as_bytes();
        let mut bytes = [0; MOST_BYTES];
        let mut i = 0;
        while i < from.len() {
            bytes[i] = from[i];
            i += 1;
        }
        let count = i as u8;
        Self { bytes, count }
    }

    fn as_str(&self) -> &str {
        str::from_utf8(&self.bytes[..self.count.into()]).unwrap_or_default()
    }
}

/// Turns `LeftE1` into `left_e1`; a name in snake case stays as it is.
pub fn snake_case(name: &str) -> Cow<'_, str> {
    if !name.contains(char::is_uppercase) {
        return Cow::Borrowed(name);
    }
    let mut snake = String::with_capacity(name.len() + 4);
    let mut before = '_';
    for letter in name.chars() {
        if letter.is_uppercase() && before.is_alphanumeric() && !before.is_uppercase() {
            snake.push('_');
        }
        snake.extend(letter.to_lowercase());
        before = letter;
    }
    Cow::Owned(snake)
}

/// Reads a name from a text format: an identifier in RON, a string in JSON.
struct NameVisitor;

impl<'de> Visitor<'de> for NameVisitor {
    type Value = Name;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a name")
    }

    fn visit_str<E: Error>(self, name: &str) -> Result<Self::Value, E> {
        Name::new(name).map_err(E::custom)
    }

    fn visit_enum<A: EnumAccess<'de>>(self, access: A) -> Result<Self::Value, A::Error> {
        let (name, rest) = access.variant_seed(self)?;
        rest.unit_variant()?;
        Ok(name)
    }
}

impl<'de> DeserializeSeed<'de> for NameVisitor {
    type Value = Name;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Self::Value, D::Error> {
        deserializer.deserialize_identifier(self)
    }
}

macro_rules! name {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        ///
        /// In files `left_e1` and `LeftE1` are the same.
        #[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Reflect)]
        #[reflect(opaque)]
        pub struct $name(Name);

        impl $name {
            /// The name with this text.
            ///
            /// # Errors
            /// It has more than 63 bytes.
            pub fn new(name: &str) -> Result<Self, NameError> {
                Name::new(name).map(Self)
            }

            /// The name with this text of at most 63 bytes, which is in snake case.
            pub const fn from_static(name: &'static str) -> Self {
                Self(Name::of_snake_case(name))
            }

            /// Its text, in snake case.
            pub fn as_str(&self) -> &str {
                self.0.as_str()
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.pad(self.as_str())
            }
        }

        impl fmt::Debug for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(self.as_str())
            }
        }

        impl Serialize for $name {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.serialize_str(self.as_str())
            }
        }

        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                deserializer
                    .deserialize_enum(stringify!($name), &[], NameVisitor)
                    .map(Self)
            }
        }
    };
}

name! {
    /// Name of a joint of the robot, or of the opening of a gripper: `left_e1`, `left_gripper`.
    JointName
}

name! {
    /// Name of a limb of the robot: `left`.
    LimbName
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_in_snake_case() {
        for (text, name) in [
            ("left_e1", "left_e1"),
            ("LeftE1", "left_e1"),
            ("HeadPan", "head_pan"),
            ("Left", "left"),
            ("panda_joint1", "panda_joint1"),
            ("XYTable", "xytable"),
            ("J1", "j1"),
        ] {
            let found = JointName::new(text).unwrap();
            assert_eq!(found.as_str(), name);
            assert_eq!(found, JointName::from_static(name));
        }
    }

    #[test]
    fn names_are_in_the_order_of_their_texts() {
        let texts = ["", "a", "a\0", "a\0b", "aa", "b", "ä"];
        let names = texts.map(|text| LimbName::new(text).unwrap());
        assert!(names.is_sorted() && texts.is_sorted());
        assert_eq!(names.each_ref().map(LimbName::as_str), texts);
    }

    #[test]
    fn a_name_that_is_too_long_is_refused_with_the_limit() {
        let longest = "j".repeat(MOST_BYTES);
        assert_eq!(JointName::new(&longest).unwrap().as_str(), longest);
        let longer = longest + "j";
        assert_eq!(JointName::new(&longer), Err(NameError(64)));
        let read = serde_json::from_str::<JointName>(&format!("\"{longer}\""));
        let error = read.unwrap_err().to_string();
        assert!(
            error.contains("a name of 64 bytes, expected at most 63"),
            "{error}"
        );
    }

    #[test]
    fn names_are_read_from_ron_and_json() {
        let name = JointName::from_static("left_e1");
        assert_eq!(ron::from_str(" LeftE1 "), Ok(name));
        assert_eq!(ron::from_str("left_e1"), Ok(name));
        let written = serde_json::to_string(&name).unwrap();
        assert_eq!(written, "\"left_e1\"");
        assert_eq!(serde_json::from_str::<JointName>(&written).unwrap(), name);
        assert!(ron::from_str::<JointName>("LeftE1(2)").is_err());
        assert!(ron::from_str::<JointName>("17").is_err());
    }
}
