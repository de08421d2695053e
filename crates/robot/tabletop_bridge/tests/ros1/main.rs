//! The native way, with a mock Baxter on the genuine rospy and rosmaster.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

#[path = "../driving/mod.rs"]
mod driving;
mod killed;
mod mock;

use std::process::ExitCode;

use tabletop_bridge::{
    Bridge, BridgeOptions, BridgeProfile, LimbTarget, PictureFeed, RobotState, RobotTarget, Shadow,
    StopReason,
};
use tabletop_harness::test_with;

use crate::{
    driving::{Drive, first_joint, retried},
    mock::MockBaxter,
};

fn main() -> ExitCode {
    if killed::is_program() {
        return ExitCode::SUCCESS;
    }
    tabletop_harness::run()
}

fn profile() -> BridgeProfile {
    BridgeProfile::shipped("baxter").unwrap()
}

fn right_arm() -> BridgeOptions {
    BridgeOptions {
        limbs: vec!["right".into()],
        speed: 1.0,
        ..BridgeOptions::default()
    }
}

#[test_with(Rospy)]
fn a_shadow_sees_the_robot_and_moves_nothing() {
    let mut baxter = MockBaxter::start();
    let shadow = Shadow::connect(&baxter.address(), &profile()).unwrap();
    let state = shadow.state();
    assert_eq!(state.joints.len(), 15);
    assert_eq!(state.joints["right_w2"].position, 0.5);
    assert_eq!(state.nonsense, 0);
    // States keep coming.
    let first = state.joints_at;
    driving::wait_until(|| shadow.state().joints_at > first && shadow.state().grippers.len() == 2);
    drop(shadow);
    assert!(baxter.report().modes.values().all(Vec::is_empty));
}

#[test_with(Rospy)]
fn an_arm_turns_at_its_speed_and_is_held() {
    retried(|| {
        let mut baxter = MockBaxter::start();
        let mut drive = Drive::begin(&baxter.address(), &profile(), &right_arm());
        drive.until(&first_joint("right", 0.5), |state| {
            state.joints["right_s0"].position > 0.9
        })?;
        let moving = baxter.report();
        assert_eq!(moving.time_limits, [0.2, 0.1]);
        assert_eq!(moving.ratios, [0.3, 1.0]);
        assert!(moving.modes["right"].iter().all(|mode| *mode == 2));
        drive.stop(StopReason::Asked)?;
        let held = baxter.report();
        assert!((0.9..1.3).contains(&held.angles["right_s0"]), "{held:?}");
        assert_eq!(held.time_limits, [0.2, 0.2]);
        assert_eq!(held.modes["right"].last(), Some(&1));
        assert_eq!((held.modes["left"].len(), held.dropped), (0, 0));
        assert_eq!(held.angles["right_s1"], 0.5);
        Ok(())
    });
}

#[test_with(Rospy)]
fn a_limit_is_approached_and_no_command_is_dropped() {
    retried(|| {
        let mut baxter = MockBaxter::start();
        let mut drive = Drive::begin(&baxter.address(), &profile(), &right_arm());
        drive.until(&first_joint("right", 1.5), |state| {
            state.joints["right_s0"].position > 1.69
        })?;
        drive.stop(StopReason::Asked)?;
        assert_eq!(baxter.report().dropped, 0);
        Ok(())
    });
}

#[test_with(Rospy)]
fn positions_gripper_and_head_are_reached() {
    retried(|| {
        let mut baxter = MockBaxter::start();
        let options = BridgeOptions {
            allow_moves: true,
            calibrate: true,
            ..right_arm()
        };
        let mut drive = Drive::begin(&baxter.address(), &profile(), &options);
        let is_calibrated = |state: &RobotState| {
            state
                .grippers
                .get("right")
                .is_some_and(|it| it.is_calibrated)
        };
        drive.until(&RobotTarget::default(), is_calibrated)?;
        let goal = [0.2, 0.1, 0.9, 0.8, -0.3, 0.6, 1.5];
        let target = RobotTarget {
            limbs: [("right".to_owned(), LimbTarget::Positions(goal.into()))].into(),
            grippers: [("right".to_owned(), 0.4)].into(),
            head: Some(0.3),
        };
        drive.until(&target, |state| {
            let joints = &profile().limbs[1].joints;
            let arm_is_there = joints
                .iter()
                .zip(goal)
                .all(|(joint, goal)| (state.joints[&joint.name].position - goal).abs() < 0.01);
            let opening = state.grippers["right"].opening;
            arm_is_there && opening == 0.4 && (state.joints["head_pan"].position - 0.3).abs() < 1e-6
        })?;
        drive.stop(StopReason::Asked)?;
        let report = baxter.report();
        assert!(
            report.modes["right"]
                .iter()
                .filter(|mode| **mode == 2)
                .count()
                < report.modes["right"].len()
        );
        assert_eq!(report.openings, [100.0, 40.0]);
        assert!((report.head - 0.3).abs() < 1e-6);
        Ok(())
    });
}

#[test_with(Rospy)]
fn an_emergency_stop_ends_the_commands() {
    retried(|| {
        let mut baxter = MockBaxter::start();
        let mut drive = Drive::begin(&baxter.address(), &profile(), &right_arm());
        drive.until(&first_joint("right", 0.5), |state| {
            state.joints["right_s0"].position > 0.6
        })?;
        baxter.order("estop");
        drive.until_stopped(&first_joint("right", 0.5));
        let report = baxter.report();
        let known = report.modes["right"].len();
        let last = report.log["right"].last().map_or(0.0, |(time, _)| *time);
        let late = last - report.stopped_at;
        assert!(late < 0.25, "{late}");
        drive.stop(StopReason::EmergencyStop)?;
        let then = baxter.order("reset");
        assert_eq!(then.modes["right"].len(), known);
        assert!(!then.enabled);
        Ok(())
    });
}

#[test_with(Rospy)]
fn silence_and_a_stuck_arm_stop_it() {
    for (order, is_reason) in [
        (
            "silence",
            (|reason| matches!(reason, StopReason::StaleState { .. })) as fn(&StopReason) -> bool,
        ),
        (
            "stick",
            |reason| matches!(reason, StopReason::Unfollowed { joint } | StopReason::Deviation { joint, .. } if joint == "right_s0"),
        ),
        ("error", |reason| *reason == StopReason::RobotError),
    ] {
        retried(|| {
            let mut baxter = MockBaxter::start();
            let mut drive = Drive::begin(&baxter.address(), &profile(), &right_arm());
            drive.until(&first_joint("right", 0.8), |state| {
                state.joints["right_s0"].position > 0.6
            })?;
            baxter.order(order);
            drive.until_stopped(&first_joint("right", 0.8));
            drive.stop_by(is_reason)?;
            let held = baxter.report().angles["right_s0"];
            assert_eq!(baxter.report().angles["right_s0"], held, "{order}");
            Ok(())
        });
    }
}

#[test_with(Rospy)]
fn a_program_that_falls_silent_stops_it() {
    let mut baxter = MockBaxter::start();
    let mut drive = Drive::begin(&baxter.address(), &profile(), &right_arm());
    drive.0.aim(first_joint("right", 0.5)).unwrap();
    drive.until_the_watchdog_stops();
    drive
        .stop_by(|reason| matches!(reason, StopReason::ProgramLate { .. }))
        .unwrap();
    assert_eq!(baxter.report().modes["right"].last(), Some(&1));
}

#[test_with(Rospy)]
fn a_camera_is_opened_and_its_pictures_come() {
    let mut baxter = MockBaxter::start();
    let feed = PictureFeed::connect(&baxter.address(), &profile(), "head").unwrap();
    let opened = ("head_camera".to_owned(), 640, 400, vec![107, 108]);
    assert_eq!(baxter.report().opened, Some(opened));
    driving::wait_until(|| feed.latest().is_some());
    let picture = feed.latest().unwrap();
    assert_eq!((picture.width, picture.height), (640, 400));
    assert!(
        picture
            .rgb
            .chunks_exact(3)
            .all(|pixel| pixel == [30, 20, 10])
    );
}

#[test_with(Rospy)]
fn motors_are_switched_on_only_with_leave() {
    let mut baxter = MockBaxter::start();
    baxter.order("disable");
    let refused = Bridge::connect(&baxter.address(), &profile(), &right_arm());
    assert_eq!(
        refused.unwrap_err().to_string(),
        "Baxter cannot be driven: the robot's motors are off"
    );
    assert!(!baxter.report().enabled);
    let options = BridgeOptions {
        enable: true,
        ..right_arm()
    };
    drop(Bridge::connect(&baxter.address(), &profile(), &options).unwrap());
    assert!(baxter.report().enabled);
}
