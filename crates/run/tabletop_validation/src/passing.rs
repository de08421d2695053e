//! Things that pass each other, and that meet off-centre.

use std::f32::consts::{FRAC_PI_2, FRAC_PI_4};

use bevy::math::{DVec3, Vec3};
use tabletop_geometry::{Twist, turn_about};
use tabletop_physics::PhysicsSettings;

use crate::{
    experiment::Experiment,
    measurement::Measurement,
    small_world::{G, SmallWorld, TICK, UNDAMPED},
    specimen::Specimen,
};

pub(crate) const EXPERIMENTS: &[Experiment] = &[
    Experiment::new("pass-balls", || pass(ball, ball)),
    Experiment::new("pass-ball-cube", || pass(ball, cube)),
    Experiment::new("pass-ball-edge", || pass(ball, edge)),
    Experiment::new("pass-ball-cylinder", || pass(ball, upright)),
    Experiment::new("pass-cubes", || pass(cube, cube)),
    Experiment::new("pass-cube-edge", || pass(cube, edge)),
    Experiment::new("pass-edges", || pass(edge, edge)),
    Experiment::new("pass-cube-cylinder", || pass(cube, upright)),
    Experiment::new("pass-cylinders", || pass(upright, upright)),
    Experiment::new("pass-lying-cylinder-cube", || pass(lying, cube)),
    Experiment::new("fall-past-edge", fall_past_edge),
    Experiment::new("glance-balls", || glance(1.0)),
    Experiment::new("glance-balls-inelastic", || glance(0.0)),
    Experiment::new("glance-balls-rough", glance_rough),
];

/// Speeds in units/s.
const SPEEDS: [f32; 6] = [1.0, 3.0, 10.0, 20.0, 40.0, 100.0];

/// Gaps in units.
const GAPS: [f32; 4] = [0.001, 0.01, 0.05, 0.1];

/// The number of moments within a tick at which things meet.
const PHASES: u16 = 8;

/// Distance, in units, of pairs from each other.
const APART: f32 = 8.0;

/// A world without weight and friction.
const WEIGHTLESS: PhysicsSettings = PhysicsSettings {
    gravity: 0.0,
    friction: 0.0,
    restitution: 1.0,
    ..UNDAMPED
};

/// A solid, and its half-width along Y.
struct PassingSolid {
    specimen: Specimen,
    half: f32,
}

fn ball(id: String) -> PassingSolid {
    let specimen = Specimen::ball(id, 0.5);
    PassingSolid {
        specimen,
        half: 0.5,
    }
}

fn cube(id: String) -> PassingSolid {
    let specimen = Specimen::cube(id);
    PassingSolid {
        specimen,
        half: 0.5,
    }
}

/// A cube that shows an edge.
fn edge(id: String) -> PassingSolid {
    let specimen = Specimen::cube(id).turned(turn_about(Vec3::Z, FRAC_PI_4));
    let half = 0.5_f32.sqrt();
    PassingSolid { specimen, half }
}

fn upright(id: String) -> PassingSolid {
    let turned = turn_about(Vec3::X, FRAC_PI_2);
    let specimen = Specimen::cylinder(id, 0.5, 1.0).turned(turned);
    PassingSolid {
        specimen,
        half: 0.5,
    }
}

fn lying(id: String) -> PassingSolid {
    let specimen = Specimen::cylinder(id, 0.5, 1.0);
    PassingSolid {
        specimen,
        half: 0.5,
    }
}

/// Pairs that pass each other with some air between them.
fn pass(first: fn(String) -> PassingSolid, second: fn(String) -> PassingSolid) -> Vec<Measurement> {
    let mut turned_aside = 0.0_f64;
    let mut pushed = 0.0_f64;
    for speed in SPEEDS {
        let mut specimens = Vec::new();
        let mut names = Vec::new();
        for (row, gap) in GAPS.into_iter().enumerate() {
            for phase in 0..PHASES {
                let name = format!("{row}-{phase}");
                let place = Vec3::new(0.0, APART * row as f32, 4.0 + APART * f32::from(phase));
                let [one, other] = [first(format!("a{name}")), second(format!("b{name}"))];
                let way = speed * TICK as f32 * (8.0 + f32::from(phase) / f32::from(PHASES));
                let beside = Vec3::new(-2.0 - way, one.half + other.half + gap, 0.0);
                specimens.push(one.specimen.at(place + beside).moving(Vec3::X * speed));
                specimens.push(other.specimen.at(place));
                names.push(name);
            }
        }
        let mut world = SmallWorld::new(WEIGHTLESS, &specimens);
        world.seconds(4.0 / f64::from(speed) + 16.0 * TICK);
        for name in names {
            let [mover, still] = ["a", "b"].map(|side| format!("{side}{name}"));
            let change = world.velocity(&mover) - DVec3::X * f64::from(speed);
            let change = change.length() + world.spin(&mover).length();
            let push = world.velocity(&still).length() + world.spin(&still).length();
            turned_aside = turned_aside.max(change / f64::from(speed));
            pushed = pushed.max(push / f64::from(speed));
        }
    }
    vec![
        Measurement::none("change of velocity/v", turned_aside, 0.001),
        Measurement::none("velocity of the other/v", pushed, 0.001),
    ]
}

/// Balls that fall past the edge of a fixed block.
fn fall_past_edge() -> Vec<Measurement> {
    let mut aside = 0.0_f64;
    for drop in [2.0, 8.0] {
        let block = Specimen::block("block", (4.0, 4.0, 4.0))
            .at((0.0, 0.0, 22.0))
            .fixed();
        let mut specimens = vec![block];
        let mut names = Vec::new();
        for (side, gap) in GAPS.into_iter().enumerate() {
            let turn = turn_about(Vec3::Z, FRAC_PI_2 * side as f32);
            for (number, beside) in [(0, -1.5), (1, 0.0), (2, 1.5)] {
                let height = 24.5 + drop + 0.02 * number as f32;
                let name = format!("{side}-{number}");
                let at = turn * Vec3::new(2.5 + gap, beside, height);
                specimens.push(Specimen::ball(&name, 0.5).at(at));
                names.push((name, turn));
            }
        }
        let mut world = SmallWorld::new(smooth(), &specimens);
        world.seconds((2.0 * (f64::from(drop) + 5.0) / G).sqrt());
        for (name, _) in names {
            let velocity = world.velocity(&name);
            aside = aside.max(velocity.with_z(0.0).length());
        }
    }
    vec![Measurement::none("speed aside", aside, 0.01)]
}

const fn smooth() -> PhysicsSettings {
    PhysicsSettings {
        friction: 0.0,
        ..UNDAMPED
    }
}

/// A ball that meets a resting one off-centre by 0.8 of the sum of their radii.
fn glance(restitution: f32) -> Vec<Measurement> {
    let settings = PhysicsSettings {
        restitution,
        ..WEIGHTLESS
    };
    let mut angle = 0.0_f64;
    let mut speed_error = 0.0_f64;
    let mut spin = 0.0_f64;
    let offset = 0.8;
    for (speed, [first, second]) in glances(settings, offset) {
        let direction = DVec3::new((1.0 - offset * offset).sqrt(), -offset, 0.0);
        let expected = f64::from(speed * (1.0 + restitution)) / 2.0 * direction.x;
        let [first, second] = [first, second].map(exact);
        angle = angle.max(second[0].angle_between(direction).to_degrees());
        speed_error = speed_error.max((second[0].length() / expected - 1.0).abs());
        spin = spin.max((first[1].length() + second[1].length()) / f64::from(speed));
    }
    vec![
        Measurement::none("error of the angle in degrees", angle, 0.5),
        Measurement::none("error of the speed/v", speed_error, 0.01),
        Measurement::none("spin/v", spin, 0.01),
    ]
}

/// The same with friction μ = 0.1, which slips all the time: tan of its angle to the normal is μ.
fn glance_rough() -> Vec<Measurement> {
    const FRICTION: f64 = 0.1;
    let settings = PhysicsSettings {
        friction: FRICTION.sqrt() as f32,
        ..WEIGHTLESS
    };
    let offset = 0.8;
    let mut tangent = 0.0_f64;
    let mut momentum = 0.0_f64;
    let mut spin = 0.0_f64;
    for (speed, [first, second]) in glances(settings, offset) {
        let normal = DVec3::new((1.0 - offset * offset).sqrt(), -offset, 0.0);
        let along = DVec3::new(offset, normal.x, 0.0);
        let [first, second] = [first, second].map(exact);
        let across = second[0].dot(normal);
        tangent = tangent.max((second[0].dot(along) / across - FRICTION).abs());
        let all = first[0] + second[0] - DVec3::X * f64::from(speed);
        momentum = momentum.max(all.length() / f64::from(speed));
        // The impulse of friction has the arm r, and the moment of inertia is 2/5 r².
        let expected = FRICTION * across / (0.4 * 0.5);
        spin = spin.max((second[1].length() / expected - 1.0).abs());
    }
    vec![
        Measurement::none("error of tan φ", tangent, 0.005),
        Measurement::none("change of momentum/v", momentum, 0.001),
        Measurement::none("error of the spin", spin, 0.02),
    ]
}

/// The speed at first, and the velocities of both balls afterwards, of glancing balls.
fn glances(settings: PhysicsSettings, offset: f64) -> impl Iterator<Item = (f32, [Twist; 2])> {
    SPEEDS.into_iter().flat_map(move |speed| {
        let mut specimens = Vec::new();
        for phase in 0..PHASES {
            let place = Vec3::new(0.0, 0.0, 4.0 + APART * f32::from(phase));
            let way = speed * TICK as f32 * (8.0 + f32::from(phase) / f32::from(PHASES));
            let beside = Vec3::new(-2.0 - way, offset as f32, 0.0);
            let [first, second] =
                ["a", "b"].map(|side| Specimen::ball(format!("{side}{phase}"), 0.5));
            specimens.push(first.at(place + beside).moving(Vec3::X * speed));
            specimens.push(second.at(place));
        }
        let mut world = SmallWorld::new(settings, &specimens);
        world.seconds(4.0 / f64::from(speed) + 16.0 * TICK);
        let phases = 0..PHASES;
        let balls =
            phases.map(|phase| ["a", "b"].map(|side| world.twist(&format!("{side}{phase}"))));
        balls.map(|pair| (speed, pair)).collect::<Vec<_>>()
    })
}

fn exact(twist: Twist) -> [DVec3; 2] {
    [twist.linear, twist.angular].map(Vec3::as_dvec3)
}
