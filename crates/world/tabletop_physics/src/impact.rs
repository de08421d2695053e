//! Impacts: bodies that bounce off each other.
//!
//! Rapier stops whatever hits something, and here it is given the velocity with which it leaves. Rapier's own restitution treats one corner of a face
//! after the other, which makes a cube spin, and ends a row of equal balls with all of them in motion.

mod contacts;
mod energy;
mod flight;
mod graph;
mod keep;
mod onset;
mod rebound;
mod striker;

use bevy::prelude::*;

pub(crate) use keep::{SubstepsBefore, keep_speed, note_substeps};
pub(crate) use onset::{Onset, note_onset};
pub(crate) use rebound::rebound;

use crate::encounter::FreeFlights;

/// Share of an impact's speed with which a surface lets things bounce, 0 to 1. That of a contact is the mean of both surfaces'. A surface
/// without one has 0.
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Component)]
pub(crate) struct Elasticity(pub f32);

/// True if anything may bounce.
pub(crate) fn is_any_elastic(surfaces: Query<(), With<Elasticity>>) -> bool {
    !surfaces.is_empty()
}

/// True if the step's impacts may have other results than Rapier's.
pub(crate) fn has_impacts(
    surfaces: Query<(), With<Elasticity>>,
    flights: Res<FreeFlights>,
) -> bool {
    !surfaces.is_empty() || flights.is_any_skewed()
}

/// True if anything may bounce, or is fast.
pub(crate) fn may_strike(surfaces: Query<(), With<Elasticity>>, flights: Res<FreeFlights>) -> bool {
    !surfaces.is_empty() || flights.is_any()
}
