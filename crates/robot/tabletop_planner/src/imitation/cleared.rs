//! Objects that were in the way.

use crate::sight::Arranged as _;
use tabletop_controller::Sight;
use tabletop_geometry::Pose;

/// An object that was in the way, and how it stood.
pub(super) struct Cleared {
    pub id: String,
    pub pose: Pose,
    supports: Vec<String>,
}

impl Cleared {
    pub fn new(sight: &Sight, id: &str) -> Option<Self> {
        Some(Self {
            id: id.to_owned(),
            pose: sight.objects.get(id)?.pose,
            supports: owned(&sight.arrangement().supports(id)),
        })
    }

    /// True if it would stand there as it stood, and the place is free.
    pub fn fits(&self, sight: &Sight) -> bool {
        let there = sight.arrangement_with(&self.id, self.pose);
        owned(&there.supports(&self.id)) == self.supports
            && sight.occupant(&self.id, self.pose, &[]).is_none()
    }
}

fn owned(ids: &[&str]) -> Vec<String> {
    ids.iter().map(|&id| id.to_owned()).collect()
}
