//! Scenes and commands of which nobody has thought, simulated for two seconds.

use bevy::math::{Quat, Vec3};
use bevy::prelude::{App, PluginGroup as _, Transform, default};
use tabletop::{
    core::{ObjectIndex, Part},
    geometry::Twist,
    headless_app_with,
    prelude::*,
    recorder::{RecorderPlugin, UnrecordedPlugin},
};

use crate::mutation::Random;

const TICKS: u64 = 120;

/// Largest number of objects of a scene, mostly.
const FEW: usize = 2;

/// Largest number of objects of a scene. While scenes had up to a dozen, which stand in one another, they took five times as long on average.
const MANY: usize = 12;

/// Number of scenes after which a new app is made.
const SCENES_PER_APP: u32 = 200;

pub fn start() -> Box<dyn FnMut(&[u8])> {
    let mut app = app();
    let mut scenes = 0;
    Box::new(move |bytes| {
        scenes += 1;
        if scenes % SCENES_PER_APP == 0 {
            app = self::app();
        }
        // The bytes are only the seed of randomness.
        let seed = bytes.iter().fold(0_u64, |seed, &byte| {
            (seed ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        });
        attempt(&mut app, &mut Random::new(seed, bytes.len() as u64));
    })
}

fn app() -> App {
    let plugins = TabletopSimPlugins.build();
    headless_app_with(plugins.disable::<RecorderPlugin>().add(UnrecordedPlugin))
}

fn attempt(app: &mut App, random: &mut Random) {
    let scene = scene(random);
    let ids: Vec<String> = (0..scene.items.len()).map(|i| format!("o{i}")).collect();
    app.world_mut()
        .write_command(SceneCommand::Set(Box::new(scene)));
    app.world_mut()
        .write_command(RobotCommand::Show(random.below(4) == 0));
    for _ in 0..TICKS / 10 {
        for _ in 0..random.below(3) {
            let command = command(random, &ids);
            app.world_mut().write_command(command);
        }
        app.step(10);
        check(app);
    }
}

fn check(app: &App) {
    let world = app.world();
    for entity in world.resource::<ObjectIndex>().iter() {
        let transform = world.get::<Transform>(entity);
        let is_finite = transform.is_none_or(|transform| transform.is_finite());
        let twist = world.get::<Twist>(entity);
        let is_calm =
            twist.is_none_or(|twist| twist.linear.is_finite() && twist.angular.is_finite());
        assert!(is_finite && is_calm, "{transform:?} {twist:?}");
    }
}

/// A number in the ranges of a task file, mostly a usual one.
fn span(random: &mut Random) -> f32 {
    match random.below(12) {
        0 => 0.001,
        1 => 1000.0,
        2 => 0.02,
        3 => 30.0,
        _ => 0.2 + unit(random) * 3.0,
    }
}

fn mass(random: &mut Random) -> f32 {
    match random.below(8) {
        0 => 0.0,
        1 => 1e6,
        2 => 1e-6,
        _ => 0.1 + unit(random) * 5.0,
    }
}

/// From 0 to 1.
fn unit(random: &mut Random) -> f32 {
    random.below(10_001) as f32 / 10_000.0
}

fn point(random: &mut Random) -> Vec3 {
    let far = if random.below(20) == 0 { 1000.0 } else { 6.0 };
    let mut coordinate = || (unit(random) - 0.5) * 2.0 * far;
    Vec3::new(coordinate(), coordinate(), coordinate().abs())
}

fn pose(random: &mut Random) -> Pose {
    let location = point(random);
    let turn = match random.below(3) {
        0 => Quat::IDENTITY,
        _ => {
            let mut part = || unit(random) - 0.5;
            Quat::from_xyzw(part(), part(), part(), part() + 0.01).normalize()
        }
    };
    Pose::new(location, turn)
}

/// A shape, mostly a simple one: composites cost much more.
fn any_shape(random: &mut Random) -> Shape {
    let depth = match random.below(16) {
        0 => 2,
        1..=3 => 1,
        _ => 0,
    };
    shape(random, depth)
}

fn shape(random: &mut Random, depth: usize) -> Shape {
    let color = Rgb::GRAY;
    match random.below(if depth == 0 { 3 } else { 5 }) {
        0 | 3 => Shape::Block {
            span: Vec3::new(span(random), span(random), span(random)),
            color,
        },
        1 => Shape::Cylinder {
            radius: span(random),
            yspan: span(random),
            color,
        },
        2 => Shape::Sphere {
            radius: span(random),
            color,
        },
        _ => Shape::Composite {
            parts: (0..1 + random.below(3))
                .map(|_| Part::new("", pose(random), shape(random, depth - 1)))
                .collect(),
        },
    }
}

fn scene(random: &mut Random) -> SceneSpec {
    let most = if random.below(64) == 0 { MANY } else { FEW };
    let items = (0..1 + random.below(most)).map(|i| {
        let id = format!("o{i}");
        SceneItem::Object(ObjectSpec::new(
            id,
            pose(random),
            mass(random),
            any_shape(random),
        ))
    });
    SceneSpec {
        items: items.collect(),
        ..default()
    }
}

fn command(random: &mut Random, ids: &[String]) -> SimCommand {
    let hand = Hand::ALL[random.below(Hand::ALL.len())];
    let object = ids[random.below(ids.len())].clone();
    match random.below(9) {
        0..=2 => HandCommand::Grasp { hand, object }.into(),
        3 => HandCommand::MoveTo {
            hand,
            location: point(random),
        }
        .into(),
        4 => HandCommand::MoveBy {
            hand,
            offset: point(random) - Vec3::splat(3.0),
        }
        .into(),
        5 => HandCommand::Turn {
            hand,
            axis: [Vec3::X, Vec3::Y, Vec3::Z][random.below(3)],
            degrees: unit(random) * 360.0,
        }
        .into(),
        6 => HandCommand::Release(hand).into(),
        7 => HandCommand::Destroy(hand).into(),
        _ => RobotCommand::Show(random.below(2) == 0).into(),
    }
}
