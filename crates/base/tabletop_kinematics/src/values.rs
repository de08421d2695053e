//! One number for every joint of a model.

use std::ops::{Index, IndexMut};

use crate::ModelJointId;

/// One number for every joint of a [`RobotModel`](crate::RobotModel): positions, velocities, accelerations or torques.
///
/// Positions are radians for turning joints and metres for sliding ones, torques N m and N. The numbers of fixed joints and of
/// those that follow another one are ignored when read by the model, and 0 in its results. They belong
/// to the model that made them ([`RobotModel::zero`](crate::RobotModel::zero)).
///
/// ```
/// let robot = tabletop_kinematics::baxter()?;
/// let mut configuration = robot.zero();
/// configuration[robot.find_joint("left_s1")?] = -0.55;
/// # Ok::<(), tabletop_kinematics::ModelError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointValues(pub(crate) Vec<f64>);

impl JointValues {
    /// The numbers in the order of [`RobotModel::joints`](crate::RobotModel::joints).
    pub fn as_slice(&self) -> &[f64] {
        &self.0
    }
}

impl Index<ModelJointId> for JointValues {
    type Output = f64;

    fn index(&self, joint: ModelJointId) -> &f64 {
        &self.0[joint.index()]
    }
}

impl IndexMut<ModelJointId> for JointValues {
    fn index_mut(&mut self, joint: ModelJointId) -> &mut f64 {
        &mut self.0[joint.index()]
    }
}
