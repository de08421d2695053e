//! Forward kinematics: the poses of links, and the motions of their points.

use std::ops::Index;

use glam::{DAffine3, DVec3};

use crate::{DTwist, JointType, JointValues, LinkId, ModelJoint, ModelJointId, RobotModel};

/// The pose of every link of a model: from the link's frame to the root's, in m.
#[derive(Clone, Debug, Default)]
pub struct Frames(Vec<DAffine3>);

impl Index<LinkId> for Frames {
    type Output = DAffine3;

    fn index(&self, link: LinkId) -> &DAffine3 {
        &self.0[link.index()]
    }
}

/// The frames of a robot that moves: only those that a motion moves are computed again, and are the same to the bit.
#[derive(Clone, Debug)]
pub struct MovingFrames {
    configuration: JointValues,
    frames: Frames,
    moved: Vec<bool>,
}

impl MovingFrames {
    /// The frames in a configuration; all count as moved.
    pub fn new(model: &RobotModel, configuration: JointValues) -> Self {
        Self {
            frames: model.frames(&configuration),
            moved: vec![true; model.links.len()],
            configuration,
        }
    }

    /// Goes to another configuration of the same model.
    pub fn move_to(&mut self, model: &RobotModel, configuration: &JointValues) {
        self.moved.fill(false);
        for (i, joint) in model.joints.iter().enumerate() {
            let position = |configuration| model.position(ModelJointId(i), configuration);
            let moves = |joint: &ModelJoint| {
                joint.kind != JointType::Fixed
                    && position(&self.configuration).to_bits() != position(configuration).to_bits()
            };
            if self.moved[joint.parent.index()] || moves(joint) {
                let motion = joint.motion(position(configuration));
                self.frames.0[i + 1] = self.frames[joint.parent] * motion;
                self.moved[i + 1] = true;
            }
        }
        self.configuration.clone_from(configuration);
    }

    /// The frames.
    pub const fn frames(&self) -> &Frames {
        &self.frames
    }

    /// True if the last motion has moved a link.
    pub fn has_moved(&self, link: LinkId) -> bool {
        self.moved[link.index()]
    }
}

impl RobotModel {
    /// The poses of the links.
    ///
    /// ```
    /// let robot = tabletop_kinematics::baxter()?;
    /// let frames = robot.frames(&robot.zero());
    /// let hand = frames[robot.find_link("left_hand")?].translation;
    /// assert!((hand.z - 0.32098).abs() < 1e-5, "metres above the root");
    /// # Ok::<(), tabletop_kinematics::ModelError>(())
    /// ```
    pub fn frames(&self, configuration: &JointValues) -> Frames {
        let mut frames = Frames::default();
        self.frames_into(configuration, &mut frames);
        frames
    }

    /// The same into a buffer, which is only allocated the first time.
    pub fn frames_into(&self, configuration: &JointValues, frames: &mut Frames) {
        frames.0.clear();
        frames.0.push(DAffine3::IDENTITY);
        for (i, joint) in self.joints.iter().enumerate() {
            let motion = joint.motion(self.position(ModelJointId(i), configuration));
            frames.0.push(frames[joint.parent] * motion);
        }
    }

    /// The motion of a point of a link per motion of each joint: one twist for each of [`joints`](Self::joints), in the root's
    /// frame, 0 for those that do not move it. The point is given in the link's frame, in m.
    pub fn jacobian(&self, frames: &Frames, link: LinkId, point: DVec3) -> Vec<DTwist> {
        let mut jacobian = vec![DTwist::default(); self.joints.len()];
        let point = frames[link].transform_point3(point);
        for joint in self.carriers(link) {
            let (leader, multiplier) = self.leader(joint);
            let twist = &mut jacobian[leader.index()];
            let axis = self.axis_in_root(frames, joint) * multiplier;
            if self.joint(joint).kind.turns() {
                let origin = frames[self.joint(joint).child].translation;
                twist.linear += axis.cross(point - origin);
                twist.angular += axis;
            } else {
                twist.linear += axis;
            }
        }
        jacobian
    }

    /// The unit vector that a joint turns about or slides along, in the root's frame.
    pub(crate) fn axis_in_root(&self, frames: &Frames, joint: ModelJointId) -> DVec3 {
        let joint = self.joint(joint);
        frames[joint.child].transform_vector3(joint.axis)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::baxter;

    #[test]
    fn moving_frames_are_those_of_their_configuration() {
        let model = baxter().unwrap();
        let mut configuration = model.zero();
        let mut moving = MovingFrames::new(&model, configuration.clone());
        let joints = ["left_s0", "right_w2", "head_pan", "left_e1", "left_e1"];
        for (number, name) in joints.into_iter().enumerate() {
            configuration[model.find_joint(name).unwrap()] += 0.3 - 0.1 * number as f64;
            moving.move_to(&model, &configuration);
            assert_eq!(moving.frames().0, model.frames(&configuration).0, "{name}");
        }
        let [moved, stays] = ["left_hand", "right_hand"]
            .map(|link| moving.has_moved(model.find_link(link).unwrap()));
        assert!(moved && !stays);
    }
}
