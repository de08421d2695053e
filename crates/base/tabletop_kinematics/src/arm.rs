//! An arm: the moving joints between two links.

use glam::{DAffine3, DVec3};

use crate::{
    JointType, JointValues, LinkId, ModelError, ModelJointId, RobotModel, turn::turn_about,
};

/// Most joints of an arm.
pub const MOST_ARM_JOINTS: usize = 16;

/// The motion of a body: the velocity of one of its points and its angular velocity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DTwist {
    /// Velocity of the point, in m/s, or in m per rad or m of a joint.
    pub linear: DVec3,
    /// In rad/s, or in rad per rad or m of a joint.
    pub angular: DVec3,
}

/// The joints that turn or slide from a base link to a tip link, compiled for speed: the fixed parts between them are merged.
///
/// Everything is in the base link's frame, in m and rad. Angles are in the order from the base to the tip; the angle of a joint that slides is
/// how far it is out, in m.
#[derive(Clone, Debug)]
pub struct ArmChain {
    joints: Vec<ModelJointId>,
    limits: Vec<[f64; 2]>,
    segments: Vec<Segment>,
    /// From the tip link's frame to that of the last joint's child.
    end: DAffine3,
}

/// A joint, with the rigid transform before it.
#[derive(Clone, Copy, Debug)]
struct Segment {
    /// From the joint's frame to that of the joint before it.
    origin: DAffine3,
    /// In the joint's frame.
    axis: DVec3,
    /// True if the joint turns about the axis, false if it slides along it.
    turns: bool,
}

impl ArmChain {
    /// The arm between two links of these names.
    ///
    /// ```
    /// use tabletop_kinematics::{ArmChain, baxter};
    ///
    /// let arm = ArmChain::between(&baxter()?, "torso", "right_end_effector")?;
    /// assert_eq!(arm.limits()[3], [-0.05, 2.618]);
    /// # Ok::<(), tabletop_kinematics::ModelError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// A link does not exist, or the joints between the links are not one to sixteen that move and follow no other joint.
    pub fn between(model: &RobotModel, base: &str, tip: &str) -> Result<Self, ModelError> {
        Self::new(model, model.find_link(base)?, model.find_link(tip)?)
    }

    /// The arm between two links.
    ///
    /// # Errors
    ///
    /// The joints between them are not one to sixteen that move and follow no other joint.
    pub fn new(model: &RobotModel, base: LinkId, tip: LinkId) -> Result<Self, ModelError> {
        let no_arm = |reason: String| ModelError::NoArm {
            base: model.link(base).name.clone(),
            tip: model.link(tip).name.clone(),
            reason,
        };
        let mut way = Vec::new();
        let mut link = tip;
        while link != base {
            let Some(joint) = model.link(link).joint else {
                return Err(no_arm("the tip does not hang on the base".to_owned()));
            };
            way.push(joint);
            link = model.joint(joint).parent;
        }

        let (mut joints, mut segments) = (Vec::new(), Vec::new());
        let mut rigid = DAffine3::IDENTITY;
        for id in way.into_iter().rev() {
            let joint = model.joint(id);
            rigid *= joint.origin;
            if joint.kind == JointType::Fixed {
                continue;
            }
            if let Some(mimic) = joint.mimic {
                return Err(no_arm(format!(
                    "joint {} does not move by itself: it mimics {}",
                    joint.name,
                    model.joint(mimic.leader).name
                )));
            }
            joints.push(id);
            segments.push(Segment {
                origin: std::mem::replace(&mut rigid, DAffine3::IDENTITY),
                axis: joint.axis,
                turns: joint.kind.turns(),
            });
        }
        if joints.is_empty() || joints.len() > MOST_ARM_JOINTS {
            let count = joints.len();
            return Err(no_arm(format!(
                "there are {count} joints instead of 1 to {MOST_ARM_JOINTS}"
            )));
        }
        Ok(Self {
            limits: joints
                .iter()
                .map(|&joint| model.joint(joint).limits)
                .collect(),
            joints,
            segments,
            end: rigid,
        })
    }

    /// The same arm with other limits: least and largest angle of each joint, in rad (m). Joints without new limits keep theirs.
    #[must_use]
    pub fn with_limits(mut self, limits: impl IntoIterator<Item = [f64; 2]>) -> Self {
        for (own, limits) in self.limits.iter_mut().zip(limits) {
            *own = limits;
        }
        self
    }

    /// The joints.
    pub const fn joints(&self) -> &[ModelJointId] {
        self.joints.as_slice()
    }

    /// Least and largest angle of each joint, in rad (m).
    pub fn limits(&self) -> &[[f64; 2]] {
        &self.limits
    }

    /// The angles of the arm in a configuration of the whole model.
    pub fn angles(&self, configuration: &JointValues) -> Vec<f64> {
        let joints = self.joints.iter();
        joints.map(|&joint| configuration[joint]).collect()
    }

    /// Writes the angles of the arm into a configuration of the whole model.
    pub fn set_angles(&self, angles: &[f64], configuration: &mut JointValues) {
        for (&joint, &angle) in self.joints.iter().zip(angles) {
            configuration[joint] = angle;
        }
    }

    /// The angles, moved within the limits.
    pub fn clamp(&self, angles: &[f64]) -> Vec<f64> {
        let angles = angles.iter().zip(&self.limits);
        angles
            .map(|(angle, [least, largest])| angle.max(*least).min(*largest))
            .collect()
    }

    /// The tip's pose: from its frame to the base's.
    pub fn tip(&self, angles: &[f64]) -> DAffine3 {
        let mut frame = DAffine3::IDENTITY;
        for (segment, &angle) in self.segments.iter().zip(angles) {
            frame = segment.moved(frame, angle);
        }
        frame * self.end
    }

    /// The frames behind each joint, from the base to the tip: those that the joints move.
    pub fn frames(&self, angles: &[f64]) -> impl Iterator<Item = DAffine3> {
        let segments = self.segments.iter().zip(angles);
        segments.scan(DAffine3::IDENTITY, |frame, (segment, &angle)| {
            *frame = segment.moved(*frame, angle);
            Some(*frame)
        })
    }

    /// True if a joint turns, false if it slides.
    pub fn turns(&self, joint: usize) -> bool {
        self.segments[joint].turns
    }

    /// The motion of the tip per rad (m) of each joint (the geometric Jacobian), in the base's frame.
    pub fn jacobian(&self, angles: &[f64]) -> Vec<DTwist> {
        self.tip_and_jacobian(angles).1
    }

    pub(crate) fn tip_and_jacobian(&self, angles: &[f64]) -> (DAffine3, Vec<DTwist>) {
        let mut frame = DAffine3::IDENTITY;
        let segments = self.segments.iter().zip(angles);
        let axes: Vec<_> = segments
            .map(|(segment, &angle)| {
                frame = segment.moved(frame, angle);
                (frame.translation, frame.matrix3 * segment.axis)
            })
            .collect();
        let tip = frame * self.end;
        let axes = self.segments.iter().zip(axes);
        let jacobian = axes.map(|(segment, (origin, axis))| match segment.turns {
            true => DTwist {
                linear: axis.cross(tip.translation - origin),
                angular: axis,
            },
            false => DTwist {
                linear: axis,
                angular: DVec3::ZERO,
            },
        });
        (tip, jacobian.collect())
    }
}

impl Segment {
    fn moved(&self, before: DAffine3, angle: f64) -> DAffine3 {
        let mut frame = before * self.origin;
        match self.turns {
            true => frame.matrix3 *= turn_about(self.axis, angle),
            false => frame.translation += frame.matrix3 * (self.axis * angle),
        }
        frame
    }
}
