//! Points at which objects are fastened to each other: a screw's tip and the hole for it.

use bevy::prelude::*;
use serde::{Deserialize, Serialize};

use crate::Pose;

/// A point of a composite at which it can be fastened to another object.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BondPoint {
    /// Only points of one type fit each other.
    pub fit: String,
    /// Which end of a bond it is.
    pub end: BondEnd,
}

/// The two ends of a bond.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum BondEnd {
    /// What is fastened: a screw.
    Guest(GuestPoint),
    /// What it is fastened to: a hole.
    Host(HostPoint),
}

/// The end of what is fastened.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GuestPoint {
    /// Id of the host point to which it is bonded at first; empty for none.
    pub host: String,
    /// How tight it is at first; 0 for not bonded.
    pub tightness: u32,
}

/// The end of what it is fastened to. Each step of the tightness has effects on others.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HostPoint {
    /// Id of the control whose state is the tightness; empty for none.
    pub downstream: String,
    /// Id of the control whose state is overridden with that of the step; empty for none.
    pub downstream_override: String,
    /// Id of another host point that steps lock; empty for none.
    pub downstream_lock: String,
    /// The steps, from the loosest.
    pub steps: Vec<TightnessStep>,
}

impl HostPoint {
    /// The step of a tightness; none of 0.
    pub fn step(&self, tightness: u32) -> Option<&TightnessStep> {
        let number = tightness.checked_sub(1)?;
        self.steps.get(number as usize)
    }
}

/// A step of a host point's tightness.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TightnessStep {
    /// Where the guest point is, in the frame of the host point.
    pub pose: Pose,
    /// The state with which it overrides that of a control.
    pub state: Option<u32>,
    /// Whether it locks another host point.
    pub locks: bool,
}

/// What is fastened to what, and how tight.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Bond {
    /// Id of the host point.
    pub host_point: String,
    /// Id of the object that it is a part of.
    pub host: String,
    /// Id of the guest point.
    pub guest_point: String,
    /// Id of the object that it is a part of.
    pub guest: String,
    /// The step of its tightness; 0 when it is no more.
    pub tightness: u32,
}

/// The bonds that there are, in the order in which they were made.
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
pub struct Bonds(pub Vec<Bond>);
