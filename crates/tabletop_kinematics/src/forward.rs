//! Forward kinematics: where the links are, and how their points move.

use std::ops::Index;

use glam::{DAffine3, DVec3};

use crate::{DTwist, JointValues, LinkId, ModelJointId, RobotModel};

/// The pose of every link of a model: from the link's frame to the root's, in m.
#[derive(Clone, Debug, Default)]
pub struct Frames(Vec<DAffine3>);

impl Index<LinkId> for Frames {
    type Output = DAffine3;

    fn index(&self, link: LinkId) -> &DAffine3 {
        &self.0[link.index()]
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
