//! A program that drives a robot in real time.

use std::{
    thread,
    time::{Duration, Instant},
};

use tabletop_bridge::{
    Address, Bridge, BridgeOptions, BridgeProfile, LimbTarget, RobotState, RobotTarget, StopReason,
    WatchdogState,
};

/// How long anything may take before a test has failed.
const PATIENCE: Duration = Duration::from_secs(20);

/// The time from target to target.
const PERIOD: Duration = Duration::from_millis(10);

/// How often a test is tried on a machine that is so busy that program or watchdog are late, which is no fault of the bridge.
const TRIES: usize = 6;

/// This machine stood still.
#[derive(Debug)]
pub struct Busy(StopReason);

/// A robot that is driven.
pub struct Drive(pub Bridge);

/// Does it again if the machine was busy.
pub fn retried(test: impl Fn() -> Result<(), Busy>) {
    for _ in 1..TRIES {
        if test().is_ok() {
            return;
        }
    }
    if let Err(Busy(reason)) = test() {
        panic!("this machine is too busy: {reason}");
    }
}

/// Waits until a condition holds.
pub fn wait_until(holds: impl Fn() -> bool) {
    let start = Instant::now();
    while !holds() {
        assert!(start.elapsed() < PATIENCE, "it has not come about");
        thread::sleep(PERIOD / 5);
    }
}

/// A target of a limb's first joint, in rad/s.
pub fn first_joint(limb: &str, speed: f64) -> RobotTarget {
    let mut speeds = vec![0.0; 7];
    speeds[0] = speed;
    RobotTarget {
        limbs: [(limb.to_owned(), LimbTarget::Velocities(speeds))].into(),
        ..RobotTarget::default()
    }
}

impl Drive {
    pub fn begin(address: &Address, profile: &BridgeProfile, options: &BridgeOptions) -> Self {
        let mut bridge = Bridge::connect(address, profile, options).unwrap();
        let start = Instant::now();
        while let Err(refusal) = bridge.arm() {
            assert!(start.elapsed() < PATIENCE, "{refusal}");
            thread::sleep(PERIOD);
        }
        Self(bridge)
    }

    /// Drives until a condition holds.
    pub fn until(
        &mut self,
        target: &RobotTarget,
        holds: impl Fn(&RobotState) -> bool,
    ) -> Result<(), Busy> {
        let start = Instant::now();
        while !holds(&self.0.state()) {
            if let Err(refusal) = self.0.aim(target.clone()) {
                return match self.reason() {
                    Some(reason) => Err(busy(reason)),
                    None => panic!("{refusal}"),
                };
            }
            assert!(
                start.elapsed() < PATIENCE,
                "it has not come about: {:?}",
                self.0.state()
            );
            thread::sleep(PERIOD);
        }
        Ok(())
    }

    /// Drives until the watchdog stops the robot.
    pub fn until_stopped(&mut self, target: &RobotTarget) {
        let start = Instant::now();
        while self.0.aim(target.clone()).is_ok() {
            assert!(start.elapsed() < PATIENCE, "nothing has stopped it");
            thread::sleep(PERIOD);
        }
    }

    /// Sets no target until the watchdog stops the robot.
    pub fn until_the_watchdog_stops(&self) {
        wait_until(|| self.reason().is_some());
    }

    /// Ends, for this reason.
    pub fn stop(self, expected: StopReason) -> Result<(), Busy> {
        self.stop_by(|reason| *reason == expected)
    }

    /// Ends, for such a reason.
    pub fn stop_by(self, is_expected: impl Fn(&StopReason) -> bool) -> Result<(), Busy> {
        let reason = self.0.stop();
        match is_expected(&reason) {
            true => Ok(()),
            false => Err(busy(reason)),
        }
    }

    fn reason(&self) -> Option<StopReason> {
        match self.0.watchdog() {
            WatchdogState::Ramping(reason) | WatchdogState::Held(reason) => Some(reason),
            WatchdogState::Watching | WatchdogState::Armed => None,
        }
    }
}

/// Lateness is the machine's; any other reason is a failure.
fn busy(reason: StopReason) -> Busy {
    match reason {
        StopReason::ProgramLate { .. }
        | StopReason::WatchdogLate { .. }
        | StopReason::StaleState { .. } => Busy(reason),
        StopReason::Asked
        | StopReason::Interrupted(_)
        | StopReason::SilentHealth { .. }
        | StopReason::Jump(_)
        | StopReason::Unfollowed { .. }
        | StopReason::Unheard { .. }
        | StopReason::GripperError { .. }
        | StopReason::SilentGripper { .. }
        | StopReason::EmergencyStop
        | StopReason::Disabled
        | StopReason::RobotError
        | StopReason::Deviation { .. }
        | StopReason::Disconnected(_) => panic!("{reason}"),
    }
}
