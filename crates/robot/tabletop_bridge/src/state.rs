//! What a robot says of itself.

mod gripper;
mod health;
mod jump;
mod reader;
mod sender_clock;

use std::{collections::BTreeMap, time::Duration};

pub use gripper::GripperReading;
pub use health::RobotHealth;
pub use jump::JointJump;
pub use reader::StateReader;

/// The newest that is known of a robot. Times are those of the bridge's clock.
#[derive(Clone, Debug, PartialEq)]
pub struct RobotState {
    /// The joints, by the profile's names for them.
    pub joints: BTreeMap<String, JointReading>,
    /// The moment for which all joints of the profile are known: of the one that was measured first, the arrival of its message, earlier by what the
    /// message was delayed beyond the quickest one.
    pub joints_at: Option<Duration>,
    /// Whether it is on.
    pub health: Option<RobotHealth>,
    /// When it last said so.
    pub health_at: Option<Duration>,
    /// The grippers, by the names of their limbs.
    pub grippers: BTreeMap<String, GripperReading>,
    /// Seconds of the robot's own time in one of the wall clock's: 1, or less in a simulator that is slow.
    pub pace: f64,
    /// A change of a joint's angle that no joint can make. Nothing that is measured can be believed after it.
    pub jump: Option<JointJump>,
    /// Messages that made no sense, such as angles that are no numbers. None of them is used.
    pub nonsense: u64,
}

/// A joint as it was measured.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointReading {
    /// Its angle, in rad.
    pub position: f64,
    /// Its speed, in rad/s, if it is measured.
    pub velocity: Option<f64>,
    /// Its torque, in N m, if it is measured.
    pub effort: Option<f64>,
}

impl Default for RobotState {
    fn default() -> Self {
        Self {
            joints: BTreeMap::new(),
            joints_at: None,
            health: None,
            health_at: None,
            grippers: BTreeMap::new(),
            pace: 1.0,
            jump: None,
            nonsense: 0,
        }
    }
}

impl RobotState {
    /// The age of the joints' angles; none if they were never known.
    pub fn age(&self, now: Duration) -> Option<Duration> {
        self.joints_at.map(|at| now.saturating_sub(at))
    }

    /// The age of what it said of its health; none if it never did.
    pub fn health_age(&self, now: Duration) -> Option<Duration> {
        self.health_at.map(|at| now.saturating_sub(at))
    }
}
