//! Things that a hand carries on a plate.

use bevy::math::Vec3;
use tabletop_core::{Hand, HandCommand};

use crate::{
    experiment::Experiment,
    measurement::Measurement,
    small_world::{G, SHIPPED, SmallWorld, TICK},
    specimen::Specimen,
};

pub(crate) const EXPERIMENTS: &[Experiment] = &[
    Experiment::new("carry-gently", gently),
    Experiment::new("carry-up-and-down", up_and_down),
    Experiment::new("carry-too-fast", too_fast),
];

/// Where the middle of the plate is at first.
const PLATE: Vec3 = Vec3::new(-4.0, 0.0, 3.0);

/// A plate in a hand, with a cube on it, after a quarter of a second.
fn tray() -> SmallWorld {
    let plate = Specimen::block("plate", (6.0, 4.0, 0.2)).at(PLATE);
    let cube = Specimen::cube("cube").at(PLATE + Vec3::Z * 0.6);
    let mut world = SmallWorld::new(SHIPPED, &[plate, cube]);
    world.command(HandCommand::Grasp {
        hand: Hand::Right,
        object: "plate".into(),
    });
    world.seconds(0.25);
    world
}

/// Moves the plate along a path, which says the way in units after so many ticks, and returns how far the cube slips on it at most.
fn carry(world: &mut SmallWorld, direction: Vec3, ticks: u64, way: impl Fn(f64) -> f64) -> f64 {
    let place = |world: &SmallWorld| world.location("cube") - world.location("plate");
    let start = place(world);
    let mut slip: f64 = 0.0;
    for tick in 1..=ticks {
        let way = way(tick as f64 * TICK) as f32;
        world.command(HandCommand::MoveTo {
            hand: Hand::Right,
            location: PLATE + direction * way,
        });
        world.step(1);
        slip = slip.max((place(world) - start).length());
    }
    slip
}

/// The way after a time of speeding up for half a second, going on for half a second and slowing down for half a second.
fn there(acceleration: f64, seconds: f64) -> f64 {
    let [up, on, down] = [seconds, seconds - 0.5, seconds - 1.0].map(|time| time.clamp(0.0, 0.5));
    let speed = acceleration * 0.5;
    acceleration * up * up / 2.0 + speed * on + speed * down - acceleration * down * down / 2.0
}

/// At 10 units/s², where friction can give μ g = 24.5.
fn gently() -> Vec<Measurement> {
    let mut world = tray();
    let slip = carry(&mut world, Vec3::X, 120, |seconds| there(10.0, seconds));
    let went = world.location("plate").x - f64::from(PLATE.x);
    vec![
        Measurement::close("way of the plate", "a t₁ (t₁ + t₂)", 5.0, went, 0.01),
        Measurement::none("slip at a = 0.4 μ g", slip, 0.01),
    ]
}

fn up_and_down() -> Vec<Measurement> {
    let mut world = tray();
    let mut slip = carry(&mut world, Vec3::Z, 120, |seconds| there(20.0, seconds));
    slip = slip.max(carry(&mut world, Vec3::Z, 120, |seconds| {
        10.0 - there(20.0, seconds)
    }));
    vec![Measurement::none("lift at a = 0.2 g", slip, 0.01)]
}

/// At twice the acceleration that friction can give.
fn too_fast() -> Vec<Measurement> {
    const SECONDS: f64 = 0.2;
    let friction = f64::from(SHIPPED.friction).powi(2);
    let acceleration = 2.0 * friction * G;
    let mut world = tray();
    let slip = carry(&mut world, Vec3::X, 12, |seconds| {
        acceleration * seconds * seconds / 2.0
    });
    let expected = (acceleration - friction * G) * SECONDS * SECONDS / 2.0;
    vec![Measurement::close(
        "slip at a = 2 μ g",
        "(a − μ g) t²/2",
        expected,
        slip,
        0.05,
    )]
}
