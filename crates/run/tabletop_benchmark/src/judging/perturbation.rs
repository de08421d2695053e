//! Perturbations: in what an episode may differ from another one that begins alike.

use std::fmt;

use serde::{Deserialize, Serialize};

/// In what an episode differs from its twin, the episode of the same task and number in which nothing does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Perturbation {
    /// The light in the pictures is brighter or darker, from elsewhere, warmer or colder.
    Light,
    /// Objects have other colours, or other shades of those that the sentences name.
    Colors,
    /// The cameras that stand, or the one on the robot's head, are elsewhere.
    Camera,
    /// Other objects stand around.
    Distractors,
    /// The task is told in other words.
    Words,
    /// Blocks are narrower.
    Sizes,
    /// Surfaces are rougher or smoother.
    Friction,
}

impl Perturbation {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::Light,
        Self::Colors,
        Self::Camera,
        Self::Distractors,
        Self::Words,
        Self::Sizes,
        Self::Friction,
    ];

    /// Its name, as files have it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Light => "light",
            Self::Colors => "colors",
            Self::Camera => "camera",
            Self::Distractors => "distractors",
            Self::Words => "words",
            Self::Sizes => "sizes",
            Self::Friction => "friction",
        }
    }
}

impl fmt::Display for Perturbation {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_have_the_names_that_options_have() {
        for perturbation in Perturbation::ALL {
            let json = serde_json::to_string(&perturbation).unwrap();
            assert_eq!(json, format!("\"{perturbation}\""));
        }
    }
}
