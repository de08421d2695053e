//! Scripts that drive the robot, in a real GNU Octave and a real Python; and a real ROS 1 in place of the robot.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

#[path = "../recording/demonstration.rs"]
#[expect(dead_code, reason = "these tests need a part of it")]
mod demonstration;
mod examples;
mod guarded_ways;
mod panda;
mod real_robot;
mod scripts;
mod slow_script;
#[path = "../cli/support.rs"]
#[expect(dead_code, reason = "these tests need a part of it")]
mod support;
#[path = "../recording/window.rs"]
#[expect(dead_code, reason = "these tests need a part of it")]
mod window;

use std::process::ExitCode;

fn main() -> ExitCode {
    tabletop_harness::run()
}
