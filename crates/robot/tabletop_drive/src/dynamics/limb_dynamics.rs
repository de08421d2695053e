//! Dynamics of a limb: masses that motors move.
//!
//! Everything is in m, kg, s, rad and N m, one number for every joint. A step is implicit: all torques are those at its end,
//! so stiff motors are stable in steps of any length. The torque on a joint never grows with the joint's speed: motors pull
//! less and less, down to their limits, and pushed objects and stops push back more and more. So there is exactly one solution, the
//! minimum of a convex function, and Newton's method with a line search finds it from any start.

#[cfg(test)]
mod tests;

use crate::dynamics::{
    impulse::{ContactLoad, FrictionLoad},
    matrix::{Factors, Joints, Matrix, dot, each},
    motor::Motor,
};

/// The state of an arm, and the loads on it besides its motors.
#[derive(Clone, Debug)]
pub(crate) struct LimbDynamics {
    /// Angles of the joints, in rad.
    pub angles: Joints,
    /// Velocities of the joints, in rad/s.
    pub velocities: Joints,
    /// Inertia matrix of the joints, in kg m².
    pub inertia: Matrix,
    /// The torque, in N m, that keeps the joints from accelerating: against weights and the effects of rotation.
    pub bias: Joints,
    /// Torque against the motion of each joint, in N m per rad/s.
    pub damping: Joints,
    /// Limits of each joint, in rad.
    pub stops: Vec<[f64; 2]>,
    /// The free objects that the arm touches.
    pub touches: Vec<ContactLoad>,
}

/// The result of a step.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct DynamicsStep {
    /// Velocities of the joints in the step and at its end, in rad/s.
    pub velocities: Joints,
    /// Torques of the motors, in N m.
    pub torques: Joints,
}

/// Stiffness of a stop, in N m s per rad/s beyond the rest of the way.
const WALL: f64 = 1e6;

/// Largest number of Newton steps; a few are usual.
const MOST_NEWTON_STEPS: usize = 60;

/// Largest residual that counts as zero, in N m s.
const NEGLIGIBLE: f64 = 1e-9;

/// Largest number of halvings in a line search.
const HALVINGS: usize = 30;

impl LimbDynamics {
    /// The step of the arm through `seconds`.
    pub fn step(&self, motors: &[Motor], seconds: f64) -> DynamicsStep {
        let smooth = self.minimum(motors, self.velocities.clone(), &[], seconds);
        let draws = self.draws(&smooth);
        let velocities = match draws.is_empty() {
            true => smooth,
            false => self.minimum(motors, smooth, &draws, seconds),
        };
        let velocities = each(motors.len(), |i| {
            let [least, largest] = self.bounds(i, seconds);
            let speed = motors[i].speed;
            let velocity = if velocities[i].is_finite() {
                velocities[i]
            } else {
                0.0
            };
            velocity.clamp(-speed, speed).min(largest).max(least)
        });
        DynamicsStep {
            torques: each(motors.len(), |i| {
                motors[i].torque(self.angles[i] + seconds * velocities[i], velocities[i])
            }),
            velocities,
        }
    }

    /// The loads of friction when the arm pushes as hard as it does with these velocities.
    fn draws(&self, velocities: &Joints) -> Vec<FrictionLoad<'_>> {
        let touches = self.touches.iter();
        touches.flat_map(|touch| touch.draws(velocities)).collect()
    }

    /// The velocities at the end of a step, by Newton's method from these.
    fn minimum(
        &self,
        motors: &[Motor],
        from: Joints,
        draws: &[FrictionLoad],
        seconds: f64,
    ) -> Joints {
        let residual = |velocities: &Joints| self.residual(motors, velocities, draws, seconds);
        let mut velocities = from;
        for _ in 0..MOST_NEWTON_STEPS {
            let start = residual(&velocities);
            if start.iter().all(|residual| residual.abs() < NEGLIGIBLE) {
                break;
            }
            let slope = self.hessian(motors, &velocities, draws, seconds);
            let way = Factors::of(&slope).solve(start.iter().map(|residual| -residual).collect());
            let next = line_search(&velocities, &way, dot(&start, &way), residual);
            if next == velocities {
                break;
            }
            velocities = next;
        }
        velocities
    }

    /// The residual: the angular momentum, in N m s, that would come from nowhere if the joints had these velocities at the end of a step.
    fn residual(
        &self,
        motors: &[Motor],
        velocities: &Joints,
        draws: &[FrictionLoad],
        seconds: f64,
    ) -> Joints {
        let change = each(velocities.len(), |i| velocities[i] - self.velocities[i]);
        let mut pushed = each(velocities.len(), |_| 0.0);
        let pushes = self.touches.iter().map(|touch| {
            let push = touch.push(dot(&touch.lever, velocities));
            (push, &touch.lever)
        });
        let drawn = draws.iter().map(|draw| {
            let lever = &draw.slide.lever;
            (draw.push(dot(lever, velocities)), lever)
        });
        for (push, lever) in pushes.chain(drawn) {
            for (pushed, lever) in pushed.iter_mut().zip(lever) {
                *pushed += push * lever;
            }
        }
        each(velocities.len(), |i| {
            let velocity = velocities[i];
            let [least, largest] = self.bounds(i, seconds);
            let motor = motors[i].torque(self.angles[i] + seconds * velocity, velocity);
            dot(&self.inertia[i], &change)
                + seconds * (self.bias[i] + self.damping[i] * velocity - motor)
                + WALL * (velocity - velocity.min(largest).max(least))
                + pushed[i]
        })
    }

    /// The Hessian: the derivative of the residual by the velocities.
    fn hessian(
        &self,
        motors: &[Motor],
        velocities: &Joints,
        draws: &[FrictionLoad],
        seconds: f64,
    ) -> Matrix {
        let mut slope = self.inertia.clone();
        let pushed = self.touches.iter().map(|touch| {
            let mass = touch.felt_mass(dot(&touch.lever, velocities));
            (mass, &touch.lever)
        });
        let drawn = draws.iter().map(|draw| {
            let lever = &draw.slide.lever;
            (draw.felt_mass(dot(lever, velocities)), lever)
        });
        for (mass, lever) in pushed.chain(drawn) {
            for (row, a) in slope.iter_mut().zip(lever) {
                for (entry, b) in row.iter_mut().zip(lever) {
                    *entry += mass * a * b;
                }
            }
        }
        for (i, motor) in motors.iter().enumerate() {
            let velocity = velocities[i];
            let [least, largest] = self.bounds(i, seconds);
            let yields = motor.slope(self.angles[i] + seconds * velocity, velocity, seconds);
            slope[i][i] += seconds * (self.damping[i] + yields);
            if velocity > largest || velocity < least {
                slope[i][i] += WALL;
            }
        }
        slope
    }

    /// Velocities, in rad/s, between which a joint stays within its stops.
    fn bounds(&self, joint: usize, seconds: f64) -> [f64; 2] {
        self.stops[joint].map(|stop| (stop - self.angles[joint]) / seconds)
    }
}

/// The line search: goes in this direction until the convex function with the gradient `residual` rises again. At the start it
/// falls with the slope `-start`.
fn line_search(
    from: &Joints,
    way: &Joints,
    start: f64,
    residual: impl Fn(&Joints) -> Joints,
) -> Joints {
    let at = |part: f64| each(from.len(), |i| from[i] + part * way[i]);
    let slope = |part: f64| dot(&residual(&at(part)), way);
    let enough = 0.1 * start.abs();
    if slope(1.0) <= enough {
        return at(1.0);
    }
    let (mut least, mut most) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = f64::midpoint(least, most);
        let slope = slope(middle);
        if slope.abs() <= enough {
            return at(middle);
        }
        if slope > 0.0 {
            most = middle;
        } else {
            least = middle;
        }
    }
    at(least)
}
