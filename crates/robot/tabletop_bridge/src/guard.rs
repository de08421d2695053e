//! Who has a say in what a robot is sent.

use crate::{state::RobotState, watchdog::PredictedMotion};

/// Looks at each target before a robot gets it, for instance a model of its body that knows the table.
///
/// It is asked on the program's thread. One that takes too long makes the program late, which stops the robot.
pub trait Guard: Send + Sync {
    /// Why the robot must not move like this; none if it may.
    ///
    /// The motion begins where the robot was measured, and goes on until it rests, also if no other target follows. A veto makes the joints rest until a
    /// target passes.
    fn veto(&mut self, state: &RobotState, motion: &PredictedMotion) -> Option<String>;
}
