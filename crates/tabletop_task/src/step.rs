//! Steps of tasks.

use serde::{Deserialize, Serialize};
use tabletop_core::{Hand, SimTick};

use crate::{goal::Goal, relation::Relation, tipping::Tipping};

/// A manipulation of a task.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TaskStep {
    /// Its number, from 1.
    pub number: usize,
    /// The step as a sentence.
    pub sentence: String,
    /// The role of the moved object.
    pub object: String,
    /// The hands used, one after the other.
    pub hands: Vec<Hand>,
    /// The tick in which the object was grasped.
    pub grasp: SimTick,
    /// The tick in which it was released.
    pub release: SimTick,
    /// True if the previous step had not ended when this one began.
    pub meanwhile: bool,
    /// The relations that it establishes, the most telling first.
    pub relations: Vec<Relation>,
    /// The goal of the object; `None` if it is removed, only picked up, or let go in the air.
    pub goal: Option<Goal>,
    /// The way in which it comes to lie on another of its sides, if it does.
    pub tipping: Option<Tipping>,
    /// Numbers of the steps that must be done before it.
    pub after: Vec<usize>,
}
