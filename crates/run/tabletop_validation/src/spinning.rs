//! Free rotation of a brick, beside Euler's equations.

use bevy::math::{DVec3, Vec3};
use tabletop_physics::PhysicsSettings;

use crate::{
    experiment::Experiment,
    measurement::Measurement,
    small_world::{SmallWorld, TICK, UNDAMPED},
    specimen::Specimen,
};

pub(crate) const EXPERIMENTS: &[Experiment] = &[
    Experiment::new("spin-long-axis", || spin(Vec3::new(0.1, 0.1, 10.0))),
    Experiment::new("spin-middle-axis", flip),
    Experiment::new("spin-short-axis", || spin(Vec3::new(10.0, 0.1, 0.1))),
];

/// Time of an experiment, in s.
const SECONDS: f64 = 10.0;

const WEIGHTLESS: PhysicsSettings = PhysicsSettings {
    gravity: 0.0,
    ..UNDAMPED
};

/// A brick in mid-air. Its moments of inertia are 13/12, 10/12 and 5/12.
fn brick(spin: Vec3) -> Specimen {
    Specimen::block("brick", (1.0, 2.0, 3.0))
        .at(Vec3::Z * 20.0)
        .spinning(spin)
}

/// What a free brick keeps, and its angular velocities about its own axes at each tick.
fn observe(brick: &Specimen) -> (Vec<Measurement>, Vec<DVec3>) {
    let mut world = SmallWorld::new(WEIGHTLESS, std::slice::from_ref(brick));
    let momentum =
        |world: &SmallWorld| brick.angular_momentum(world.rotation("brick"), world.spin("brick"));
    let spin = brick.spin.as_dvec3();
    let first = brick.inertia() * spin;
    let energy = spin.dot(first) / 2.0;
    let (mut most, mut spins) = (0.0, vec![spin]);
    world.watch(SECONDS, |world| {
        let spin = world.spin("brick");
        let now = momentum(world).dot(spin) / 2.0;
        most = f64::max(most, now / energy - 1.0);
        spins.push(world.rotation("brick").inverse() * spin);
    });
    let last = momentum(&world);
    let kept = last.dot(world.spin("brick")) / 2.0 / energy;
    let measurements = vec![
        Measurement::close("energy", "½ ω·I ω", 1.0, kept, 0.01),
        Measurement::none("gain of energy", most, 0.01),
        Measurement::close(
            "angular momentum",
            "|I ω|",
            1.0,
            last.length() / first.length(),
            0.01,
        ),
        Measurement::none("turn of its axis", last.angle_between(first), 0.02),
    ];
    (measurements, spins)
}

fn spin(spin: Vec3) -> Vec<Measurement> {
    observe(&brick(spin)).0
}

/// A brick that spins about its middle axis turns over, again and again (Dzhanibekov).
fn flip() -> Vec<Measurement> {
    let brick = brick(Vec3::new(0.5, 10.0, 0.5));
    let (mut measurements, spins) = observe(&brick);
    let reference = euler(brick.inertia(), brick.spin.as_dvec3());
    let [found, expected] = [&spins, &reference].map(|spins| flips(spins));
    measurements.extend([
        Measurement::near(
            "flips",
            "Euler's equations",
            expected.len() as f64,
            found.len() as f64,
            0.5,
        ),
        Measurement::close(
            "time of the first flip",
            "Euler's equations",
            expected.first().copied().unwrap_or_default(),
            found.first().copied().unwrap_or_default(),
            0.03,
        ),
        Measurement::close(
            "time between flips",
            "Euler's equations",
            mean_distance(&expected),
            mean_distance(&found),
            0.03,
        ),
    ]);
    measurements
}

/// The angular velocities at each tick by Euler's equations, I dω/dt = I ω × ω, integrated by the method of Runge and Kutta.
fn euler(inertia: DVec3, mut spin: DVec3) -> Vec<DVec3> {
    const STEPS: u32 = 100;
    let step = TICK / f64::from(STEPS);
    let change = |spin: DVec3| (inertia * spin).cross(spin) / inertia;
    let mut spins = vec![spin];
    for _ in 0..(SECONDS / TICK).round() as usize {
        for _ in 0..STEPS {
            let a = change(spin);
            let b = change(spin + a * step / 2.0);
            let c = change(spin + b * step / 2.0);
            let d = change(spin + c * step);
            spin += (a + 2.0 * b + 2.0 * c + d) * (step / 6.0);
        }
        spins.push(spin);
    }
    spins
}

/// The times at which the spin about the middle axis changes its sign.
fn flips(spins: &[DVec3]) -> Vec<f64> {
    let pairs = spins.windows(2).enumerate();
    let crossing = pairs.filter(|(_, pair)| (pair[0].y > 0.0) != (pair[1].y > 0.0));
    crossing
        .map(|(tick, pair)| (tick as f64 + pair[0].y / (pair[0].y - pair[1].y)) * TICK)
        .collect()
}

fn mean_distance(times: &[f64]) -> f64 {
    match times {
        [first, .., last] => (last - first) / (times.len() - 1) as f64,
        _ => 0.0,
    }
}
