//! An arm as masses that motors move.
//!
//! Everything is in m, kg, s, rad and N m, one number for every joint. A step is implicit: the motors' torques are those at
//! its end, so that stiff motors are stable in steps of any length. Motors have limits and joints have stops, so a step is
//! a search for what each joint does: whether its motor follows, pulls with all its might, or is as fast as it can be, or whether
//! the joint stands at its stop.

use std::array::from_fn;

use crate::{
    matrix::{Factors, Joints, Matrix, dot},
    motor::{Motor, Task},
};

/// An arm at a moment, and what acts on it besides its motors.
#[derive(Clone, Debug)]
pub(crate) struct Masses {
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
    pub stops: [[f64; 2]; 7],
    /// What the arm touches that is free to move.
    pub touches: Vec<Touch>,
}

/// Something free that an arm touches, as it is along the normal of the contact, which points to it. It is pushed without bouncing.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Touch {
    /// How fast the arm comes nearer to it per rad/s of each joint, in m.
    pub lever: Joints,
    /// Its mass in kg.
    pub mass: f64,
    /// How fast it goes away, in m/s, negative if it comes, at the end of the step if the arm were not there.
    pub speed: f64,
    /// The momentum in N s that friction and what is behind it can take from it in a step.
    pub resistance: f64,
}

/// What a step makes of an arm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Step {
    /// How fast the joints are at its end and move in it, in rad/s.
    pub velocities: Joints,
    /// Torques of the motors, in N m.
    pub torques: Joints,
}

/// What a joint does in a step. Later ones are stronger reasons.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
enum Doing {
    /// Its motor does what it wants to.
    Follows,
    /// Its motor has this torque, in N m.
    Pulls(f64),
    /// It has the largest speed of its motor, in rad/s.
    Races(f64),
    /// It meets its stop at the end of the step, with this velocity in rad/s until then.
    Stops(f64),
}

/// Rounds of the search in which joints may change their minds; after them they only turn to stronger reasons.
const FREE_ROUNDS: usize = 8;

/// Most rounds of the search: enough for each joint to go through all reasons.
const MOST_ROUNDS: usize = FREE_ROUNDS + 3 * 7;

/// Most rounds in which touches are weighed against each other.
const TOUCH_ROUNDS: usize = 20;

/// Differences that are none.
const NEGLIGIBLE: f64 = 1e-9;

impl Masses {
    /// What `seconds` make of the arm.
    pub fn step(&self, motors: &[Motor; 7], seconds: f64) -> Step {
        let mut doing = motors.map(|motor| match motor.task {
            Task::Follow { .. } => Doing::Follows,
            Task::Pull(_) => Doing::Pulls(motor.torque(0.0, 0.0)),
        });
        let (mut velocities, mut needed) = self.solve(motors, &doing, seconds);
        for round in 0..MOST_ROUNDS {
            let next: [Doing; 7] = from_fn(|i| {
                let next = self.judge(i, &motors[i], doing[i], velocities[i], needed[i], seconds);
                let is_weaker = rank(next) < rank(doing[i]);
                if round >= FREE_ROUNDS && is_weaker {
                    doing[i]
                } else {
                    next
                }
            });
            if next == doing {
                break;
            }
            doing = next;
            (velocities, needed) = self.solve(motors, &doing, seconds);
        }
        let torques = from_fn(|i| match doing[i] {
            Doing::Pulls(torque) => torque,
            Doing::Races(_) => needed[i].clamp(-motors[i].effort, motors[i].effort),
            Doing::Follows | Doing::Stops(_) => {
                motors[i].torque(self.angles[i] + seconds * velocities[i], velocities[i])
            }
        });
        Step {
            velocities,
            torques,
        }
    }

    /// What a joint does, given what it was thought to do and what follows from that.
    fn judge(
        &self,
        joint: usize,
        motor: &Motor,
        doing: Doing,
        velocity: f64,
        needed: f64,
        seconds: f64,
    ) -> Doing {
        let angle = self.angles[joint];
        let wish = motor.wish(angle + seconds * velocity, velocity);
        let has = wish.clamp(-motor.effort, motor.effort);
        let [least, largest] = self.stops[joint];
        let stays = match doing {
            // The stop pushes back, it does not pull.
            Doing::Stops(_) if angle + seconds * velocity > f64::midpoint(least, largest) => {
                has >= needed - NEGLIGIBLE
            }
            Doing::Stops(_) => has <= needed + NEGLIGIBLE,
            // The motor would make it faster still; what else does so, its gear takes.
            Doing::Races(velocity) => (has - needed) * velocity.signum() >= -NEGLIGIBLE,
            Doing::Follows | Doing::Pulls(_) => false,
        };
        if stays {
            return doing;
        }
        let slowed = velocity.clamp(-motor.speed, motor.speed);
        let ahead = angle + seconds * slowed;
        if ahead > largest + NEGLIGIBLE || ahead < least - NEGLIGIBLE {
            return Doing::Stops((ahead.clamp(least, largest) - angle) / seconds);
        }
        if velocity.abs() > motor.speed + NEGLIGIBLE {
            return Doing::Races(slowed);
        }
        match motor.task {
            Task::Follow { .. } if wish == has => Doing::Follows,
            _ => Doing::Pulls(has),
        }
    }

    /// The velocities at the end of the step if the joints do this, and the torques that it takes.
    fn solve(&self, motors: &[Motor; 7], doing: &[Doing; 7], seconds: f64) -> (Joints, Joints) {
        let mut matrix = self.inertia;
        let momenta: Joints = from_fn(|i| dot(&self.inertia[i], &self.velocities));
        let mut right: Joints = from_fn(|i| momenta[i] - seconds * self.bias[i]);
        for (i, motor) in motors.iter().enumerate() {
            matrix[i][i] += seconds * self.damping[i];
            match doing[i] {
                Doing::Follows => {
                    let (stiffness, damping) = motor.gains();
                    matrix[i][i] += seconds * (damping + seconds * stiffness);
                    right[i] += seconds * motor.wish(self.angles[i], 0.0);
                }
                Doing::Pulls(torque) => right[i] += seconds * torque,
                Doing::Races(_) | Doing::Stops(_) => {}
            }
        }
        let given = doing.map(|doing| match doing {
            Doing::Races(velocity) | Doing::Stops(velocity) => Some(velocity),
            Doing::Follows | Doing::Pulls(_) => None,
        });
        for (i, velocity) in given.into_iter().enumerate() {
            let Some(velocity) = velocity else { continue };
            for j in 0..7 {
                right[j] -= matrix[j][i] * velocity;
                (matrix[i][j], matrix[j][i]) = (0.0, 0.0);
            }
            matrix[i][i] = 1.0;
        }
        for (right, velocity) in right.iter_mut().zip(given) {
            *right = velocity.unwrap_or(*right);
        }
        let factors = Factors::of(&matrix);
        let mut velocities = factors.solve(right);
        let pushes = self.push(&factors, &given, &mut velocities);

        let needed = from_fn(|i| {
            let change: f64 = (0..7)
                .map(|j| self.inertia[i][j] * (velocities[j] - self.velocities[j]))
                .sum();
            let pushed: f64 = pushes.iter().zip(&self.touches).map(|(p, t)| p * t.lever[i]).sum();
            (change + pushed) / seconds + self.bias[i] + self.damping[i] * velocities[i]
        });
        (velocities, needed)
    }

    /// Lets what the arm touches have its part in the velocities. Returns with how much momentum (N s) it is pushed.
    fn push(&self, factors: &Factors, given: &[Option<f64>; 7], velocities: &mut Joints) -> Vec<f64> {
        let mut pushes = vec![0.0; self.touches.len()];
        // What a momentum of 1 N s changes.
        let changes: Vec<(Joints, f64)> = self
            .touches
            .iter()
            .map(|touch| {
                let felt = from_fn(|i| if given[i].is_some() { 0.0 } else { touch.lever[i] });
                let change = factors.solve(felt);
                (change, dot(&touch.lever, &change))
            })
            .collect();
        for _ in 0..TOUCH_ROUNDS {
            let mut largest_change = 0.0_f64;
            for ((touch, push), (change, yields)) in self.touches.iter().zip(&mut pushes).zip(&changes) {
                if *yields < NEGLIGIBLE {
                    continue;
                }
                let speed = dot(&touch.lever, velocities) + *push * yields;
                let next = touch.push(speed, 1.0 / yields);
                let more = next - *push;
                for (velocity, change) in velocities.iter_mut().zip(change) {
                    *velocity -= more * change;
                }
                *push = next;
                largest_change = largest_change.max(more.abs());
            }
            if largest_change < NEGLIGIBLE {
                break;
            }
        }
        pushes
    }
}

impl Touch {
    /// The momentum in N s with which an arm pushes it that would come with this speed (m/s) and mass (kg).
    fn push(&self, speed: f64, mass: f64) -> f64 {
        if speed <= self.speed {
            return 0.0;
        }
        let whole = mass + self.mass;
        let together = (mass * speed + self.mass * self.speed) / whole;
        // Friction slows both, and does not turn them round.
        let slowed = (together - self.resistance / whole).max(together.min(0.0));
        mass * (speed - slowed)
    }
}

const fn rank(doing: Doing) -> u8 {
    match doing {
        Doing::Follows => 0,
        Doing::Pulls(_) => 1,
        Doing::Races(_) => 2,
        Doing::Stops(_) => 3,
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use super::*;

    const SECONDS: f64 = 1.0 / 60.0;

    /// Joints that do not feel each other, each with this inertia in kg m².
    fn apart(inertia: f64) -> Masses {
        Masses {
            angles: [0.0; 7],
            velocities: [0.0; 7],
            inertia: from_fn(|i| from_fn(|j| if i == j { inertia } else { 0.0 })),
            bias: [0.0; 7],
            damping: [0.0; 7],
            stops: [[-10.0, 10.0]; 7],
            touches: Vec::new(),
        }
    }

    fn motors(task: Task) -> [Motor; 7] {
        [Motor {
            effort: 50.0,
            speed: 1.5,
            task,
        }; 7]
    }

    fn at(angle: f64) -> Task {
        Task::Follow {
            angle,
            velocity: 0.0,
            known: 0.0,
        }
    }

    fn go(masses: &mut Masses, motors: &[Motor; 7], seconds: f64) -> Step {
        let step = masses.step(motors, seconds);
        for (angle, velocity) in masses.angles.iter_mut().zip(step.velocities) {
            *angle += seconds * velocity;
        }
        masses.velocities = step.velocities;
        step
    }

    #[test]
    fn a_pendulum_swings_with_its_period() {
        // 2 kg at 0.4 m.
        let mut masses = apart(2.0 * 0.4 * 0.4);
        masses.angles = [0.1; 7];
        let mut crossings = Vec::new();
        for tick in 0..600 {
            let before = masses.angles[0];
            masses.bias = masses.angles.map(|angle| 2.0 * 9.81 * 0.4 * f64::sin(angle));
            go(&mut masses, &motors(Task::Pull(0.0)), SECONDS);
            if before > 0.0 && masses.angles[0] <= 0.0 {
                let part = before / (before - masses.angles[0]);
                crossings.push((f64::from(tick) + part) * SECONDS);
            }
        }
        let period = (crossings.last().unwrap() - crossings[0]) / (crossings.len() - 1) as f64;
        let expected = TAU * (0.4_f64 / 9.81).sqrt() * (1.0 + 0.1 * 0.1 / 16.0);
        assert!((period / expected - 1.0).abs() < 0.01, "{period} s instead of {expected} s");
        assert!(masses.angles[0].abs() < 0.11, "it does not gain energy");
    }

    #[test]
    fn damping_takes_speed_away() {
        let mut masses = apart(1.0);
        masses.damping = [0.7; 7];
        masses.velocities = [1.0; 7];
        for _ in 0..120 {
            go(&mut masses, &motors(Task::Pull(0.0)), SECONDS);
        }
        let expected = (-0.7 * 2.0_f64).exp();
        assert!((masses.velocities[3] / expected - 1.0).abs() < 0.02, "{:?}", masses.velocities);
    }

    #[test]
    fn a_torque_accelerates_coupled_joints_as_their_inertia_has_it() {
        let mut masses = apart(1.0);
        masses.inertia[0][1] = 0.5;
        masses.inertia[1][0] = 0.5;
        let mut motors = motors(Task::Pull(0.0));
        motors[0].task = Task::Pull(3.0);
        let step = masses.step(&motors, SECONDS);
        assert!((step.velocities[0] - 4.0 * SECONDS).abs() < 1e-12);
        assert!((step.velocities[1] + 2.0 * SECONDS).abs() < 1e-12);
        assert_eq!(step.torques[..2], [3.0, 0.0]);
    }

    #[test]
    fn a_joint_gets_to_its_place_and_stays_there() {
        for inertia in [1e-3, 0.05, 3.0] {
            let mut masses = apart(inertia);
            for _ in 0..120 {
                let step = go(&mut masses, &motors(at(0.005)), SECONDS);
                assert!(step.torques.iter().all(|torque| torque.abs() <= 50.0));
                assert!(masses.angles[0] < 0.0052, "{inertia}: {:?}", masses.angles);
            }
            assert!((masses.angles[0] - 0.005).abs() < 1e-6, "{inertia}: {:?}", masses.angles);
        }
    }

    #[test]
    fn a_weight_that_the_motor_does_not_know_stretches_it_by_its_share() {
        let mut masses = apart(2.0);
        masses.bias = [21.0; 7];
        for _ in 0..300 {
            go(&mut masses, &motors(at(0.0)), SECONDS);
        }
        let sag = masses.angles[0].to_degrees();
        assert!((sag + 0.24).abs() < 0.01, "{sag}°");
        let step = masses.step(&motors(at(0.0)), SECONDS);
        assert!((step.torques[0] - 21.0).abs() < 1e-6);
    }

    #[test]
    fn a_motor_has_no_more_than_its_torque_and_its_speed() {
        let mut masses = apart(1.0);
        let far = at(5.0);
        let step = go(&mut masses, &motors(far), SECONDS);
        assert!((step.velocities[0] - 50.0 * SECONDS).abs() < 1e-12);
        assert_eq!(step.torques[0], 50.0);
        for _ in 0..10 {
            let step = go(&mut masses, &motors(far), SECONDS);
            assert!(step.velocities[0] <= 1.5 + 1e-9, "{step:?}");
        }
        let step = go(&mut masses, &motors(far), SECONDS);
        assert_eq!(step.velocities[0], 1.5);
        assert!(step.torques[0].abs() < 1e-9, "nothing holds it up: {step:?}");
    }

    #[test]
    fn a_stop_takes_the_speed_and_lets_the_joint_go_back() {
        let mut masses = apart(1.0);
        masses.stops = [[-1.0, 0.01]; 7];
        masses.velocities = [1.2; 7];
        go(&mut masses, &motors(Task::Pull(4.0)), SECONDS);
        assert!((masses.angles[0] - 0.01).abs() < 1e-12);
        let step = go(&mut masses, &motors(Task::Pull(4.0)), SECONDS);
        assert_eq!(step.velocities[0], 0.0);
        let step = go(&mut masses, &motors(Task::Pull(-4.0)), SECONDS);
        assert!((step.velocities[0] + 4.0 * SECONDS).abs() < 1e-9);
    }

    #[test]
    fn a_light_thing_hardly_slows_the_arm_and_a_heavy_one_stalls_it() {
        let push = |mass: f64| {
            let mut masses = apart(1.0);
            masses.velocities = [0.5; 7];
            let mut lever = [0.0; 7];
            lever[0] = 0.5;
            masses.touches.push(Touch {
                lever,
                mass,
                speed: 0.0,
                resistance: mass * 0.5 * 9.81 * SECONDS,
            });
            masses.step(&motors(Task::Pull(50.0)), SECONDS).velocities[0]
        };
        let free = 0.5 + 50.0 * SECONDS;
        assert!(push(0.02) > 0.98 * free, "{}", push(0.02));
        // An arm of 1 kg m² on a lever of 0.5 m is like 4 kg.
        let expected = (free * 4.0 - 2.0 * 0.5 * 9.81 * SECONDS / 0.5) / 6.0;
        assert!((push(2.0) - expected).abs() < 1e-9, "{} instead of {expected}", push(2.0));
        assert_eq!(push(2000.0), 0.0);
    }

    #[test]
    fn a_thing_that_lies_on_the_arm_weighs() {
        let mut masses = apart(1.0);
        let mut lever = [0.0; 7];
        lever[0] = 0.5;
        masses.touches.push(Touch {
            lever,
            mass: 2.0,
            speed: -9.81 * SECONDS,
            resistance: 0.0,
        });
        let step = masses.step(&motors(Task::Pull(0.0)), SECONDS);
        let expected = -2.0 * 9.81 * 0.5 / (1.0 + 2.0 * 0.25);
        assert!((step.velocities[0] / SECONDS - expected).abs() < 1e-9);
        for _ in 0..200 {
            go(&mut masses, &motors(at(0.0)), SECONDS);
        }
        let step = go(&mut masses, &motors(at(0.0)), SECONDS);
        assert!((step.torques[0] - 9.81).abs() < 1e-6, "{step:?}");
    }

    #[test]
    fn what_the_joints_do_is_found_in_any_state() {
        // A simple generator, so that the numbers are the same every time.
        let mut state = 1_u64;
        let mut number = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 40) as f64 / f64::from(1 << 24) * 2.0 - 1.0
        };
        for _ in 0..2000 {
            let root: Matrix = from_fn(|_| from_fn(|_| number()));
            let mut masses = apart(0.01);
            masses.inertia = from_fn(|i| {
                from_fn(|j| dot(&root[i], &root[j]) + if i == j { 0.01 } else { 0.0 })
            });
            masses.angles = from_fn(|_| PI * number());
            masses.velocities = from_fn(|_| 1.5 * number());
            masses.bias = from_fn(|_| 30.0 * number());
            masses.stops = [[-PI, PI]; 7];
            let motors: [Motor; 7] = from_fn(|i| Motor {
                effort: 50.0,
                speed: 1.5,
                task: if number() > 0.0 {
                    Task::Pull(50.0 * number())
                } else {
                    at(masses.angles[i] + 0.05 * number())
                },
            });
            let step = masses.step(&motors, SECONDS);
            for i in 0..7 {
                assert!(step.torques[i].abs() <= 50.0);
                assert!(step.velocities[i].abs() <= 1.5 + 1e-6, "{step:?}");
                let ahead = masses.angles[i] + SECONDS * step.velocities[i];
                assert!(ahead.abs() <= PI + 1e-6, "{step:?}");
            }
        }
    }
}
