//! A controller of one's own: the robot waves for five seconds, without a window:
//! `cargo run --release --example wave`.
#![expect(clippy::print_stdout, reason = "an example shows what it does")]

use bevy::prelude::*;
use tabletop::{
    controller::{Controller, Drives, RobotController, Sight},
    core::{Drive, RobotJoint},
    prelude::*,
};

/// Waves with the right arm.
#[derive(Default)]
struct Waving {
    ticks: u32,
}

impl Controller for Waving {
    fn act(&mut self, sight: &Sight) -> Drives {
        self.ticks += 1;
        if self.ticks.is_multiple_of(60) {
            let elbow = sight.limbs[1].angles[3].to_degrees();
            println!("{} s: the elbow is at {elbow:.0} degrees", self.ticks / 60);
        }
        let way = if self.ticks % 60 < 30 { 1.0 } else { -1.0 };
        vec![
            (RobotJoint::RightE1.name(), Drive::Velocity(way)),
            (RobotJoint::RightW1.name(), Drive::Velocity(-way)),
        ]
    }
}

fn main() {
    let mut app = headless_app();
    app.world_mut().write_command(RobotCommand::Show(true));
    app.insert_resource(RobotController::new(Waving::default()));
    app.step(300);
}
