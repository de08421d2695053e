//! Inverse kinematics: the angles that bring an arm's tip to a target.
//!
//! Damped least squares: each step moves the joints so that the tip comes as close to its target as a linear model of the
//! arm allows, at the price of the joints' motion. The price falls with the distance (Sugihara 2011), so steps are careful
//! far away and exact in the end. A joint that would leave its limits goes to the limit and stays out of that step. The
//! freedom that a tip's six coordinates leave to seven joints pulls these back to where the search began, so that small motions
//! of a target are small motions of the joints.
//!
//! A search that gets stuck begins anew, from a fixed sequence of postures: the same question has the same answer.
//!
//! The crate `k` solves the same problem, but it has its own linear algebra (another version than ours), no limits inside the
//! step and no control of the seventh joint.

use glam::{DAffine3, DMat3, DQuat, DVec3};
use thiserror::Error;

use crate::{ArmChain, DTwist, MOST_ARM_JOINTS};

/// The goal of the tip of an arm, in the frame of the arm's base, in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// This location and rotation: a rigid motion from the tip's frame to the base's.
    Pose(DAffine3),
    /// This location, with any rotation.
    Point(DVec3),
}

/// The error of a tip against a target.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Miss {
    /// Distance in m.
    pub position: f64,
    /// Angle in rad; 0 if the target leaves the rotation free.
    pub rotation: f64,
}

/// No angles within the limits were found that bring the tip to the target.
#[derive(Clone, Debug, Error, PartialEq)]
#[error(
    "unreachable: the nearest posture found misses it by {:.3} mm and {:.3}°",
    miss.position * 1e3,
    miss.rotation.to_degrees()
)]
pub struct Unreachable {
    /// The angles that come nearest, in rad (m), a rad counting as much as 0.3 m.
    pub best: Vec<f64>,
    /// Their error against the target.
    pub miss: Miss,
}

/// The error, in m and rad, below which a target counts as reached.
const TOLERANCE: Miss = Miss {
    position: 1e-6,
    rotation: 1e-6,
};

/// The same for an arm that cannot have every pose: those that it can have are written with seven digits, and it cannot make up for the rest.
const ROUNDED: Miss = Miss {
    position: 1e-5,
    rotation: 1e-4,
};

/// The weight of a rotation of the tip against its distance.
const METERS_PER_RAD: f64 = 0.3;
/// Least squared damping, in m²: far below the squared way of an arm per rad in a usual posture.
const LEAST_DAMPING: f64 = 1e-7;
/// Squared damping per squared miss.
const DAMPING: f64 = 0.1;
/// Largest turn (slide) of a joint in a step, in rad (m).
const LONGEST_STEP: f64 = 0.7;
/// The part of the way back to the start that the free motion goes in a step.
const PULL: f64 = 0.5;
/// The pull ends after this many steps; then only the target counts.
const PULLED_STEPS: usize = 12;
/// Steps of a search.
const STEPS: usize = 100;
/// Number of steps in which a search may come no nearer. The search from the seed has no such limit, because its answer is wanted most.
const PATIENCE: usize = 10;
/// Postures that the search begins from.
const STARTS: usize = 256;

impl ArmChain {
    /// Angles within the limits that bring the tip to the target, to 1 µm and 1 µrad, with fewer than six joints to 10 µm and 0.1 mrad; of several
    /// solutions, one near the seed.
    ///
    /// # Errors
    ///
    /// No angles were found: the target is out of reach, or not a number.
    pub fn solve(&self, target: &Target, seed: &[f64]) -> Result<Vec<f64>, Unreachable> {
        self.solve_from(target, seed, STARTS)
    }

    /// The same, but the search begins from the seed and at most `starts` postures, one after the other. With fewer postures, a target out of
    /// reach is refused sooner.
    ///
    /// # Errors
    /// No angles were found.
    pub fn solve_from(
        &self,
        target: &Target,
        seed: &[f64],
        starts: usize,
    ) -> Result<Vec<f64>, Unreachable> {
        let mut nearest = (f64::INFINITY, self.clamp(seed));
        for search in 0..starts.clamp(1, STARTS) {
            let (cost, angles) = match search {
                0 => self.search(target, nearest.1.clone(), STEPS),
                _ => self.search(target, self.posture(search), PATIENCE),
            };
            if self.miss(target, &angles).is_within(self.tolerance()) {
                return Ok(angles);
            }
            if cost < nearest.0 {
                nearest = (cost, angles);
            }
        }
        Err(Unreachable {
            miss: self.miss(target, &nearest.1),
            best: nearest.1,
        })
    }

    /// False if it has fewer than six joints, and so cannot turn its tip any way at the places that it reaches.
    pub const fn has_every_rotation(&self) -> bool {
        self.joints().len() >= ROWS
    }

    const fn tolerance(&self) -> &'static Miss {
        match self.has_every_rotation() {
            true => &TOLERANCE,
            false => &ROUNDED,
        }
    }

    /// The error of the tip against the target at these angles.
    pub fn miss(&self, target: &Target, angles: &[f64]) -> Miss {
        Miss::of(&target.residual(&self.tip(angles)))
    }

    /// Gauss–Newton steps downhill from a posture: returns the nearest one on the way, and its cost in m². The search ends when the cost has not
    /// fallen by a fifth in `patience` steps.
    fn search(&self, target: &Target, start: Vec<f64>, patience: usize) -> (f64, Vec<f64>) {
        let mut angles = start.clone();
        let mut nearest = (f64::INFINITY, start.clone());
        let mut steps_left = patience;
        for step in 0..STEPS {
            let (tip, jacobian) = self.tip_and_jacobian(&angles);
            let residual = target.residual(&tip);
            let cost = residual.linear.length_squared()
                + residual.angular.length_squared() * METERS_PER_RAD.powi(2);
            steps_left = match cost < 0.8 * nearest.0 {
                true => patience,
                false => steps_left - 1,
            };
            if cost < nearest.0 {
                nearest = (cost, angles.clone());
            }
            if steps_left == 0 || Miss::of(&residual).is_within(&TOLERANCE) {
                break;
            }
            let pull = match step < PULLED_STEPS {
                true => (0..angles.len())
                    .map(|i| PULL * (start[i] - angles[i]))
                    .collect(),
                false => vec![0.0; angles.len()],
            };
            let turns_count = matches!(target, Target::Pose(_));
            let equations = NormalEquations::new(&residual, &jacobian, cost, turns_count);
            let newton_step = self.newton_step(&equations, &angles, pull);
            let longest = newton_step.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
            let length = (LONGEST_STEP / longest).min(1.0);
            for (angle, step) in angles.iter_mut().zip(newton_step) {
                *angle += length * step;
            }
            angles = self.clamp(&angles);
        }
        nearest
    }

    /// A Gauss–Newton step that takes no joint beyond its limits: a joint that would leave them goes to the limit, and the others
    /// are solved for again.
    fn newton_step(&self, equations: &NormalEquations, angles: &[f64], pull: Vec<f64>) -> Vec<f64> {
        let mut bias = pull;
        let mut is_free = vec![true; angles.len()];
        loop {
            let step = equations.solve(&bias, &is_free);
            let mut is_within = true;
            for i in 0..angles.len() {
                let end = angles[i] + step[i];
                let [least, largest] = self.limits()[i];
                if is_free[i] && !(least..=largest).contains(&end) {
                    is_free[i] = false;
                    bias[i] = end.max(least).min(largest) - angles[i];
                    is_within = false;
                }
            }
            if is_within {
                return step;
            }
        }
    }

    /// The postures that searches begin from: the middle of the limits, then all over them (a Halton sequence).
    fn posture(&self, index: usize) -> Vec<f64> {
        const PRIMES: [usize; MOST_ARM_JOINTS] =
            [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53];
        let limits = self.limits().iter().zip(PRIMES);
        limits
            .map(|(limits, prime)| {
                let [least, largest] = limits.map(|limit| limit.clamp(-3.2, 3.2));
                let share = match index {
                    1 => 0.5,
                    _ => halton(index, prime),
                };
                least + share * (largest - least)
            })
            .collect()
    }
}

impl Target {
    /// The motion from the tip to the target, as velocities for 1 s.
    fn residual(&self, tip: &DAffine3) -> DTwist {
        match self {
            Self::Pose(pose) => DTwist {
                linear: pose.translation - tip.translation,
                angular: rotation_vector(pose.matrix3 * tip.matrix3.transpose()),
            },
            Self::Point(point) => DTwist {
                linear: *point - tip.translation,
                angular: DVec3::ZERO,
            },
        }
    }
}

impl Miss {
    fn of(residual: &DTwist) -> Self {
        Self {
            position: residual.linear.length(),
            rotation: residual.angular.length(),
        }
    }

    fn is_within(&self, tolerance: &Self) -> bool {
        self.position < tolerance.position && self.rotation < tolerance.rotation
    }
}

/// Axis times angle of a rotation, the short way round.
fn rotation_vector(rotation: DMat3) -> DVec3 {
    let rotation = DQuat::from_mat3(&rotation);
    let rotation = if rotation.w < 0.0 {
        -rotation
    } else {
        rotation
    };
    let (sine, cosine) = (rotation.xyz().length(), rotation.w);
    match sine > 1e-12 {
        true => rotation.xyz() * (2.0 * libm::atan2(sine, cosine) / sine),
        false => 2.0 * rotation.xyz(),
    }
}

/// The number whose digits to a base are those of the index, mirrored at the point.
fn halton(mut index: usize, base: usize) -> f64 {
    let (mut share, mut number) = (1.0, 0.0);
    while index > 0 {
        share /= base as f64;
        number += share * (index % base) as f64;
        index /= base;
    }
    number
}

/// Coordinates of a tip.
const ROWS: usize = 6;

/// The damped normal equations of a Gauss–Newton step, `(J Jᵀ + damping) y = residual`, in weighted coordinates of the tip.
struct NormalEquations {
    /// The columns of `J`, by joint.
    jacobian: Vec<[f64; ROWS]>,
    residual: [f64; ROWS],
    damping: f64,
}

impl NormalEquations {
    fn new(residual: &DTwist, jacobian: &[DTwist], cost: f64, turns_count: bool) -> Self {
        let weight = if turns_count { METERS_PER_RAD } else { 0.0 };
        let row = |twist: &DTwist| {
            let (v, w) = (twist.linear, twist.angular * weight);
            [v.x, v.y, v.z, w.x, w.y, w.z]
        };
        Self {
            jacobian: jacobian.iter().map(row).collect(),
            residual: row(residual),
            damping: DAMPING * cost + LEAST_DAMPING,
        }
    }

    /// The step of the joints. Joints that are not free move by their bias. The others move so that the residual vanishes, and by their
    /// bias as far as this leaves them free.
    fn solve(&self, bias: &[f64], is_free: &[bool]) -> Vec<f64> {
        let mut matrix = [[0.0; ROWS]; ROWS];
        let mut rest = self.residual;
        for (j, column) in self.jacobian.iter().enumerate() {
            for row in 0..ROWS {
                rest[row] -= column[row] * bias[j];
                if is_free[j] {
                    for other in 0..=row {
                        matrix[row][other] += column[row] * column[other];
                    }
                }
            }
        }
        for (i, row) in matrix.iter_mut().enumerate() {
            row[i] += self.damping;
        }
        let multipliers = solve_symmetric(matrix, rest);
        let columns = self.jacobian.iter().enumerate();
        columns
            .map(|(j, column)| {
                let along: f64 = column.iter().zip(&multipliers).map(|(a, b)| a * b).sum();
                bias[j] + if is_free[j] { along } else { 0.0 }
            })
            .collect()
    }
}

/// Solves a symmetric, positive definite system, of which the lower half is given (Cholesky).
fn solve_symmetric(mut matrix: [[f64; ROWS]; ROWS], mut right: [f64; ROWS]) -> [f64; ROWS] {
    for i in 0..ROWS {
        for j in 0..=i {
            let known: f64 = (0..j).map(|k| matrix[i][k] * matrix[j][k]).sum();
            let value = matrix[i][j] - known;
            matrix[i][j] = match i == j {
                true => value.max(f64::MIN_POSITIVE).sqrt(),
                false => value / matrix[j][j],
            };
        }
    }
    for i in 0..ROWS {
        let known: f64 = (0..i).map(|k| matrix[i][k] * right[k]).sum();
        right[i] = (right[i] - known) / matrix[i][i];
    }
    for i in (0..ROWS).rev() {
        let known: f64 = (i + 1..ROWS).map(|k| matrix[k][i] * right[k]).sum();
        right[i] = (right[i] - known) / matrix[i][i];
    }
    right
}
