//! Colours of objects.

use std::{fmt, str::FromStr};

use bevy::reflect::Reflect;
use serde::{Deserialize, Serialize};

/// A colour as it is displayed: red, green, blue in 0..=1, with no gamma to be applied.
///
/// ```
/// use tabletop_geometry::Rgb;
///
/// assert_eq!("orange".parse::<Rgb>().unwrap().to_string(), "#fb8200");
/// assert_eq!("#00A57F".parse::<Rgb>().unwrap().to_string(), "#00a57f");
/// assert!("vermilion".parse::<Rgb>().is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, Reflect)]
pub struct Rgb {
    /// Red, 0..=1.
    pub red: f32,
    /// Green, 0..=1.
    pub green: f32,
    /// Blue, 0..=1.
    pub blue: f32,
}

/// The colours that a task file can name (report section 6.2).
pub const NAMED_COLORS: [(&str, Rgb); 14] = [
    ("black", Rgb::BLACK),
    ("blue", Rgb::BLUE),
    ("brown", Rgb::BROWN),
    ("cyan", Rgb::CYAN),
    ("darkgray", Rgb::DARK_GRAY),
    ("gray", Rgb::GRAY),
    ("green", Rgb::GREEN),
    ("lightgray", Rgb::new(0.8, 0.8, 0.8)),
    ("magenta", Rgb::MAGENTA),
    ("orange", Rgb::ORANGE),
    ("pink", Rgb::new(1.0, 0.68, 0.68)),
    ("red", Rgb::RED),
    ("white", Rgb::WHITE),
    ("yellow", Rgb::YELLOW),
];

impl Rgb {
    /// Black.
    pub const BLACK: Self = Self::new(0.0, 0.0, 0.0);
    /// The colour of an object that names none.
    pub const GRAY: Self = Self::new(0.5, 0.5, 0.5);
    /// White.
    pub const WHITE: Self = Self::new(1.0, 1.0, 1.0);
    /// Blue.
    pub const BLUE: Self = Self::new(0.0, 0.0, 1.0);
    /// Brown.
    pub const BROWN: Self = Self::new(65.0 / 255.0, 40.0 / 255.0, 25.0 / 255.0);
    /// Cyan.
    pub const CYAN: Self = Self::new(0.0, 1.0, 1.0);
    /// Dark gray.
    pub const DARK_GRAY: Self = Self::new(0.2, 0.2, 0.2);
    /// Green.
    pub const GREEN: Self = Self::new(0.0, 1.0, 0.0);
    /// Magenta.
    pub const MAGENTA: Self = Self::new(1.0, 0.0, 1.0);
    /// Orange.
    pub const ORANGE: Self = Self::new(251.0 / 255.0, 130.0 / 255.0, 0.0);
    /// Red.
    pub const RED: Self = Self::new(1.0, 0.0, 0.0);
    /// Yellow.
    pub const YELLOW: Self = Self::new(1.0, 1.0, 0.0);

    /// A colour from its parts, each 0..=1.
    pub const fn new(red: f32, green: f32, blue: f32) -> Self {
        Self { red, green, blue }
    }

    /// The nearest colour with 8 bits a channel.
    pub fn to_bytes(self) -> [u8; 3] {
        [self.red, self.green, self.blue].map(|part| (part.clamp(0.0, 1.0) * 255.0 + 0.5) as u8)
    }
}

/// The error of a text that is no colour.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is not a colour; expected #rrggbb or one of {names}", names = NAMED_COLORS.map(|(name, _)| name).join(", "))]
pub struct ColorError(String);

impl FromStr for Rgb {
    type Err = ColorError;

    /// Reads a colour name or `#rrggbb`, in upper or lower case, with or without spaces around it.
    fn from_str(text: &str) -> Result<Self, ColorError> {
        let color = text.trim();
        if let Some(hex) = color.strip_prefix('#')
            && hex.len() == 6
            && hex.bytes().all(|digit| digit.is_ascii_hexdigit())
            && let Ok(rgb) = u32::from_str_radix(hex, 16)
        {
            let part = |shift: u32| ((rgb >> shift) & 0xff) as f32 / 255.0;
            return Ok(Self::new(part(16), part(8), part(0)));
        }
        NAMED_COLORS
            .iter()
            .find(|(name, _)| name.eq_ignore_ascii_case(color))
            .map(|&(_, rgb)| rgb)
            .ok_or_else(|| ColorError(text.to_owned()))
    }
}

impl fmt::Display for Rgb {
    /// Writes `#rrggbb`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [red, green, blue] = self.to_bytes();
        write!(f, "#{red:02x}{green:02x}{blue:02x}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_reads_back() {
        for (name, color) in NAMED_COLORS {
            assert_eq!(name.parse(), Ok(color));
            assert_eq!(name.to_uppercase().parse(), Ok(color));
        }
    }

    #[test]
    fn only_six_hexadecimal_digits_are_a_colour() {
        for text in ["#fff", "#12345g", "#+12345", "#1234567", "", "#", "#é1234"] {
            assert!(text.parse::<Rgb>().is_err(), "{text} was read");
        }
        assert_eq!(
            " #FF8000 ".parse::<Rgb>().map(Rgb::to_bytes),
            Ok([255, 128, 0])
        );
    }
}
