//! An arm as masses that motors move.
//!
//! Everything is in m, kg, s, rad and N m, one number for every joint. A step is implicit: all torques are those at its end,
//! so that stiff motors are stable in steps of any length. What acts on a joint never grows with the joint's speed: motors pull
//! less and less, up to their limits, and what is pushed and stops push back more and more. So there is exactly one answer, the
//! minimum of a convex function, and Newton's method finds it from anywhere if it never goes too far.

use std::array::from_fn;

use crate::{
    matrix::{Factors, Joints, Matrix, dot},
    motor::Motor,
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
    /// Friction between the two: the largest part of what the arm pushes with that can draw along the surface.
    pub friction: f64,
    /// Directions along the surface.
    pub slides: Vec<Slide>,
}

/// A direction along the surface of something that an arm touches.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Slide {
    /// How fast the arm goes this way per rad/s of each joint, in m.
    pub lever: Joints,
    /// How fast the thing goes this way, in m/s.
    pub speed: f64,
    /// The momentum in N s that what else it touches can give it against its motion in a step.
    pub resistance: f64,
}

/// A slide with what can be drawn there.
struct Draw<'a> {
    slide: &'a Slide,
    /// Mass of the thing, in kg.
    mass: f64,
    /// Largest momentum in N s.
    most: f64,
}

/// What a step makes of an arm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Step {
    /// How fast the joints are at its end and move in it, in rad/s.
    pub velocities: Joints,
    /// Torques of the motors, in N m.
    pub torques: Joints,
}

/// What stops push back with, in N m s per rad/s beyond what is left of the way.
const WALL: f64 = 1e6;

/// Speed in m/s at which friction is at its full strength.
const CREEP: f64 = 1e-4;

/// Speed in m/s below which something pushed stands.
const STANDSTILL: f64 = 0.005;

/// Most momentum in N s that a touch can take by resistance.
const IMMOVABLE: f64 = 1e3;

/// Most rounds of Newton's method; a few are usual.
const MOST_ROUNDS: usize = 60;

/// Angular momentum in N m s that may be unaccounted for.
const NEGLIGIBLE: f64 = 1e-9;

/// Halvings of a way of Newton's method that goes too far.
const HALVINGS: usize = 30;

impl Masses {
    /// What `seconds` make of the arm.
    pub fn step(&self, motors: &[Motor; 7], seconds: f64) -> Step {
        let smooth = self.settle(motors, self.velocities, &[], seconds);
        let draws = self.draws(&smooth);
        let velocities = match draws.is_empty() {
            true => smooth,
            false => self.settle(motors, smooth, &draws, seconds),
        };
        let velocities = from_fn(|i| {
            let [least, largest] = self.bounds(i, seconds);
            let speed = motors[i].speed;
            let velocity = if velocities[i].is_finite() {
                velocities[i]
            } else {
                0.0
            };
            velocity.clamp(-speed, speed).min(largest).max(least)
        });
        Step {
            velocities,
            torques: from_fn(|i| {
                motors[i].torque(self.angles[i] + seconds * velocities[i], velocities[i])
            }),
        }
    }

    /// What can be drawn along by friction when the arm pushes as hard as it does with these velocities.
    fn draws(&self, velocities: &Joints) -> Vec<Draw<'_>> {
        let touches = self.touches.iter().map(|touch| {
            let most = touch.friction * touch.push(dot(&touch.lever, velocities));
            (touch, most)
        });
        let pushed = touches.filter(|(_, most)| *most > 0.0);
        pushed
            .flat_map(|(touch, most)| {
                touch.slides.iter().map(move |slide| Draw {
                    slide,
                    mass: touch.mass,
                    most,
                })
            })
            .collect()
    }

    /// The velocities at the end of a step, looked for from these on.
    fn settle(&self, motors: &[Motor; 7], from: Joints, draws: &[Draw], seconds: f64) -> Joints {
        let excess = |velocities: &Joints| self.excess(motors, velocities, draws, seconds);
        let mut velocities = from;
        for _ in 0..MOST_ROUNDS {
            let start = excess(&velocities);
            if start.iter().all(|excess| excess.abs() < NEGLIGIBLE) {
                break;
            }
            let slope = self.slope(motors, &velocities, draws, seconds);
            let way = Factors::of(&slope).solve(start.map(|excess| -excess));
            let next = go(velocities, &way, dot(&start, &way), excess);
            if next == velocities {
                break;
            }
            velocities = next;
        }
        velocities
    }

    /// The angular momentum in N m s that would come from nowhere if the joints had these velocities at the end of a step.
    fn excess(
        &self,
        motors: &[Motor; 7],
        velocities: &Joints,
        draws: &[Draw],
        seconds: f64,
    ) -> Joints {
        let change: Joints = from_fn(|i| velocities[i] - self.velocities[i]);
        let mut pushed = [0.0; 7];
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
        from_fn(|i| {
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
    fn slope(
        &self,
        motors: &[Motor; 7],
        velocities: &Joints,
        draws: &[Draw],
        seconds: f64,
    ) -> Matrix {
        let mut slope = self.inertia;
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

impl Touch {
    /// Whether an arm with these velocities pushes it in vain.
    pub fn withstands(&self, velocities: &Joints) -> bool {
        let speed = dot(&self.lever, velocities);
        self.push(speed) > 0.0 && speed < STANDSTILL
    }

    /// The momentum in N s that the arm loses to it if it comes with this speed in m/s.
    fn push(&self, speed: f64) -> f64 {
        let slides = ((speed - self.speed.max(0.0)) / CREEP).clamp(0.0, 1.0);
        self.mass * (speed - self.speed).max(0.0) + self.resistance.min(IMMOVABLE) * slides
    }

    /// By how much that grows with the speed, in kg.
    fn felt_mass(&self, speed: f64) -> f64 {
        let moves = if speed > self.speed { self.mass } else { 0.0 };
        let from_rest = speed - self.speed.max(0.0);
        let sticks = from_rest > 0.0 && from_rest < CREEP;
        moves
            + if sticks {
                self.resistance.min(IMMOVABLE) / CREEP
            } else {
                0.0
            }
    }
}

impl Draw<'_> {
    /// The momentum in N s that the arm loses if it goes along with this speed in m/s.
    fn push(&self, speed: f64) -> f64 {
        self.needed(speed).clamp(-self.most, self.most)
    }

    /// By how much that grows with the speed, in kg.
    fn felt_mass(&self, speed: f64) -> f64 {
        let sticks = speed.abs() < CREEP;
        match self.needed(speed).abs() < self.most {
            true if sticks => self.mass + self.slide.resistance.min(IMMOVABLE) / CREEP,
            true => self.mass,
            false => 0.0,
        }
    }

    /// The momentum that it takes to give the thing this speed.
    fn needed(&self, speed: f64) -> f64 {
        let rubs = (speed / CREEP).clamp(-1.0, 1.0);
        self.mass * (speed - self.slide.speed) + self.slide.resistance.min(IMMOVABLE) * rubs
    }
}

/// Goes from somewhere this way until it goes up again: the convex function whose slopes `excess` has goes down by
/// `-start` where the way starts.
fn go(from: Joints, way: &Joints, start: f64, excess: impl Fn(&Joints) -> Joints) -> Joints {
    let at = |part: f64| -> Joints { from_fn(|i| from[i] + part * way[i]) };
    let slope = |part: f64| dot(&excess(&at(part)), way);
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

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use super::*;
    use crate::motor::Task;

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
            masses.bias = masses
                .angles
                .map(|angle| 2.0 * 9.81 * 0.4 * f64::sin(angle));
            go(&mut masses, &motors(Task::Pull(0.0)), SECONDS);
            if before > 0.0 && masses.angles[0] <= 0.0 {
                let part = before / (before - masses.angles[0]);
                crossings.push((f64::from(tick) + part) * SECONDS);
            }
        }
        let period = (crossings.last().unwrap() - crossings[0]) / (crossings.len() - 1) as f64;
        let expected = TAU * (0.4_f64 / 9.81).sqrt() * (1.0 + 0.1 * 0.1 / 16.0);
        assert!(
            (period / expected - 1.0).abs() < 0.01,
            "{period} s instead of {expected} s"
        );
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
        assert!(
            (masses.velocities[3] / expected - 1.0).abs() < 0.02,
            "{:?}",
            masses.velocities
        );
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
            assert!(
                (masses.angles[0] - 0.005).abs() < 1e-6,
                "{inertia}: {:?}",
                masses.angles
            );
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
        assert!((step.velocities[0] - 1.5).abs() < 1e-4, "{step:?}");
        assert_eq!(step.velocities[0], masses.velocities[0]);
    }

    #[test]
    fn a_stop_takes_the_speed_and_lets_the_joint_go_back() {
        let mut masses = apart(1.0);
        masses.stops = [[-1.0, 0.01]; 7];
        masses.velocities = [1.2; 7];
        go(&mut masses, &motors(Task::Pull(4.0)), SECONDS);
        assert!((masses.angles[0] - 0.01).abs() < 1e-12);
        let step = go(&mut masses, &motors(Task::Pull(4.0)), SECONDS);
        assert!(step.velocities[0].abs() < 1e-9);
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
                friction: 0.0,
                slides: Vec::new(),
            });
            masses.step(&motors(Task::Pull(50.0)), SECONDS).velocities[0]
        };
        let free = 0.5 + 50.0 * SECONDS;
        assert!(push(0.02) > 0.98 * free, "{}", push(0.02));
        // An arm of 1 kg m² on a lever of 0.5 m is like 4 kg.
        let expected = (free * 4.0 - 2.0 * 0.5 * 9.81 * SECONDS / 0.5) / 6.0;
        assert!(
            (push(2.0) - expected).abs() < 1e-9,
            "{} instead of {expected}",
            push(2.0)
        );
        assert!(push(2000.0).abs() < 1e-3, "{}", push(2000.0));
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
            friction: 0.0,
            slides: Vec::new(),
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
    fn an_arm_does_not_slip_along_what_it_presses_on_until_friction_gives_way() {
        let slide = |torque: f64| {
            let mut masses = apart(1.0);
            let lever = |joint: usize| from_fn(|i| if i == joint { 1.0 } else { 0.0 });
            masses.touches.push(Touch {
                lever: lever(0),
                mass: 1.0,
                speed: 0.0,
                resistance: f64::INFINITY,
                friction: 0.5,
                slides: vec![Slide {
                    lever: lever(1),
                    speed: 0.0,
                    resistance: f64::INFINITY,
                }],
            });
            let mut motors = motors(Task::Pull(0.0));
            motors[0].task = Task::Pull(20.0);
            motors[1].task = Task::Pull(torque);
            masses.step(&motors, SECONDS).velocities
        };
        assert!(slide(9.0)[1].abs() < 1e-4, "{:?}", slide(9.0));
        assert!(
            (slide(-16.0)[1] + 6.0 * SECONDS).abs() < 1e-4,
            "{:?}",
            slide(-16.0)
        );
    }

    #[test]
    fn what_the_joints_do_is_found_in_any_state() {
        // A simple generator, so that the numbers are the same every time.
        let mut state = 1_u64;
        let mut number = move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 40) as f64 / f64::from(1 << 24) * 2.0 - 1.0
        };
        for _ in 0..2000 {
            let root: Matrix = from_fn(|_| from_fn(|_| number()));
            let mut masses = apart(0.01);
            masses.inertia =
                from_fn(|i| from_fn(|j| dot(&root[i], &root[j]) + if i == j { 0.01 } else { 0.0 }));
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
