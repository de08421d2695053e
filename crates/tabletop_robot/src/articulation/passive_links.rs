//! Links that push nothing.

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;

/// The links that push nothing; true at the number of each. They go where the robot moves them, but the engine does not look for their
/// contacts.
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct PassiveLinks {
    /// The links that are far from everything they could push. They sleep: two dozen moving bodies would be most of the engine's step.
    far: Vec<bool>,
    /// The links that stand in an object, since the robot came or because something pressed the object against them. They would press it into
    /// the table, so they push nothing until they are out.
    pub inside: Vec<bool>,
    /// True in the tick in which the robot comes: what comes with it has no bodies yet.
    is_new: bool,
}

impl PassiveLinks {
    /// No links, or those that are far and those that are inside an object.
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

    /// All links of a robot that has just come, until it is seen which of them are inside something.
    pub fn of_newcomer(links: usize) -> Self {
        Self {
            is_new: links > 0,
            ..Self::new(Vec::new(), vec![true; links])
        }
    }

    /// The same a tick later, of a robot with so many links: without those that are inside nothing now, and with those that crush something.
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

    /// True if any link stands in an object.
    pub fn are_inside(&self) -> bool {
        !self.inside.is_empty()
    }

    /// Lets the engine look for the contacts of all other links, and no longer for those of these.
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

    /// True for a link that is far from everything it could push.
    pub fn is_far(&self, link: usize) -> bool {
        self.far.get(link).copied().unwrap_or(false)
    }

    fn contains(&self, link: usize) -> bool {
        self.is_far(link) || self.inside.get(link).copied().unwrap_or(false)
    }
}
