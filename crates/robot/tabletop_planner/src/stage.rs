//! The stage on which the planner acts.

use tabletop_controller::{Angles, Drives, Sight};
use tabletop_core::{Drive, RobotLayout, TICK_SECONDS};

/// A world that advances tick by tick.
pub trait PlanningStage {
    /// The present sight.
    fn sight(&self) -> &Sight;

    /// Gives these orders, one for each limb, and advances by a tick.
    ///
    /// # Errors
    /// The robot is to stop.
    fn tick(&mut self, orders: &[LimbOrder]) -> Result<(), Stopped>;

    /// How the robot follows its orders.
    fn following(&self) -> Following {
        Following::EXACT
    }

    /// Looks at the table anew. Returns the ids of the objects that it does not see well enough; in the sight, these are where they were last
    /// seen. A stage that is told every pose has nothing to look at.
    fn look(&mut self) -> Vec<String> {
        Vec::new()
    }
}

/// How a robot follows its orders.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Following {
    /// Largest lag of a joint under way, in rad.
    pub under_way: f64,
    /// Largest distance of a joint from its target in the end, in rad.
    pub in_the_end: f64,
    /// Number of ticks after which fingers that have not moved are stopped by something.
    pub finger_patience: u32,
    /// True if an arm is told the positions of its joints rather than their velocities.
    pub by_position: bool,
}

impl Following {
    /// Of joints that are in the next tick where they were sent.
    pub const EXACT: Self = Self {
        under_way: 2e-3,
        in_the_end: 2e-3,
        finger_patience: 6,
        by_position: false,
    };

    /// Of a machine: its joints lag behind by some ticks, so a velocity that makes up for their lag would make them swing, and are never quite
    /// where they were sent; its fingers take a moment until they move.
    pub const MACHINE: Self = Self {
        under_way: 0.1,
        in_the_end: 0.01,
        finger_patience: 60,
        by_position: true,
    };

    /// The drives that carry out orders for the limbs of a robot.
    pub(crate) fn drives(
        &self,
        layout: &RobotLayout,
        sight: &Sight,
        orders: &[LimbOrder],
    ) -> Drives {
        let mut drives = drives(layout, orders);
        if self.by_position {
            let limbs = layout.limbs.iter().zip(&sight.limbs).zip(orders);
            for ((limb, seen), order) in limbs {
                if order.joints.iter().all(|velocity| *velocity == 0.0) {
                    continue;
                }
                let names = limb.joints.iter().map(|&joint| layout.joint(joint).name);
                let names: Vec<_> = names.collect();
                drives.retain(|(joint, _)| !names.contains(joint));
                let turns = seen.angles.into_iter().zip(order.joints);
                let positions = turns.map(|(angle, speed)| angle + speed * f64::from(TICK_SECONDS));
                drives.extend(names.into_iter().zip(positions.map(Drive::Position)));
            }
        }
        drives
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
