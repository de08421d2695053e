//! Fastened composites, which hold like one piece.

use bevy::math::Vec3;
use tabletop_core::{BondEnd, BondPoint, GuestPoint, HostPoint, Part, Shape, TightnessStep};
use tabletop_geometry::{Pose, Rgb};

use crate::{
    experiment::Experiment,
    measurement::Measurement,
    small_world::{SHIPPED, SmallWorld},
    specimen::Specimen,
};

pub(crate) const EXPERIMENTS: &[Experiment] = &[
    Experiment::new("bonds-beam", || beam(None)),
    Experiment::new("bonds-beam-10-kg", || beam(Some(10.0))),
    Experiment::new("bonds-column-100-kg", || column(100.0)),
];

/// The number of fastened cubes.
const CUBES: usize = 5;

/// A cube of 1 unit with a point of a bond on each of two sides, fastened to the cube before it.
fn link(number: usize, direction: Vec3) -> Specimen {
    let block = Shape::Block {
        span: Vec3::ONE,
        color: Rgb::GRAY,
    };
    let point = |id: &str, side: f32, end| {
        let point = BondPoint {
            fit: "face".into(),
            end,
        };
        let id = format!("{id}{number}");
        Part::new(
            id,
            Pose::at(direction * side / 2.0),
            Shape::BondPoint(point),
        )
    };
    let host = BondEnd::Host(HostPoint {
        steps: vec![TightnessStep::default()],
        ..Default::default()
    });
    let guest = BondEnd::Guest(match number.checked_sub(1) {
        Some(before) => GuestPoint {
            host: format!("host{before}"),
            tightness: 1,
        },
        None => GuestPoint::default(),
    });
    let parts = vec![
        Part::new("", Pose::IDENTITY, block),
        point("host", 1.0, host),
        point("guest", -1.0, guest),
    ];
    Specimen::new(format!("cube{number}"), Shape::Composite { parts })
}

/// The greatest distance of points that are fastened to each other.
fn gap(world: &SmallWorld, count: usize, direction: Vec3) -> f64 {
    let end = |number: usize, side: f32| {
        let pose = world.pose(&format!("cube{number}"));
        (pose * (direction * side / 2.0)).as_dvec3()
    };
    (1..count)
        .map(|number| end(number - 1, 1.0).distance(end(number, -1.0)))
        .fold(0.0, f64::max)
}

/// Five cubes fastened to a fixed one, in a row, perhaps with a load on the last, after 5 s.
fn beam(load: Option<f32>) -> Vec<Measurement> {
    const HEIGHT: f32 = 5.0;
    let mut specimens: Vec<_> = (0..=CUBES)
        .map(|number| link(number, Vec3::X).at((number as f32, 0.0, HEIGHT)))
        .collect();
    specimens[0].spec.mass = 0.0;
    specimens.extend(load.map(|mass| {
        Specimen::cube("load")
            .at((CUBES as f32, 0.0, HEIGHT + 1.0))
            .weighing(mass)
    }));
    let mut world = SmallWorld::new(SHIPPED, &specimens);
    let mut sag: f64 = 0.0;
    world.watch(5.0, |world| {
        let last = world.location(&format!("cube{CUBES}")).z;
        sag = sag.max((f64::from(HEIGHT) - last).abs());
    });
    vec![
        Measurement::none("sag", sag, 0.01),
        Measurement::none("gap", gap(&world, CUBES + 1, Vec3::X), 0.01),
    ]
}

/// Five cubes fastened on each other, under a load, after 5 s.
fn column(load: f32) -> Vec<Measurement> {
    let mut specimens: Vec<_> = (0..CUBES)
        .map(|number| link(number, Vec3::Z).at(Vec3::Z * (number as f32 + 0.5)))
        .collect();
    let top = CUBES as f32 + 0.5;
    specimens.push(Specimen::cube("load").at(Vec3::Z * top).weighing(load));
    let mut world = SmallWorld::new(SHIPPED, &specimens);
    world.seconds(5.0);
    let height = world.location("load").z;
    vec![
        Measurement::near(
            "height of the load",
            "5 + 1/2",
            f64::from(top),
            height,
            0.01,
        ),
        Measurement::none("gap", gap(&world, CUBES, Vec3::Z), 0.01),
    ]
}
