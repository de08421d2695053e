//! Effects of motors, weights, stops and contacts on an arm.

use std::f64::consts::{PI, TAU};

use super::*;
use crate::dynamics::{impulse::FrictionAxis, matrix::each_pair, motor::MotorTask};

const SECONDS: f64 = 1.0 / 60.0;

/// Joints that do not act on each other, each with this inertia, in kg m².
fn apart(inertia: f64) -> LimbDynamics {
    LimbDynamics {
        angles: each(7, |_| 0.0),
        velocities: each(7, |_| 0.0),
        inertia: each_pair(7, |i, j| if i == j { inertia } else { 0.0 }),
        bias: each(7, |_| 0.0),
        damping: each(7, |_| 0.0),
        stops: vec![[-10.0, 10.0]; 7],
        touches: Vec::new(),
    }
}

fn motors(task: MotorTask) -> [Motor; 7] {
    [Motor {
        effort: 50.0,
        speed: 1.5,
        task,
    }; 7]
}

fn at(angle: f64) -> MotorTask {
    MotorTask::Follow {
        angle,
        velocity: 0.0,
        known: 0.0,
    }
}

fn go(masses: &mut LimbDynamics, motors: &[Motor; 7], seconds: f64) -> DynamicsStep {
    let step = masses.step(motors, seconds);
    for (angle, velocity) in masses.angles.iter_mut().zip(&step.velocities) {
        *angle += seconds * velocity;
    }
    masses.velocities.clone_from(&step.velocities);
    step
}

#[test]
fn a_pendulum_swings_with_its_period() {
    // 2 kg at 0.4 m.
    let mut masses = apart(2.0 * 0.4 * 0.4);
    masses.angles = each(7, |_| 0.1);
    let mut crossings = Vec::new();
    for tick in 0..600 {
        let before = masses.angles[0];
        masses.bias = each(7, |i| 2.0 * 9.81 * 0.4 * f64::sin(masses.angles[i]));
        go(&mut masses, &motors(MotorTask::Torque(0.0)), SECONDS);
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
    masses.damping = each(7, |_| 0.7);
    masses.velocities = each(7, |_| 1.0);
    for _ in 0..120 {
        go(&mut masses, &motors(MotorTask::Torque(0.0)), SECONDS);
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
    let mut motors = motors(MotorTask::Torque(0.0));
    motors[0].task = MotorTask::Torque(3.0);
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
    masses.bias = each(7, |_| 21.0);
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
    masses.stops = vec![[-1.0, 0.01]; 7];
    masses.velocities = each(7, |_| 1.2);
    go(&mut masses, &motors(MotorTask::Torque(4.0)), SECONDS);
    assert!((masses.angles[0] - 0.01).abs() < 1e-12);
    let step = go(&mut masses, &motors(MotorTask::Torque(4.0)), SECONDS);
    assert!(step.velocities[0].abs() < 1e-9);
    let step = go(&mut masses, &motors(MotorTask::Torque(-4.0)), SECONDS);
    assert!((step.velocities[0] + 4.0 * SECONDS).abs() < 1e-9);
}

#[test]
fn a_light_thing_hardly_slows_the_arm_and_a_heavy_one_stalls_it() {
    let push = |mass: f64| {
        let mut masses = apart(1.0);
        masses.velocities = each(7, |_| 0.5);
        let mut lever = each(7, |_| 0.0);
        lever[0] = 0.5;
        masses.touches.push(ContactLoad {
            lever,
            mass,
            speed: 0.0,
            resistance: mass * 0.5 * 9.81 * SECONDS,
            friction: 0.0,
            slides: Vec::new(),
        });
        masses
            .step(&motors(MotorTask::Torque(50.0)), SECONDS)
            .velocities[0]
    };
    let free = 0.5 + 50.0 * SECONDS;
    assert!(push(0.02) > 0.98 * free, "{}", push(0.02));
    // An arm of 1 kg m² on a lever of 0.5 m acts like 4 kg.
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
    let mut lever = each(7, |_| 0.0);
    lever[0] = 0.5;
    masses.touches.push(ContactLoad {
        lever,
        mass: 2.0,
        speed: -9.81 * SECONDS,
        resistance: 0.0,
        friction: 0.0,
        slides: Vec::new(),
    });
    let step = masses.step(&motors(MotorTask::Torque(0.0)), SECONDS);
    let expected = -2.0 * 9.81 * 0.5 / (1.0 + 2.0 * 0.25);
    assert!((step.velocities[0] / SECONDS - expected).abs() < 1e-9);
    for _ in 0..200 {
        go(&mut masses, &motors(at(0.0)), SECONDS);
    }
    let step = go(&mut masses, &motors(at(0.0)), SECONDS);
    assert!((step.torques[0] - 9.81).abs() < 1e-6, "{step:?}");
}

#[test]
fn a_pressing_arm_does_not_slip_until_friction_gives_way() {
    let slide = |torque: f64| {
        let mut masses = apart(1.0);
        let lever = |joint: usize| each(7, |i| if i == joint { 1.0 } else { 0.0 });
        masses.touches.push(ContactLoad {
            lever: lever(0),
            mass: 1.0,
            speed: 0.0,
            resistance: f64::INFINITY,
            friction: 0.5,
            slides: vec![FrictionAxis {
                lever: lever(1),
                speed: 0.0,
                resistance: f64::INFINITY,
            }],
        });
        let mut motors = motors(MotorTask::Torque(0.0));
        motors[0].task = MotorTask::Torque(20.0);
        motors[1].task = MotorTask::Torque(torque);
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
fn a_step_respects_all_limits_in_any_state() {
    // A simple generator, so that the numbers are the same every time.
    let mut state = 1_u64;
    let mut number = move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 40) as f64 / f64::from(1 << 24) * 2.0 - 1.0
    };
    for _ in 0..2000 {
        let root: Matrix = (0..7).map(|_| each(7, |_| number())).collect();
        let mut masses = apart(0.01);
        masses.inertia = each_pair(7, |i, j| {
            dot(&root[i], &root[j]) + if i == j { 0.01 } else { 0.0 }
        });
        masses.angles = each(7, |_| PI * number());
        masses.velocities = each(7, |_| 1.5 * number());
        masses.bias = each(7, |_| 30.0 * number());
        masses.stops = vec![[-PI, PI]; 7];
        let motors: [Motor; 7] = std::array::from_fn(|i| Motor {
            effort: 50.0,
            speed: 1.5,
            task: if number() > 0.0 {
                MotorTask::Torque(50.0 * number())
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
