//! Ids of links and joints.

/// A link of a [`RobotModel`](crate::RobotModel), by its place in [`RobotModel::links`](crate::RobotModel::links). It belongs to the model that it is from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct LinkId(pub(crate) usize);

impl LinkId {
    /// Its place in [`RobotModel::links`](crate::RobotModel::links).
    pub const fn index(self) -> usize {
        self.0
    }
}

/// A joint of a [`RobotModel`](crate::RobotModel), by its place in [`RobotModel::joints`](crate::RobotModel::joints). It belongs to the model that it is from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ModelJointId(pub(crate) usize);

impl ModelJointId {
    /// Its place in [`RobotModel::joints`](crate::RobotModel::joints).
    pub const fn index(self) -> usize {
        self.0
    }
}
