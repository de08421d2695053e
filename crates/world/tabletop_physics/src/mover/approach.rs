//! Approaches of moved solids to free objects: they are reached in one tick and pushed from the next one on.

use bevy::prelude::*;

use super::limits::{SQUEEZE, TOUCHING};

/// The approach of a moved solid to a free object in a tick.
#[derive(Clone, Copy, Debug)]
pub struct Approach {
    /// Gap at the beginning of the tick, in units; negative inside.
    pub gap: f32,
    /// Decrease of the gap by its end, in units.
    pub way: f32,
    /// Normal of the contact, from the solid to the free object.
    pub direction: Vec3,
    /// How far the free object goes away by itself meanwhile, in units.
    pub retreat: f32,
}

impl Approach {
    /// True if Rapier already has the contact, so that one pushes the other, or would have if the object had not gone away: a ball that rolls ahead
    /// of the wall of a tray is pushed by it.
    pub fn is_push(self) -> bool {
        self.gap <= TOUCHING + self.retreat
    }

    /// The part of its way that the solid can go if the object gives way: it reaches the object in one tick and pushes it from the next one
    /// on, the slower the more anything is squeezed, to this depth in units.
    pub fn part(self, squeeze: f32) -> f32 {
        match self.is_push() {
            true => (1.0 - squeeze.max(-self.gap) / SQUEEZE).clamp(0.0, 1.0),
            false => ((self.gap - TOUCHING / 2.0) / self.way).min(1.0),
        }
    }
}
