//! What a task consists of.

use serde::{Deserialize, Serialize};
use tabletop_core::{Hand, SimTick};

use crate::{goal::Goal, relation::Relation};

/// A manipulation of a task.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TaskStep {
    /// Its number, from 1.
    pub number: usize,
    /// What it does, as a sentence.
    pub sentence: String,
    /// The role of the object that is moved.
    pub object: String,
    /// The hands that were used, one after the other.
    pub hands: Vec<Hand>,
    /// The tick in which the object was grasped.
    pub grasp: SimTick,
    /// The tick in which it was let go of.
    pub release: SimTick,
    /// Whether the step before had not ended when this one began.
    pub meanwhile: bool,
    /// What is so afterwards, the most telling first.
    pub relations: Vec<Relation>,
    /// Where the object is to be; nowhere if it is removed or only picked up.
    pub goal: Option<Goal>,
    /// The numbers of the steps that must be done before it.
    pub after: Vec<usize>,
}
