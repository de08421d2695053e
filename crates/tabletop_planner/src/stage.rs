//! The stage on which the planner acts.

use tabletop_controller::{Angles, Drives, Sight};
use tabletop_core::{Drive, RobotLayout};

/// A world that advances tick by tick.
pub trait PlanningStage {
    /// The present sight.
    fn sight(&self) -> &Sight;

    /// Gives these orders, one for each limb, and advances by a tick.
    ///
    /// # Errors
    /// The robot is to stop.
    fn tick(&mut self, orders: &[LimbOrder]) -> Result<(), Stopped>;

    /// Looks at the table anew. Returns the ids of the objects that it does not see well enough; in the sight, these are where they were last
    /// seen. A stage that is told every pose has nothing to look at.
    fn look(&mut self) -> Vec<String> {
        Vec::new()
    }
}

/// The drives that carry out orders for the limbs of a robot.
pub fn drives(layout: &RobotLayout, orders: &[LimbOrder]) -> Drives {
    let mut drives = Drives::new();
    for (limb, order) in layout.limbs.iter().zip(orders) {
        let joints = limb.joints.iter().copied().zip(order.joints);
        let all = joints.chain([(limb.gripper.joint, order.opening)]);
        let moving = all.filter(|(_, velocity)| *velocity != 0.0);
        drives.extend(
            moving.map(|(joint, velocity)| (layout.joint(joint).name, Drive::Velocity(velocity))),
        );
    }
    drives
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
