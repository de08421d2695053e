//! Links that push nothing.

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;

/// The links that push nothing; true at the number of each. They go where the robot moves them, but Rapier computes no contacts for them.
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
pub struct PassiveLinks {
    /// The links that are far from every free object. They sleep: two dozen moving bodies would be most of a physics step.
    far: Vec<bool>,
    /// The links that overlap an object: the robot appeared there, or something pressed the object against them. They would press it into the
    /// table, so they push nothing until they are out of it.
    pub inside: Vec<bool>,
    /// True in the tick in which the robot appears: objects that appear with it have no bodies yet.
    is_new: bool,
}

impl PassiveLinks {
    /// The links that are far, and those that overlap an object; empty lists if there are none.
    pub fn new(far: Vec<bool>, inside: Vec<bool>) -> Self {
        let any = |links: Vec<bool>| {
            if links.contains(&true) {
                links
            } else {
                Vec::new()
            }
        };
        Self {
            far: any(far),
            inside: any(inside),
            is_new: false,
        }
    }

    /// All links of a robot that has just appeared, until the next tick shows which of them overlap an object.
    pub fn of_newcomer(links: usize) -> Self {
        Self {
            is_new: links > 0,
            ..Self::new(Vec::new(), vec![true; links])
        }
    }

    /// The passive links a tick later, of a robot with `links` links. Links that overlap nothing any more leave; links that crush an object join.
    pub fn after_tick(
        &self,
        links: usize,
        mut is_inside: impl FnMut(usize) -> bool,
        crushes: impl Fn(usize) -> bool,
    ) -> Self {
        let was_inside = |link: usize| self.inside.get(link).copied().unwrap_or(false);
        let inside = (0..links)
            .map(|link| crushes(link) || was_inside(link) && (self.is_new || is_inside(link)));
        Self::new(self.far.clone(), inside.collect())
    }

    /// True if any link overlaps an object.
    pub fn are_inside(&self) -> bool {
        !self.inside.is_empty()
    }

    /// Replaces the passive links by others: Rapier computes the contacts of all links but these.
    pub fn set(&mut self, to: Self, links: &[Entity], shapes: &mut RapierContextColliders) {
        for (number, link) in links.iter().enumerate() {
            let is_passive = to.contains(number);
            if self.contains(number) == is_passive {
                continue;
            }
            let handle = shapes.entity2collider().get(link).copied();
            if let Some(shape) = handle.and_then(|handle| shapes.colliders.get_mut(handle)) {
                shape.set_enabled(!is_passive);
            }
        }
        *self = to;
    }

    /// True for a link that is far from every free object.
    pub fn is_far(&self, link: usize) -> bool {
        self.far.get(link).copied().unwrap_or(false)
    }

    fn contains(&self, link: usize) -> bool {
        self.is_far(link) || self.inside.get(link).copied().unwrap_or(false)
    }
}
