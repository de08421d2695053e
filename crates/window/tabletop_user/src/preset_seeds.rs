//! The seeds of the user's presets.

use bevy::prelude::*;
use tabletop_core::{Preset, Random, SceneCommand};

/// Draws the seeds of the presets that keys and panels make: the same series in every run with the same seed.
#[derive(Resource, Clone, Debug, PartialEq, Eq)]
pub struct PresetSeeds(Random);

impl PresetSeeds {
    /// The seed of the original program.
    pub const DEFAULT: u64 = 5566;

    /// The series that a seed begins.
    pub const fn new(seed: u64) -> Self {
        Self(Random::new(seed))
    }

    /// The command that makes a preset with the next seed.
    pub fn make(&mut self, preset: Preset) -> SceneCommand {
        let seed = self.0.bits();
        SceneCommand::Make { preset, seed }
    }
}

impl Default for PresetSeeds {
    fn default() -> Self {
        Self::new(Self::DEFAULT)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_preset_gets_a_seed_of_its_own() {
        let mut seeds = PresetSeeds::default();
        let [first, second] = [(); 2].map(|()| seeds.make(Preset::BigBlock));
        assert_ne!(first, second);
        assert_eq!(PresetSeeds::default().make(Preset::BigBlock), first);
    }
}
