//! The motor of a joint: its limits and its task.

/// Angle between a joint and its target, in rad, at which the motor pulls with its full torque: 0.57°.
///
/// So a motor holds any load that it can bear within this angle, whether the weight is known or not.
pub(crate) const STRETCH: f64 = 0.01;

/// Time, in s, in which an unhindered joint covers two thirds of the way to its target.
const SETTLING: f64 = 0.04;

/// Speed, in rad/s, above its limit at which a motor brakes with its full torque.
const SLIP: f64 = 1e-5;

/// A motor in a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Motor {
    /// Largest torque, in N m.
    pub effort: f64,
    /// Largest speed, in rad/s.
    pub speed: f64,
    /// Its task.
    pub task: MotorTask,
}

/// The task of a motor in a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum MotorTask {
    /// Bring the joint to an angle.
    Follow {
        /// Angle of the joint at the tick's end, in rad.
        angle: f64,
        /// Velocity of the joint then, in rad/s.
        velocity: f64,
        /// Known torque on the joint that the motor compensates, in N m.
        known: f64,
    },
    /// Pull with this torque, in N m.
    Torque(f64),
}

impl Motor {
    /// Its torque, in N m, at this angle (rad) and velocity (rad/s) of the joint.
    pub fn torque(&self, at: f64, velocity: f64) -> f64 {
        let [least, most] = self.limits(velocity);
        self.wish(at, velocity).clamp(least, most)
    }

    /// Decrease of its torque, in N m per rad/s, with the velocity that the joint has during a step and at its end.
    pub fn slope(&self, at: f64, velocity: f64, seconds: f64) -> f64 {
        let [least, most] = self.limits(velocity);
        let wish = self.wish(at, velocity);
        if wish > least && wish < most {
            let (stiffness, damping) = self.gains();
            damping + seconds * stiffness
        } else {
            let is_limit_steep = most.abs() < self.effort || least.abs() < self.effort;
            if is_limit_steep {
                2.0 * self.effort / SLIP
            } else {
                0.0
            }
        }
    }

    /// Its torque, in N m, if it had no limits.
    fn wish(&self, at: f64, is: f64) -> f64 {
        let (stiffness, damping) = self.gains();
        match self.task {
            MotorTask::Follow {
                angle,
                velocity,
                known,
            } => known + stiffness * (angle - at) + damping * (velocity - is),
            MotorTask::Torque(torque) => torque,
        }
    }

    /// Torque per rad of the joint's angle error, and per rad/s of its velocity error.
    fn gains(&self) -> (f64, f64) {
        match self.task {
            MotorTask::Follow { .. } => (self.effort / STRETCH, self.effort / STRETCH * SETTLING),
            MotorTask::Torque(_) => (0.0, 0.0),
        }
    }

    /// Least and largest torque at a velocity: at its largest speed, a motor can only brake.
    fn limits(&self, velocity: f64) -> [f64; 2] {
        let most = |velocity: f64| {
            let beyond = (velocity - self.speed) / SLIP;
            self.effort * (1.0 - 2.0 * beyond.clamp(0.0, 1.0))
        };
        [-most(-velocity), most(velocity)]
    }
}
