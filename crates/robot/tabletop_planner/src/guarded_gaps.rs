//! The gaps that a guard of a real robot keeps.

/// How near a guard lets parts of a robot come, so that no way is planned on which it would stop the arm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GuardedGaps {
    /// The width of gaps between links and the table, and between parts of the robot, in units.
    pub links: f32,
    /// The width of gaps between fingers and the table, in units.
    pub fingers_above_table: f32,
}

impl GuardedGaps {
    /// Of a robot without a guard.
    pub const NONE: Self = Self {
        links: 0.0,
        fingers_above_table: 0.0,
    };
}
