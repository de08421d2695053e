//! The stage on which the planner acts.

use crate::{body::Angles, sight::Sight};

/// A world that advances tick by tick.
pub trait PlanningStage {
    /// The present sight.
    fn sight(&self) -> &Sight;

    /// Gives these orders, one for each limb, and advances by a tick.
    ///
    /// # Errors
    /// The robot is to stop.
    fn tick(&mut self, orders: &[LimbOrder]) -> Result<(), Stopped>;
}

/// The request to do nothing more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stopped;

/// The motion of a limb in one tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LimbOrder {
    /// Velocities of its joints, in rad/s.
    pub joints: Angles,
    /// Velocity of its gripper's opening, in units/s.
    pub opening: f64,
}
