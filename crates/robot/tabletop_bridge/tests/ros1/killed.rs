//! A program that is killed while it drives: the robot stops by the time limit that it was given.

use std::{
    env,
    process::{Child, Command, Stdio},
};

use tabletop_bridge::Address;
use tabletop_harness::test_with;

use crate::{
    driving::{Drive, first_joint, wait_until},
    mock::MockBaxter,
    profile, right_arm,
};

/// The variable with the address of the robot that the program drives until it is killed.
const ADDRESS: &str = "TABLETOP_BRIDGE_DRIVES";

/// In rad/s.
const SPEED: f64 = 0.5;

/// True if this process was the program to be killed, which has then ended by itself.
pub fn is_program() -> bool {
    let Ok(address) = env::var(ADDRESS) else {
        return false;
    };
    let address: Address = address.parse().unwrap();
    let mut drive = Drive::begin(&address, &profile(), &right_arm());
    drop(drive.until(&first_joint("right", SPEED), |_| false));
    true
}

#[test_with(Rospy)]
fn a_killed_program_lets_the_arm_run_on_no_farther_than_its_time_limit() {
    let mut baxter = MockBaxter::start();
    let mut command = Command::new(env::current_exe().unwrap());
    let address = format!("baxter:ros://127.0.0.1:{}", baxter.port());
    command.env(ADDRESS, address).stdout(Stdio::null());
    let mut program: Child = command.spawn().unwrap();
    let angle = std::cell::RefCell::new(&mut baxter);
    let angle = || angle.borrow_mut().report().angles["right_s0"];
    wait_until(|| angle() > 0.7);
    program.kill().unwrap();
    program.wait().unwrap();
    let at_death = angle();
    let mut last = at_death;
    // At rest: two reports, a tenth of a second apart at the least, are the same.
    loop {
        std::thread::sleep(std::time::Duration::from_millis(100));
        let now = angle();
        if now == last {
            break;
        }
        last = now;
    }
    // 0.1 s is the limit; the rest is the mock's own period and the machine's.
    assert!(last - at_death < SPEED * 0.25, "{}", last - at_death);
}
