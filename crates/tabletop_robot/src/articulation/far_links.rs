//! Links that are far from everything they could push.

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;

/// The links that are far from everything they could push: true at the number of each. They go where the robot moves them, but the engine
/// does not look for their contacts: keeping the boxes of two dozen moving bodies in order would be most of its step.
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct FarLinks(Vec<bool>);

impl FarLinks {
    /// Whether these are the far links.
    pub fn are(&self, far: &[bool]) -> bool {
        (0..self.0.len().max(far.len())).all(|link| is_set(&self.0, link) == is_set(far, link))
    }

    /// Lets the engine look for the contacts of all links but these.
    pub fn set(&mut self, far: Vec<bool>, links: &[Entity], shapes: &mut RapierContextColliders) {
        for (link, entity) in links.iter().enumerate() {
            let is_far = is_set(&far, link);
            if is_set(&self.0, link) == is_far {
                continue;
            }
            let handle = shapes.entity2collider().get(entity).copied();
            if let Some(shape) = handle.and_then(|handle| shapes.colliders.get_mut(handle)) {
                shape.set_enabled(!is_far);
            }
        }
        self.0 = far;
    }
}

fn is_set(links: &[bool], link: usize) -> bool {
    links.get(link).copied().unwrap_or(false)
}
