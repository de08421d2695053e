//! Random demonstrations.

use bevy::prelude::*;
use tabletop::{
    core::{ChainSpec, Drive, LidBoxSpec},
    prelude::*,
};

use crate::mechanisms;

/// A small random stream (SplitMix64).
pub struct Random(pub u64);

impl Random {
    pub fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % limit as u64) as usize
    }

    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.below(10_000) as f32 / 10_000.0
    }

    pub fn of<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.below(choices.len())]
    }
}

const IDS: [&str; 20] = [
    "block0",
    "block1",
    "block2",
    "block3",
    "block4",
    "ball",
    "wall",
    "log",
    "c-link2",
    "c-link5",
    "c-start",
    "b-lid",
    "b-box",
    "largeblock",
    "smallblock",
    "container",
    "panel",
    "screw",
    "nut",
    "dial",
];

fn object(id: &str, location: (f32, f32, f32), mass: f32, shape: Shape) -> SceneItem {
    SceneItem::Object(ObjectSpec::new(id, Pose::at(location.into()), mass, shape))
}

/// A table with something of everything on it, much of it falling.
pub fn scene() -> SimCommand {
    let color = Rgb::GRAY;
    let span = Vec3::ONE;
    let mut items: Vec<_> = (0..5)
        .map(|i| {
            let location = (-5.0, 0.0, i as f32 * 1.2 + 0.6);
            object(
                &format!("block{i}"),
                location,
                1.0,
                Shape::Block { span, color },
            )
        })
        .collect();
    let (radius, yspan) = (0.5, 2.0);
    items.extend([
        object(
            "ball",
            (-5.2, 0.2, 12.0),
            1.0,
            Shape::Sphere { radius, color },
        ),
        object(
            "log",
            (-1.0, 3.0, 3.0),
            1.0,
            Shape::Cylinder {
                radius,
                yspan,
                color,
            },
        ),
        object(
            "wall",
            (-2.0, 0.0, 1.0),
            0.0,
            Shape::Block {
                span: Vec3::new(0.2, 6.0, 2.0),
                color,
            },
        ),
        SceneItem::Chain(ChainSpec {
            id: "c".into(),
            start: Vec3::new(-6.0, -4.0, 4.0),
            end: Vec3::new(1.0, -4.0, 4.0),
            link_span: Vec3::new(0.1, 1.0, 0.1),
            link_count: 8,
            link_padding: 0.05,
            link_mass: 1.0,
            color,
        }),
        SceneItem::LidBox(LidBoxSpec {
            id: "b".into(),
            pose: Pose::at(Vec3::new(5.0, 0.0, 2.5)),
            span: Vec3::new(4.0, 4.0, 5.0),
            thickness: 0.4,
            box_mass: 9.0,
            lid_mass: 1.0,
            color,
            handle_span: Vec3::ONE,
            handle_thickness: 0.2,
            handle_color: color,
            descriptions: Vec::new(),
        }),
    ]);
    items.extend(mechanisms::items(Vec3::new(0.0, 2.5, 4.0)));
    SimCommand::Scene(SceneCommand::Set(Box::new(SceneSpec {
        items,
        ..default()
    })))
}

pub fn hand_command(random: &mut Random) -> SimCommand {
    let hand = random.of(&Hand::ALL);
    match random.below(8) {
        0..=2 => SimCommand::Hand(HandCommand::Grasp {
            hand,
            object: random.of(&IDS).into(),
        }),
        3 => SimCommand::Hand(HandCommand::Turn {
            hand,
            axis: random.of(&[Vec3::X, Vec3::Y, Vec3::Z]),
            degrees: random.between(-90.0, 90.0),
        }),
        4 => SimCommand::Hand(HandCommand::Release(hand)),
        5 if random.below(3) == 0 => SimCommand::Hand(HandCommand::Destroy(hand)),
        _ => SimCommand::Hand(HandCommand::MoveTo {
            hand,
            location: Vec3::new(
                random.between(-9.0, 9.0),
                random.between(-5.0, 5.0),
                random.between(-1.0, 7.0),
            ),
        }),
    }
}

pub fn robot_command(random: &mut Random) -> SimCommand {
    let joint = random.of(&RobotJoint::ALL);
    let speed = f64::from(random.between(-3.0, 3.0));
    let arm = random.of(&Arm::BOTH);
    match random.below(8) {
        0 => SimCommand::Robot(RobotCommand::Show(random.below(4) != 0)),
        1 => SimCommand::Robot(RobotCommand::drive([(joint, Drive::Velocity(speed))])),
        2 => SimCommand::Robot(RobotCommand::drive([(joint, Drive::Position(speed))])),
        3 => SimCommand::Robot(RobotCommand::drive([(
            RobotJoint::gripper(arm),
            Drive::Toward(0.0),
        )])),
        4 | 5 => SimCommand::Robot(RobotCommand::ReachTo {
            arm: arm.name(),
            pose: Pose::at(Vec3::new(
                random.between(-5.0, 5.0),
                random.between(-5.0, -1.0),
                random.between(0.9, 3.0),
            )),
        }),
        _ => SimCommand::Robot(RobotCommand::drive([(joint, Drive::Toward(speed))])),
    }
}

pub fn scene_command(random: &mut Random) -> SimCommand {
    let preset = random.of(&[Preset::BigBlock, Preset::Stack(2), Preset::BoxContainer]);
    match random.below(8) {
        0 => SimCommand::Scene(SceneCommand::Clear),
        _ => SimCommand::Scene(SceneCommand::Make {
            preset,
            seed: random.below(1000) as u64,
        }),
    }
}

/// Commands for each tick.
pub fn script(random: &mut Random, ticks: u64) -> Vec<Vec<SimCommand>> {
    (0..ticks)
        .map(|_| match random.below(6) {
            0 => vec![hand_command(random)],
            1 if random.below(2) == 0 => vec![robot_command(random)],
            2 if random.below(8) == 0 => vec![scene_command(random)],
            3 if random.below(2) == 0 => vec![mechanisms::command(random).into()],
            _ => Vec::new(),
        })
        .collect()
}
