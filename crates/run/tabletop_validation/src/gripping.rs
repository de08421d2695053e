//! Blocks that friction holds between two bodies.

use std::f32::consts::FRAC_PI_2;

use bevy::math::{Quat, Vec3};
use tabletop_core::{JointedSpec, PressMode, PushButton, SceneItem};
use tabletop_geometry::{Pose, Rgb};

use crate::{
    experiment::Experiment,
    measurement::Measurement,
    small_world::{G, SHIPPED, SmallWorld},
    specimen::Specimen,
};

pub(crate) const EXPERIMENTS: &[Experiment] = &[Experiment::new("grip-by-spring", spring)];

/// The heaviest of many blocks, 2 % apart, that stays between a wall and a pressed cap of a button, whose spring pushes with N.
fn spring() -> Vec<Measurement> {
    const PERCENT: i32 = 30;
    const STEP: i32 = 2;
    const TRAVEL: f32 = 0.4;
    const RADIUS: f32 = 0.4;
    // In N; a spring pushes half as hard at rest as at the end, and here is pressed halfway.
    const FORCE: f32 = 40.0;
    let force = 0.75 * f64::from(FORCE) * 10.0;
    let friction = f64::from(SHIPPED.friction).powi(2);
    let heaviest = 2.0 * friction * force / G;
    let mass = |percent: i32| heaviest * (1.0 + f64::from(percent) / 100.0);
    let mut items = Vec::new();
    for percent in (-PERCENT..=PERCENT).step_by(STEP as usize) {
        let y = 3.0 * (percent / STEP) as f32;
        let button = PushButton {
            radius: RADIUS,
            zspan: 1.0,
            travel: TRAVEL,
            force: FORCE,
            color: Rgb::GRAY,
            mode: PressMode::Held,
            state: 1,
        };
        // The button looks along X.
        let pose = Pose::new(Vec3::new(0.0, y, 5.0), Quat::from_rotation_y(FRAC_PI_2));
        let jointed: JointedSpec =
            button.jointed(&format!("cap{percent}"), pose, 0.0, TRAVEL / 2.0);
        let [_, cap] = jointed.placed();
        let face = cap.shape.bounds(cap.pose).high.x;
        items.push(SceneItem::Jointed(jointed));
        let block = Specimen::block(format!("block{percent}"), Vec3::ONE)
            .at((face + 0.5, y, 5.0))
            .weighing(mass(percent) as f32);
        let wall = Specimen::block(format!("wall{percent}"), (1.0, 2.0, 4.0))
            .at((face + 1.5, y, 5.0))
            .fixed();
        items.extend([block, wall].map(|specimen| SceneItem::Object(specimen.spec)));
    }
    let mut world = SmallWorld::with_items(SHIPPED, items);
    world.seconds(2.0);
    let holds = |percent: &i32| {
        let height = world.location(&format!("block{percent}")).z;
        (height - 5.0).abs() < 0.1
    };
    let held = (-PERCENT..=PERCENT)
        .step_by(STEP as usize)
        .take_while(holds)
        .last()
        .unwrap_or(-100);
    vec![Measurement::close(
        "heaviest block",
        "2 μ N/g",
        heaviest,
        mass(held),
        0.03,
    )]
}
