//! Many balls.

use bevy::math::Vec3;
use tabletop_core::Shape;
use tabletop_geometry::Rgb;
use tabletop_physics::PhysicsSettings;

use crate::{
    experiment::Experiment,
    measurement::Measurement,
    small_world::{G, SHIPPED, SmallWorld, UNDAMPED},
    specimen::Specimen,
};

pub(crate) const EXPERIMENTS: &[Experiment] = &[
    Experiment::new("crowd-bounces", bounce),
    Experiment::new("crowd-settles", settle),
];

/// 49 elastic balls in a square that fall on the table.
fn bounce() -> Vec<Measurement> {
    const RADIUS: f32 = 0.5;
    let balls: Vec<_> = (0..49)
        .map(|number| {
            let (row, column) = ((number / 7) as f32, (number % 7) as f32);
            let place = Vec3::new(1.5 * column - 4.5, 1.5 * row - 4.5, 2.0 + RADIUS);
            Specimen::ball(format!("ball{number}"), RADIUS).at(place)
        })
        .collect();
    let settings = PhysicsSettings {
        restitution: 1.0,
        ..UNDAMPED
    };
    let mut world = SmallWorld::new(settings, &balls);
    let at_rest = 49.0 * G * f64::from(RADIUS);
    let energy = |world: &SmallWorld| {
        let all = balls.iter().map(|ball| world.energy(ball)).sum::<f64>();
        all - at_rest
    };
    let first = energy(&world);
    let mut most = first;
    world.watch(10.0, |world| most = most.max(energy(world)));
    let last = energy(&world);
    vec![
        Measurement::none("gain of energy", most / first - 1.0, 0.01),
        Measurement::close("energy after 10 s", "m g h", 1.0, last / first, 0.03),
    ]
}

/// 216 balls that fall into a box.
fn settle() -> Vec<Measurement> {
    const RADIUS: f32 = 0.25;
    const THICKNESS: f32 = 0.3;
    let container = Shape::Box {
        span: Vec3::new(4.0, 4.0, 5.0),
        thickness: THICKNESS,
        color: Rgb::GRAY,
    };
    let container = Specimen::new("box", container).at(Vec3::Z * 2.5).fixed();
    let balls: Vec<_> = (0..216)
        .map(|number| {
            let [x, y, z] = [number % 6, number / 6 % 6, number / 36].map(|step| step as f32);
            // Every second layer is a little aside, so that no ball stands on another.
            let shift = if number / 36 % 2 == 0 { 0.04 } else { -0.04 };
            let place = Vec3::new(x - 2.5, y - 2.5, z) * 0.53 + Vec3::new(shift, shift, 0.8);
            Specimen::ball(format!("ball{number}"), RADIUS).at(place)
        })
        .collect();
    let specimens: Vec<_> = std::iter::once(container)
        .chain(balls.iter().cloned())
        .collect();
    let mut world = SmallWorld::new(SHIPPED, &specimens);
    world.seconds(5.0);
    let places: Vec<_> = balls
        .iter()
        .map(|ball| world.location(&ball.spec.id))
        .collect();
    let radius = f64::from(RADIUS);
    let mut deepest = f64::NEG_INFINITY;
    for (number, place) in places.iter().enumerate() {
        deepest = deepest.max(radius + f64::from(THICKNESS) - place.z);
        for other in &places[..number] {
            deepest = deepest.max(2.0 * radius - place.distance(*other));
        }
    }
    let outside = places
        .iter()
        .filter(|place| place.x.abs().max(place.y.abs()) > 1.7 || place.z < 0.3)
        .count();
    let fastest = balls
        .iter()
        .map(|ball| world.velocity(&ball.spec.id).length())
        .fold(0.0, f64::max);
    vec![
        Measurement::none("penetration/radius", deepest.max(0.0) / radius, 0.02),
        Measurement::none("balls outside", outside as f64, 0.5),
        Measurement::none("fastest after 5 s", fastest, 0.1),
    ]
}
