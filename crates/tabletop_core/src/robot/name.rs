//! Names of joints and limbs.

use std::{
    borrow::Cow,
    collections::BTreeSet,
    fmt,
    sync::{Mutex, PoisonError},
};

use bevy::reflect::Reflect;
use serde::{
    Deserialize, Deserializer, Serialize, Serializer,
    de::{DeserializeSeed, EnumAccess, Error, VariantAccess, Visitor},
};

/// Every name that was ever read. Names are few and short, so they are kept for ever.
static NAMES: Mutex<BTreeSet<&'static str>> = Mutex::new(BTreeSet::new());

fn interned(name: &str) -> &'static str {
    let name = snake_case(name);
    let mut names = NAMES.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = names.get(&*name) {
        return known;
    }
    let name: &'static str = Box::leak(name.into_owned().into_boxed_str());
    names.insert(name);
    name
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
    type Value = &'static str;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a name")
    }

    fn visit_str<E: Error>(self, name: &str) -> Result<Self::Value, E> {
        Ok(interned(name))
    }

    fn visit_enum<A: EnumAccess<'de>>(self, access: A) -> Result<Self::Value, A::Error> {
        let (name, rest) = access.variant_seed(self)?;
        rest.unit_variant()?;
        Ok(name)
    }
}

impl<'de> DeserializeSeed<'de> for NameVisitor {
    type Value = &'static str;

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
        pub struct $name(&'static str);

        impl $name {
            /// The name with this text.
            pub fn new(name: &str) -> Self {
                Self(interned(name))
            }

            /// The name with this text, which is in snake case.
            pub const fn from_static(name: &'static str) -> Self {
                Self(name)
            }

            /// Its text, in snake case.
            pub const fn as_str(self) -> &'static str {
                self.0
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.pad(self.0)
            }
        }

        impl fmt::Debug for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(self.0)
            }
        }

        impl Serialize for $name {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.serialize_str(self.0)
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
            assert_eq!(JointName::new(text).as_str(), name);
            assert_eq!(JointName::new(text), JointName::from_static(name));
        }
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
