//! Who has a say in what a robot is sent.

use crate::{state::RobotState, target::RobotTarget};

/// Looks at each target before a robot gets it, for instance a simulation beside it that knows the table.
///
/// It is asked on the program's thread. One that takes too long makes the program late, which stops the robot.
pub trait Guard: Send + Sync {
    /// Why the robot must not get a target; none if it may.
    ///
    /// A target is followed for up to [`OLDEST_TARGET`](crate::OLDEST_TARGET) until the next one, and joints may then turn on for
    /// [`RAMP`](crate::RAMP); the state is that of a moment ago. A veto makes the joints rest until a target passes.
    fn veto(&mut self, state: &RobotState, target: &RobotTarget) -> Option<String>;
}
