//! Two objects of a task file with a joint between them.

use bevy::prelude::*;
use serde::{Deserialize, Serialize};
use tabletop_geometry::Pose;

use crate::{Control, JointKind, ObjectSpec, PushButton, Shape};

/// Two objects of which the second slides or turns against the first (`<sliderJoint>`, `<hingeJoint>`, `<scissors>`,
/// `<pushButton>`). Displacements are in
/// units or degrees.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct JointedSpec {
    /// The joint's frame.
    pub pose: Pose,
    /// The objects. The first has its pose in the joint's frame, the second in the frame that moves with it.
    pub objects: [ObjectSpec; 2],
    /// The motion of the second object.
    pub motion: JointMotion,
    /// Its least and greatest displacement.
    pub limits: [f32; 2],
    /// Its displacement at first.
    pub init: f32,
    /// True if the two objects collide with each other.
    pub collides: bool,
    /// Share of the speed that the joint takes away in a tick, 0 to 1.
    pub damping: f32,
}

/// The motion that a joint leaves to its second object.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum JointMotion {
    /// It slides along -X of the joint.
    Slide,
    /// It turns about X of the joint.
    Turn,
    /// It turns about X of the joint, springs open, and cuts chain links.
    Shear,
    /// It is the cap of a push button, which slides along -Z of the joint and springs back.
    Press,
}

impl JointedSpec {
    /// The frame of the second object at a displacement, in the joint's frame.
    pub fn moved(&self, displacement: f32) -> Pose {
        match self.motion {
            JointMotion::Slide => Pose::at(Vec3::NEG_X * displacement),
            JointMotion::Press => Pose::at(Vec3::NEG_Z * displacement),
            JointMotion::Turn | JointMotion::Shear => {
                Pose::new(Vec3::ZERO, Quat::from_rotation_x(displacement.to_radians()))
            }
        }
    }

    /// The displacement that follows from the objects' poses in the world.
    pub fn displacement(&self, poses: [Pose; 2]) -> f32 {
        let [first, second] = [0, 1].map(|index| poses[index] * self.objects[index].pose.inverse());
        let moved = first.inverse() * second;
        let displacement = match self.motion {
            JointMotion::Slide => -moved.location.x,
            JointMotion::Press => -moved.location.z,
            JointMotion::Turn | JointMotion::Shear => {
                let angle = 2.0 * libm::atan2f(moved.rotation.x, moved.rotation.w).to_degrees();
                // The rotation and its negative turn to the same.
                angle - 360.0 * (angle / 360.0).round()
            }
        };
        displacement.clamp(self.limits[0], self.limits[1])
    }

    /// The objects with their poses in the world.
    pub fn placed(&self) -> [ObjectSpec; 2] {
        let frames = [self.pose, self.pose * self.moved(self.init)];
        [0, 1].map(|index| ObjectSpec {
            pose: frames[index] * self.objects[index].pose,
            ..self.objects[index].clone()
        })
    }

    /// The joint's frame in the frames of the objects.
    pub fn frames(&self) -> [Pose; 2] {
        let axes = match self.motion {
            JointMotion::Press => Pose::new(Vec3::ZERO, PushButton::UPWARDS),
            JointMotion::Slide | JointMotion::Turn | JointMotion::Shear => Pose::IDENTITY,
        };
        let frame = |object: &ObjectSpec| object.pose.inverse() * axes;
        self.objects.each_ref().map(frame)
    }

    /// The push button that the objects are, if they are one.
    pub fn push_button(&self) -> Option<(&Control, &PushButton)> {
        if let (JointMotion::Press, Shape::Control(control)) = (self.motion, &self.objects[1].shape)
        {
            return control.push_button().map(|button| (control, button));
        }
        None
    }

    /// The motion that the joint leaves free.
    pub fn kind(&self) -> JointKind {
        let [min, max] = self.limits;
        let damping = self.damping;
        match self.motion {
            JointMotion::Slide => JointKind::Slider {
                min,
                max,
                friction: 0.0,
                damping,
            },
            JointMotion::Turn => JointKind::Hinge {
                min: min.to_radians(),
                max: max.to_radians(),
                damping,
            },
            JointMotion::Shear => JointKind::Shears {
                min: min.to_radians(),
                max: max.to_radians(),
            },
            JointMotion::Press => JointKind::PushButton {
                travel: max,
                stiffness: self
                    .push_button()
                    .map_or(0.0, |(_, button)| button.stiffness()),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Shape;
    use tabletop_geometry::Rgb;

    fn jointed(motion: JointMotion, init: f32) -> JointedSpec {
        let object = |id: &str, x| {
            let color = Rgb::GRAY;
            let shape = Shape::Sphere { radius: 1.0, color };
            let pose = Pose::from_degrees(Vec3::X * x, Vec3::new(30.0, 20.0, 10.0));
            ObjectSpec::new(id, pose, 1.0, shape)
        };
        JointedSpec {
            pose: Pose::from_degrees(Vec3::new(1.0, 2.0, 3.0), Vec3::new(0.0, 0.0, 90.0)),
            objects: [object("a", 0.0), object("b", 0.5)],
            motion,
            limits: [-170.0, 170.0],
            init,
            collides: false,
            damping: 0.0,
        }
    }

    #[test]
    fn a_slider_moves_towards_minus_x() {
        let slider = jointed(JointMotion::Slide, 2.0);
        let [first, second] = slider.placed();
        assert!((first.pose.location - Vec3::new(1.0, 2.0, 3.0)).length() < 1e-6);
        assert!((second.pose.location - Vec3::new(1.0, 0.5, 3.0)).length() < 1e-6);
    }

    #[test]
    fn displacements_are_found_again() {
        for motion in [
            JointMotion::Slide,
            JointMotion::Turn,
            JointMotion::Shear,
            JointMotion::Press,
        ] {
            for init in [-160.0, -2.5, 0.0, 0.1, 90.0] {
                let jointed = jointed(motion, init);
                let found = jointed.displacement(jointed.placed().map(|object| object.pose));
                assert!((found - init).abs() < 1e-3, "{motion:?} {init}: {found}");
            }
        }
    }
}
