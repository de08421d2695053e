//! How the mouse drags, as the user has chosen.

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

/// How the mouse drags what is held. The panels keep it from run to run.
#[derive(Resource, Clone, Copy, Debug, PartialEq, Eq, Reflect, Serialize, Deserialize)]
#[reflect(Resource)]
#[serde(default, deny_unknown_fields)]
pub struct Dragging {
    /// In the level plane through the object, where a drag also takes it and lets it go; else in the report's upright one.
    pub is_level: bool,
    /// In the level plane, what is dragged over other objects is lifted onto them.
    pub goes_on_top: bool,
    /// What comes near a face of another object gets flush with it.
    pub snaps_to_faces: bool,
    /// What comes near the middle of another object is centred on it.
    pub snaps_to_centers: bool,
    /// What snaps to nothing else keeps to a grid of [`GRID`](Self::GRID).
    pub snaps_to_grid: bool,
    /// Turns are multiples of [`ANGLE_STEP`](Self::ANGLE_STEP).
    pub turns_in_steps: bool,
}

impl Default for Dragging {
    fn default() -> Self {
        Self {
            is_level: false,
            goes_on_top: true,
            snaps_to_faces: false,
            snaps_to_centers: false,
            snaps_to_grid: false,
            turns_in_steps: false,
        }
    }
}

impl Dragging {
    /// Distance of the lines of the grid, in units: half the edge of a small block.
    pub const GRID: f32 = 0.5;

    /// Step of turns, in degrees: halves and thirds of a right angle are multiples of it.
    pub const ANGLE_STEP: i32 = 15;

    /// The angle, in degrees, to which a turn to this angle goes.
    pub const fn turned_to(&self, degrees: i32) -> i32 {
        match self.turns_in_steps {
            true => {
                (degrees + Self::ANGLE_STEP / 2).div_euclid(Self::ANGLE_STEP) * Self::ANGLE_STEP
            }
            false => degrees,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_go_to_the_nearest_step() {
        let free = Dragging::default();
        let stepped = Dragging {
            turns_in_steps: true,
            ..free
        };
        for (degrees, step) in [
            (0, 0),
            (7, 0),
            (8, 15),
            (-7, 0),
            (-8, -15),
            (97, 90),
            (180, 180),
        ] {
            assert_eq!(free.turned_to(degrees), degrees);
            assert_eq!(stepped.turned_to(degrees), step);
        }
    }
}
