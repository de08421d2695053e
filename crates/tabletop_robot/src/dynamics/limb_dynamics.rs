//! An arm as masses that motors move.
//!
//! Everything is in m, kg, s, rad and N m, one number for every joint. A step is implicit: all torques are those at its end,
//! so that stiff motors are stable in steps of any length. What acts on a joint never grows with the joint's speed: motors pull
//! less and less, up to their limits, and what is pushed and stops push back more and more. So there is exactly one answer, the
//! minimum of a convex function, and Newton's method finds it from anywhere if it never goes too far.

#[cfg(test)]
mod tests;

use crate::dynamics::{
    impulse::{ContactLoad, FrictionLoad},
    matrix::{Factors, Joints, Matrix, dot, each},
    motor::Motor,
};

/// An arm at a moment, and what acts on it besides its motors.
#[derive(Clone, Debug)]
pub(crate) struct LimbDynamics {
    /// Where the joints are, in rad.
    pub angles: Joints,
    /// How fast they are, in rad/s.
    pub velocities: Joints,
    /// What they have to move, in kg m².
    pub inertia: Matrix,
    /// The torque in N m that it takes not to be accelerated: against weights and what turns with the arm.
    pub bias: Joints,
    /// Torque against the motion of each joint, in N m per rad/s.
    pub damping: Joints,
    /// Between which angles each joint can move, in rad.
    pub stops: Vec<[f64; 2]>,
    /// What the arm touches that is free to move.
    pub touches: Vec<ContactLoad>,
}

/// What a step makes of an arm.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct DynamicsStep {
    /// How fast the joints are at its end and move in it, in rad/s.
    pub velocities: Joints,
    /// Torques of the motors, in N m.
    pub torques: Joints,
}

/// What stops push back with, in N m s per rad/s beyond what is left of the way.
const WALL: f64 = 1e6;

/// Most rounds of Newton's method; a few are usual.
const MOST_NEWTON_STEPS: usize = 60;

/// Angular momentum in N m s that may be unaccounted for.
const NEGLIGIBLE: f64 = 1e-9;

/// Halvings of a way of Newton's method that goes too far.
const HALVINGS: usize = 30;

impl LimbDynamics {
    /// What `seconds` make of the arm.
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

    /// What can be drawn along by friction when the arm pushes as hard as it does with these velocities.
    fn draws(&self, velocities: &Joints) -> Vec<FrictionLoad<'_>> {
        let touches = self.touches.iter();
        touches.flat_map(|touch| touch.draws(velocities)).collect()
    }

    /// The velocities at the end of a step, looked for from these on.
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

    /// The angular momentum in N m s that would come from nowhere if the joints had these velocities at the end of a step.
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

    /// How that changes with the velocities.
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

    /// Velocities in rad/s between which a joint does not go beyond its stops.
    fn bounds(&self, joint: usize, seconds: f64) -> [f64; 2] {
        self.stops[joint].map(|stop| (stop - self.angles[joint]) / seconds)
    }
}

/// Goes from somewhere this way until it goes up again: the convex function whose slopes `residual` has goes down by
/// `-start` where the way starts.
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
