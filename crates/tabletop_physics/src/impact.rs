//! Impacts: bodies that bounce off each other.
//!
//! Rapier stops whatever hits something, and here it is given the velocity with which it leaves. Rapier's own restitution treats one corner of a face
//! after the other, which makes a cube spin, and ends a row of equal balls with all of them in motion.

mod contacts;
mod flight;
mod graph;
mod onset;
mod rebound;

use bevy::prelude::*;

pub(crate) use onset::{Onset, note_onset};
pub(crate) use rebound::rebound;

/// Share of an impact's speed with which a surface lets things bounce, 0 to 1. That of a contact is the mean of both surfaces'. A surface
/// without one has 0.
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Component)]
pub(crate) struct Elasticity(pub f32);

/// True if anything may bounce.
pub(crate) fn is_any_elastic(surfaces: Query<(), With<Elasticity>>) -> bool {
    !surfaces.is_empty()
}
