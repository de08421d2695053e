//! What the planner acts on.

use crate::{body::Angles, sight::Sight};

/// A world in which time passes tick by tick.
pub trait PlanningStage {
    /// What there is to see now.
    fn sight(&self) -> &Sight;

    /// Gives these orders, one for each limb, and lets a tick pass.
    ///
    /// # Errors
    /// The robot is to stop.
    fn tick(&mut self, orders: &[LimbOrder]) -> Result<(), Stopped>;
}

/// Nothing more is to be done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stopped;

/// How a limb is to move in a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LimbOrder {
    /// Velocities of its joints, in rad/s.
    pub joints: Angles,
    /// Velocity of its gripper's opening, in units/s.
    pub opening: f64,
}
