//! Guides: joints that fasten an object to another one, and leave it one motion.

use bevy::math::Vec3;
use tabletop_core::{JointKind, JointSpec};
use tabletop_geometry::{Pose, turn_about};

/// The joint by which another object guides one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Guide {
    /// The number of the other object.
    pub by: usize,
    /// The joint's frame in the frame of the other object, and of this one.
    frames: [Pose; 2],
    motion: GuidedMotion,
    /// The least and the greatest displacement: a length in units, or an angle in rad.
    range: [f32; 2],
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum GuidedMotion {
    /// Along -X of the joint's frame.
    Slide,
    /// About X of the joint's frame.
    Turn,
}

impl Guide {
    /// The guide that a joint is for its second object; the first one has this number. None if it leaves more than one motion.
    pub fn of(by: usize, joint: &JointSpec) -> Option<Self> {
        let (motion, range) = match joint.kind {
            JointKind::Slider { min, max, .. } => (GuidedMotion::Slide, [min, max]),
            JointKind::PushButton { travel, .. } => (GuidedMotion::Slide, [0.0, travel]),
            JointKind::Fixed => (GuidedMotion::Slide, [0.0; 2]),
            JointKind::Hinge { min, max, .. } | JointKind::Shears { min, max } => {
                (GuidedMotion::Turn, [min, max])
            }
            JointKind::Ball => return None,
        };
        Some(Self {
            by,
            frames: joint.frames,
            motion,
            range,
        })
    }

    /// The pose of the guided object at a displacement, where the other one has this pose.
    pub fn pose(&self, other: Pose, displacement: f32) -> Pose {
        let moved = match self.motion {
            GuidedMotion::Slide => Pose::at(Vec3::NEG_X * displacement),
            GuidedMotion::Turn => Pose::new(Vec3::ZERO, turn_about(Vec3::X, displacement)),
        };
        other * self.frames[0] * moved * self.frames[1].inverse()
    }

    /// The nearest displacement within the range.
    pub fn within(&self, displacement: f32) -> f32 {
        displacement.clamp(self.range[0], self.range[1].max(self.range[0]))
    }

    /// The displacement that moves an object of this radius by about a length.
    pub fn by_length(&self, length: f32, radius: f32) -> f32 {
        match self.motion {
            GuidedMotion::Slide => length,
            GuidedMotion::Turn => length / radius,
        }
    }

    /// Displacements from the least to the greatest, no farther apart than a step.
    pub fn displacements(&self, step: f32) -> impl Iterator<Item = f32> + use<> {
        let [least, greatest] = self.range;
        let count = ((greatest - least).max(0.0) / step).ceil() as u16;
        (0..=count).map(move |i| {
            let part = f32::from(i) / f32::from(count.max(1));
            least + (greatest - least) * part
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn joint(kind: JointKind) -> JointSpec {
        JointSpec {
            objects: ["box".to_owned(), "lid".to_owned()],
            frames: [
                Pose::from_degrees(Vec3::new(1.0, 0.0, 2.0), Vec3::new(0.0, 0.0, 30.0)),
                Pose::from_degrees(Vec3::new(0.0, 0.5, 0.0), Vec3::new(10.0, 0.0, 0.0)),
            ],
            kind,
            collides: false,
        }
    }

    #[test]
    fn a_lid_slides_against_x_of_the_joint_and_a_door_turns_about_it() {
        let slider = JointKind::Slider {
            min: -1.0,
            max: 3.0,
            friction: 0.0,
            damping: 0.0,
        };
        let hinge = JointKind::Hinge {
            min: -1.0,
            max: 3.0,
            damping: 0.0,
        };
        let other = Pose::from_degrees(Vec3::new(3.0, -2.0, 1.0), Vec3::new(20.0, 40.0, -70.0));
        let motions = [
            (slider, Vec3::NEG_X, Vec3::ZERO),
            (hinge, Vec3::ZERO, Vec3::X),
        ];
        for (kind, slid, turned) in motions {
            let joint = joint(kind);
            let guide = Guide::of(4, &joint).unwrap();
            assert_eq!(guide.by, 4);
            let displacements: Vec<_> = guide.displacements(0.3).collect();
            assert!(displacements.len() == 15 && displacements.is_sorted());
            assert_eq!([displacements[0], displacements[14]], [-1.0, 3.0]);
            let [own, others] = joint.frames;
            let moved = (other * own).inverse() * guide.pose(other, 0.7) * others;
            assert!(moved.location.distance(slid * 0.7) < 1e-5);
            assert!(moved.rotation.to_scaled_axis().distance(turned * 0.7) < 1e-5);
        }
    }

    #[test]
    fn a_ball_joint_guides_nothing() {
        assert_eq!(Guide::of(0, &joint(JointKind::Ball)), None);
    }
}
