//! Joints between flush fixed plates, which nothing that crosses them may notice.

use bevy::math::Vec3;

use crate::{
    experiment::Experiment,
    measurement::Measurement,
    small_world::{G, SHIPPED, SmallWorld},
    specimen::Specimen,
};

pub(crate) const EXPERIMENTS: &[Experiment] = &[
    Experiment::new("seam-cube", || cross(Specimen::cube("body"), 2)),
    Experiment::new("seam-ball", || cross(Specimen::ball("body", 0.5), 2)),
    Experiment::new("seam-cylinder", || {
        cross(Specimen::cylinder("body", 0.5, 1.0), 2)
    }),
    Experiment::new("tiles-cube", || cross(Specimen::cube("body"), 16)),
    Experiment::new("tiles-ball", || cross(Specimen::ball("body", 0.5), 16)),
    Experiment::new("tiles-cylinder", || {
        cross(Specimen::cylinder("body", 0.5, 1.0), 16)
    }),
    Experiment::new("seam-lengthwise", lengthwise),
    Experiment::new("seam-rough", rough),
];

/// Height of the plates.
const PLATE: f32 = 0.5;

/// Speed along X, in units/s.
const SPEED: f64 = 10.0;

/// Flush plates from X = 0 on, which are together 16 units long.
fn tiles(count: usize) -> Vec<Specimen> {
    let span = 16.0 / count as f32;
    let tile = |number: usize| {
        Specimen::block(format!("tile{number}"), (span, 4.0, PLATE))
            .at(((number as f32 + 0.5) * span, 0.0, PLATE / 2.0))
            .fixed()
    };
    (0..count).map(tile).collect()
}

/// A body without friction that slides over tiles.
fn cross(body: Specimen, count: usize) -> Vec<Measurement> {
    let mut specimens = tiles(count);
    let start = Vec3::new(1.0, 0.0, PLATE + 0.5);
    let body = body.at(start).rough(0.0).moving(Vec3::X * SPEED as f32);
    specimens.push(body);
    let mut world = SmallWorld::new(SHIPPED, &specimens);
    let mut off: f64 = 0.0;
    let mut aside: f64 = 0.0;
    world.watch(14.0 / SPEED, |world| {
        let place = world.location("body");
        off = off.max((place.z - f64::from(start.z)).abs());
        aside = aside.max(place.y.abs());
    });
    vec![
        Measurement::close("speed", "v", SPEED, world.velocity("body").x, 0.01),
        Measurement::none("change of height", off, 0.01),
        Measurement::none("way aside", aside, 0.01),
    ]
}

/// A cube without friction that slides along a joint.
fn lengthwise() -> Vec<Measurement> {
    let plate = |id: &str, y: f32| {
        Specimen::block(id, (16.0, 2.0, PLATE))
            .at((8.0, y, PLATE / 2.0))
            .fixed()
    };
    let start = Vec3::new(1.0, 0.2, PLATE + 0.5);
    let cube = Specimen::cube("cube")
        .at(start)
        .rough(0.0)
        .moving(Vec3::X * SPEED as f32);
    let specimens = [plate("left", -1.0), plate("right", 1.0), cube];
    let mut world = SmallWorld::new(SHIPPED, &specimens);
    world.seconds(14.0 / SPEED);
    let off = world.location("cube") - start.as_dvec3();
    vec![
        Measurement::close("speed", "v", SPEED, world.velocity("cube").x, 0.01),
        Measurement::none("change of height", off.z.abs(), 0.01),
        Measurement::none("way aside", off.y.abs(), 0.01),
    ]
}

/// A cube with friction that stops beyond a joint.
fn rough() -> Vec<Measurement> {
    let mut specimens = tiles(2);
    let start = Vec3::new(7.0, 0.0, PLATE + 0.5);
    let cube = Specimen::cube("cube")
        .at(start)
        .moving(Vec3::X * SPEED as f32);
    specimens.push(cube);
    let mut world = SmallWorld::new(SHIPPED, &specimens);
    world.seconds(2.0);
    let way = world.location("cube").x - f64::from(start.x);
    let friction = f64::from(SHIPPED.friction).powi(2);
    let expected = SPEED * SPEED / (2.0 * friction * G);
    vec![Measurement::close("way", "v²/2μg", expected, way, 0.02)]
}
