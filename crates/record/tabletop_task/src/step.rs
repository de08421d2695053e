//! Steps of tasks.

use serde::{Deserialize, Serialize};
use tabletop_core::{Manipulator, SimTick};

use crate::{
    goal::Goal, load::CarriedObject, manipulation::Spill, relation::Relation, tipping::Tipping,
};

/// A manipulation of a task.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TaskStep {
    /// Its number, from 1.
    pub number: usize,
    /// The step as a sentence.
    pub sentence: String,
    /// The role of the moved object.
    pub object: String,
    /// The hands and grippers used, one after the other.
    pub hands: Vec<Manipulator>,
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
    /// The objects that go along with it, each after what it is on or in.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub load: Vec<CarriedObject>,
    /// The object from which it is poured or tipped, if it is not taken itself.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spilled: Option<Spill>,
    /// The way in which it comes to lie on another of its sides, if it does.
    pub tipping: Option<Tipping>,
    /// Numbers of the steps that must be done before it.
    pub after: Vec<usize>,
}

impl TaskStep {
    /// Steps that put its load where it is in the end, one object each.
    pub fn loading(&self) -> Vec<Self> {
        let load = self.load.iter().cloned();
        let loading = load.map(|load| Self {
            object: load.object,
            relations: load.relations,
            goal: Some(load.goal),
            load: Vec::new(),
            spilled: None,
            tipping: None,
            ..self.clone()
        });
        loading.collect()
    }
}
