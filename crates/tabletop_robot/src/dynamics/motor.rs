//! The motor of a joint: what it can do, and what it tries to do.

/// How far a joint is from where it shall be, in rad, when its motor pulls with all its might: 0.57°.
///
/// So whatever a motor can hold at all, it holds within this angle, whether its weight is known or not.
pub(crate) const STRETCH: f64 = 0.01;

/// Time in s in which a joint that nothing hinders gets to where it shall be, but for a third.
const SETTLING: f64 = 0.04;

/// By how much, in rad/s, a motor is faster than it can be when it brakes with all its might.
const SLIP: f64 = 1e-5;

/// A motor in a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Motor {
    /// Largest torque, in N m.
    pub effort: f64,
    /// Largest speed, in rad/s.
    pub speed: f64,
    /// What it is to do.
    pub task: MotorTask,
}

/// What a motor is to do in a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum MotorTask {
    /// Bring its joint to a place.
    Follow {
        /// Where the joint shall be at the tick's end, in rad.
        angle: f64,
        /// How fast it shall be then, in rad/s.
        velocity: f64,
        /// What is known to pull at the joint, in N m the other way.
        known: f64,
    },
    /// Pull with this torque, in N m.
    Torque(f64),
}

impl Motor {
    /// The torque in N m that it has with its joint at this angle (rad) and velocity (rad/s).
    pub fn torque(&self, at: f64, velocity: f64) -> f64 {
        let [least, most] = self.limits(velocity);
        self.wish(at, velocity).clamp(least, most)
    }

    /// By how much its torque falls with the velocity that its joint has in a step and at its end, in N m per rad/s.
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

    /// The torque in N m that it would have without limits.
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

    /// Torque per rad that the joint is away from where it shall be, and per rad/s that it is too slow or too fast.
    fn gains(&self) -> (f64, f64) {
        match self.task {
            MotorTask::Follow { .. } => (self.effort / STRETCH, self.effort / STRETCH * SETTLING),
            MotorTask::Torque(_) => (0.0, 0.0),
        }
    }

    /// Least and largest torque at a velocity: at its largest speed, it can only brake.
    fn limits(&self, velocity: f64) -> [f64; 2] {
        let most = |velocity: f64| {
            let beyond = (velocity - self.speed) / SLIP;
            self.effort * (1.0 - 2.0 * beyond.clamp(0.0, 1.0))
        };
        [-most(-velocity), most(velocity)]
    }
}
