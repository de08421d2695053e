//! Benchmark of the robot: its cost in a tick without a window, on one core.
//!
//! `cargo bench --bench robot_speed` prints the median time of a tick of the whole simulator with ten blocks on the table:
//! with the robot hidden, shown and still, and with all fourteen joints of its arms moving, in both modes; and the
//! difference from the hidden robot. All run in turns in one process, so that other loads on the machine affect
//! all of them. `-- moving` runs only the cases with this in their names, for a profiler.
#![expect(clippy::print_stdout, reason = "a benchmark prints its results")]

use std::time::{Duration, Instant};

use bevy::prelude::*;
use tabletop::{
    core::{Drive, RobotLayout, RobotMode},
    prelude::*,
    robot::RobotPlugin,
};

const TICKS_PER_TURN: u32 = 60;
const TURNS: usize = 40;

fn main() {
    let named = std::env::args().skip(1).find(|arg| !arg.starts_with('-'));
    let cases = [
        ("hidden", RobotMode::Kinematic, false, false),
        ("shown, still", RobotMode::Kinematic, true, false),
        ("both arms moving", RobotMode::Kinematic, true, true),
        ("still, dynamic", RobotMode::Dynamic, true, false),
        ("moving, dynamic", RobotMode::Dynamic, true, true),
    ];
    let mut cases: Vec<_> = cases
        .into_iter()
        .filter(|(name, ..)| named.as_ref().is_none_or(|named| name.contains(named)))
        .map(|(name, mode, is_shown, moves)| Case::new(name, mode, is_shown, moves))
        .collect();
    for _ in 0..TURNS {
        for case in &mut cases {
            case.take_turn();
        }
    }
    println!("robot               a tick   more than hidden");
    let least = cases.iter_mut().map(Case::median).min();
    let hidden = least.unwrap_or_default();
    for case in &mut cases {
        let tick = case.median();
        let more = (tick.as_secs_f64() - hidden.as_secs_f64()) * 1e6;
        let tick = tick.as_secs_f64() * 1e6;
        println!("{:18} {tick:6.1} µs {more:8.1} µs", case.name);
    }
}

struct Case {
    name: &'static str,
    app: App,
    moves: bool,
    tick: u64,
    times: Vec<Duration>,
}

impl Case {
    fn new(name: &'static str, mode: RobotMode, is_shown: bool, moves: bool) -> Self {
        let robot = RobotPlugin { mode, ..default() };
        let mut app = headless_app_with(TabletopSimPlugins.build().set(robot));
        let blocks = (0..10).map(|block| {
            let pose = Pose::at(Vec3::new(block as f32 * 1.5 - 7.0, 4.0, 0.5));
            let shape = Shape::Block {
                span: Vec3::ONE,
                color: Rgb::GRAY,
            };
            SceneItem::Object(ObjectSpec::new(format!("block{block}"), pose, 1.0, shape))
        });
        let scene = SceneSpec {
            items: blocks.collect(),
            ..default()
        };
        app.world_mut()
            .write_command(SceneCommand::Set(Box::new(scene)));
        app.world_mut().write_command(RobotCommand::Show(is_shown));
        app.step(60);
        Self {
            name,
            app,
            moves,
            tick: 0,
            times: Vec::new(),
        }
    }

    fn take_turn(&mut self) {
        let start = Instant::now();
        for _ in 0..TICKS_PER_TURN {
            if self.moves {
                self.swing();
            }
            self.app.step(1);
        }
        self.times.push(start.elapsed() / TICKS_PER_TURN);
    }

    /// Moves every joint of both arms, to and fro.
    fn swing(&mut self) {
        let forth = (self.tick / 60).is_multiple_of(2);
        self.tick += 1;
        let speed = if forth { 0.3 } else { -0.3 };
        let layout = self.app.world().resource::<RobotLayout>();
        let joints = layout.limbs.iter().flat_map(|limb| &limb.joints);
        let drives = joints.map(|&joint| {
            let joint = layout.joint(joint);
            (joint.name, Drive::Velocity(-joint.sign * speed))
        });
        let command = RobotCommand::drive(drives);
        self.app.world_mut().write_command(command);
    }

    fn median(&mut self) -> Duration {
        self.times.sort();
        self.times[self.times.len() / 2]
    }
}
