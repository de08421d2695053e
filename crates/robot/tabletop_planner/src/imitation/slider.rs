//! Parts that slide along a joint, such as lids.

use bevy::math::Vec3;
use tabletop_controller::Sight;
use tabletop_core::JointKind;

/// A part that slides along a joint.
pub(super) struct Slider<'s> {
    /// The object along which it slides.
    pub holder: &'s str,
    /// Direction in which it opens.
    way: Vec3,
    /// How far it is open, in units.
    opening: f32,
    /// How far it opens, in units.
    pub travel: f32,
}

impl<'s> Slider<'s> {
    /// An object as such a part, if it is one.
    pub fn of(sight: &'s Sight, id: &str) -> Option<Self> {
        sight.joints.iter().find_map(|joint| {
            let [holder, part] = &joint.objects;
            let JointKind::Slider { max: travel, .. } = joint.kind else {
                return None;
            };
            if part != id {
                return None;
            }
            let frame = sight.objects.get(holder)?.pose * joint.frames[0];
            let own = sight.objects.get(part)?.pose * joint.frames[1];
            Some(Self {
                holder,
                way: frame.rotation * Vec3::NEG_X,
                opening: -(frame.inverse() * own.location).x,
                travel,
            })
        })
    }

    /// The displacement after which it is open so far, in units.
    pub fn by(&self, opening: f32) -> Vec3 {
        self.way * (opening - self.opening)
    }
}
