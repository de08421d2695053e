//! Collisions along a line.

use bevy::math::Vec3;
use tabletop_physics::PhysicsSettings;

use crate::{
    experiment::Experiment,
    measurement::Measurement,
    small_world::{SmallWorld, UNDAMPED},
    specimen::Specimen,
};

pub(crate) const EXPERIMENTS: &[Experiment] = &[
    Experiment::new("row-of-balls", row),
    Experiment::new("collide-balls-elastic", || {
        collide(|id| Specimen::ball(id, 0.5), [1.0, 1.0], 1.0)
    }),
    Experiment::new("collide-balls-unequal", || {
        collide(|id| Specimen::ball(id, 0.5), [3.0, 1.0], 1.0)
    }),
    Experiment::new("collide-cubes-elastic", || collide(cube, [1.0, 1.0], 1.0)),
    Experiment::new("collide-cubes-inelastic", || collide(cube, [1.0, 1.0], 0.0)),
    Experiment::new("collide-cubes-heavy-on-light", || {
        collide(cube, [3.0, 1.0], 0.5)
    }),
    Experiment::new("collide-cubes-light-on-heavy", || {
        collide(cube, [1.0, 3.0], 0.5)
    }),
    Experiment::new("collide-cubes-1-on-1000", || {
        collide(cube, [1.0, 1000.0], 1.0)
    }),
];

/// Speed of the object that comes, in units/s.
const SPEED: f64 = 10.0;

fn cube(id: &str) -> Specimen {
    Specimen::cube(id)
}

/// A world without friction whose surfaces have this restitution.
const fn smooth(restitution: f32) -> PhysicsSettings {
    PhysicsSettings {
        friction: 0.0,
        restitution,
        ..UNDAMPED
    }
}

/// Newton's cradle on the table: five resting balls in touch, and one that comes.
fn row() -> Vec<Measurement> {
    let ball =
        |number: usize, x: f32| Specimen::ball(format!("ball{number}"), 0.5).at((x, 0.0, 0.5));
    let mut balls = vec![ball(0, -3.0).moving(Vec3::X * SPEED as f32)];
    balls.extend((1..=5).map(|number| ball(number, number as f32 - 1.0)));
    let mut world = SmallWorld::new(smooth(1.0), &balls);
    world.seconds(0.6);
    let speeds: Vec<_> = balls
        .iter()
        .map(|ball| world.velocity(&ball.spec.id))
        .collect();
    let energy = speeds
        .iter()
        .map(|speed| speed.length_squared())
        .sum::<f64>();
    let momentum = speeds.iter().map(|speed| speed.x).sum::<f64>();
    let fastest = speeds[..5]
        .iter()
        .map(|speed| speed.length())
        .fold(0.0, f64::max);
    vec![
        Measurement::close("speed of the last", "v", SPEED, speeds[5].x, 0.01),
        Measurement::none("speed of the others", fastest, 0.1),
        Measurement::close("energy", "v²", SPEED * SPEED, energy, 0.01),
        Measurement::close("momentum", "v", SPEED, momentum, 0.01),
    ]
}

/// An object that meets another one at rest.
fn collide(make: fn(&str) -> Specimen, masses: [f32; 2], restitution: f32) -> Vec<Measurement> {
    let first = make("first")
        .at((-3.0, 0.0, 0.5))
        .weighing(masses[0])
        .moving(Vec3::X * SPEED as f32);
    let second = make("second").at((0.0, 0.0, 0.5)).weighing(masses[1]);
    let mut world = SmallWorld::new(smooth(restitution), &[first, second]);
    world.seconds(0.6);
    let found = ["first", "second"].map(|id| world.velocity(id).x);
    let [a, b] = masses.map(f64::from);
    let e = f64::from(restitution);
    let expected = [
        SPEED * (a - e * b) / (a + b),
        SPEED * a * (1.0 + e) / (a + b),
    ];
    let momentum = (a * found[0] + b * found[1]) / (a * SPEED);
    vec![
        Measurement::near(
            "first's speed",
            "v (m₁ − e m₂)/(m₁ + m₂)",
            expected[0],
            found[0],
            0.1,
        ),
        Measurement::near(
            "second's speed",
            "v m₁ (1 + e)/(m₁ + m₂)",
            expected[1],
            found[1],
            0.02 * expected[1],
        ),
        Measurement::close("momentum", "m₁ v", 1.0, momentum, 0.01),
    ]
}
