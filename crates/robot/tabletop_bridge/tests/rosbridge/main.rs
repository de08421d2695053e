//! The way by rosbridge, with a mock server and everything that can be the matter with it.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

#[path = "../driving/mod.rs"]
mod driving;
mod mock;

use std::collections::BTreeSet;

use tabletop_bridge::{
    Bridge, BridgeError, BridgeOptions, BridgeProfile, Guard, PictureFeed, PredictedMotion,
    RobotState, Shadow, StopReason, TargetError,
};

use crate::{
    driving::{Busy, Drive, first_joint, retried, wait_until},
    mock::{MockServer, Trouble},
};

fn profile(name: &str) -> BridgeProfile {
    BridgeProfile::shipped(name).unwrap()
}

fn left_arm() -> BridgeOptions {
    BridgeOptions {
        limbs: vec!["left".into()],
        speed: 1.0,
        ..BridgeOptions::default()
    }
}

fn begin(server: &MockServer) -> Drive {
    Drive::begin(&server.address(), &profile("baxter"), &left_arm())
}

/// A drive at 0.8 rad/s that is under way.
fn under_way(server: &MockServer) -> Result<Drive, Busy> {
    let mut drive = begin(server);
    drive.until(&first_joint("left", 0.8), |state| {
        state.joints["left_s0"].position > 0.1
    })?;
    Ok(drive)
}

/// What happens when something becomes the matter under way.
fn stopped_by(trouble: Trouble, is_expected: fn(&StopReason) -> bool) {
    retried(|| {
        let server = MockServer::start("baxter");
        let mut drive = under_way(&server)?;
        server.robot().trouble = trouble;
        drive.until_stopped(&first_joint("left", 0.8));
        drive.stop_by(is_expected)?;
        // Whatever it was, the arm has come to rest, by commands or by its own time limit.
        let rests = || {
            let before = server.robot().angles["left_s0"];
            std::thread::sleep(std::time::Duration::from_millis(50));
            server.robot().angles["left_s0"] == before
        };
        if !matches!(trouble, Trouble::Closed | Trouble::HalfOpen | Trouble::Drip) {
            wait_until(rests);
        }
        assert_eq!(server.robot().dropped, 0);
        Ok(())
    });
}

#[test]
fn an_arm_turns_at_its_speed_and_is_held() {
    retried(|| {
        let server = MockServer::start("baxter");
        let mut drive = begin(&server);
        drive.until(&first_joint("left", 0.5), |state| {
            state.joints["left_s0"].position > 0.3
        })?;
        assert_eq!(server.robot().time_limit, 0.1);
        assert!(server.robot().modes.iter().all(|mode| *mode == 2));
        drive.stop(StopReason::Asked)?;
        let robot = server.robot();
        assert_eq!((robot.modes.last(), robot.time_limit), (Some(&1), 0.2));
        assert!((0.3..0.7).contains(&robot.angles["left_s0"]));
        assert_eq!(
            robot.types["/robot/limb/left/joint_command"],
            "baxter_core_msgs/JointCommand"
        );
        assert!(!robot.types.contains_key("/robot/limb/right/joint_command"));
        Ok(())
    });
}

#[test]
fn a_panda_is_driven_by_velocities_alone() {
    retried(|| {
        let server = MockServer::start("panda");
        let mut drive = Drive::begin(
            &server.address(),
            &profile("panda"),
            &BridgeOptions {
                speed: 1.0,
                ..BridgeOptions::default()
            },
        );
        drive.until(&first_joint("panda", -0.5), |state| {
            state.joints["panda_joint1"].position < -0.3
        })?;
        drive.stop(StopReason::Asked)?;
        // It has no time limit: without a last command of no speed it would turn on.
        let angle = server.robot().angles["panda_joint1"];
        std::thread::sleep(std::time::Duration::from_millis(100));
        assert_eq!(server.robot().angles["panda_joint1"], angle);
        let types = &server.robot().types;
        assert_eq!(
            types["/joint_velocity_controller/commands"],
            "std_msgs/msg/Float64MultiArray"
        );
        assert_eq!(types["/joint_states"], "sensor_msgs/msg/JointState");
        Ok(())
    });
}

#[test]
fn a_limit_is_approached_and_no_command_is_dropped() {
    retried(|| {
        let server = MockServer::start("baxter");
        let mut drive = begin(&server);
        drive.until(&first_joint("left", 1.5), |state| {
            state.joints["left_s0"].position > 1.69
        })?;
        drive.stop(StopReason::Asked)?;
        assert_eq!(server.robot().dropped, 0);
        Ok(())
    });
}

#[test]
fn a_shadow_asks_for_nothing_but_states() {
    let server = MockServer::start("baxter");
    let shadow = Shadow::connect(&server.address(), &profile("baxter")).unwrap();
    let first = shadow.state().joints_at;
    wait_until(|| shadow.state().joints_at > first);
    drop(shadow);
    assert_eq!(
        server.robot().operations,
        BTreeSet::from(["subscribe".to_owned()])
    );
}

#[test]
fn pieces_shuffled_joints_and_garbage_are_no_matter() {
    for trouble in [Trouble::Fragments, Trouble::Shuffled, Trouble::Garbage] {
        let server = MockServer::start("baxter");
        server.robot().trouble = trouble;
        let shadow = Shadow::connect(&server.address(), &profile("baxter")).unwrap();
        let mut before = shadow.state().joints_at;
        for turn in 0..5 {
            let angle = 0.2 + f64::from(turn) / 20.0;
            server.robot().angles.insert("right_w1".into(), angle);
            wait_until(|| shadow.state().joints["right_w1"].position == angle);
            wait_until(|| shadow.state().joints_at > before);
            before = shadow.state().joints_at;
        }
        assert_eq!(shadow.fault(), None);
        assert_eq!(
            shadow.state().nonsense > 0,
            trouble == Trouble::Garbage,
            "{trouble:?}"
        );
        assert_eq!(shadow.state().joints.len(), 15);
    }
}

#[test]
fn a_shadow_says_when_the_connection_is_lost() {
    let server = MockServer::start("baxter");
    let shadow = Shadow::connect(&server.address(), &profile("baxter")).unwrap();
    server.robot().trouble = Trouble::Closed;
    wait_until(|| shadow.fault().is_some());
    assert!(
        shadow
            .fault()
            .unwrap()
            .starts_with("the connection is lost")
    );
}

#[test]
fn a_shadow_says_when_states_jump_or_do_not_come() {
    for (trouble, fault) in [
        (Trouble::Jump, "left_w2 jumped by"),
        (Trouble::Frozen, "the robot's joint states are"),
    ] {
        let server = MockServer::start("baxter");
        let shadow = Shadow::connect(&server.address(), &profile("baxter")).unwrap();
        assert_eq!(shadow.fault(), None);
        server.robot().trouble = trouble;
        wait_until(|| shadow.fault().is_some());
        let said = shadow.fault().unwrap();
        assert!(said.starts_with(fault), "{said}");
    }
}

#[test]
fn old_states_stop_it() {
    let is_stale = |reason: &StopReason| matches!(reason, StopReason::StaleState { .. });
    for trouble in [
        Trouble::Frozen,
        Trouble::Delayed,
        Trouble::NotANumber,
        Trouble::Drip,
    ] {
        stopped_by(trouble, is_stale);
    }
}

#[test]
fn a_connection_that_ends_or_is_half_open_stops_it() {
    stopped_by(Trouble::Closed, |reason| {
        matches!(reason, StopReason::Disconnected(_))
    });
    stopped_by(Trouble::HalfOpen, |reason| {
        matches!(
            reason,
            StopReason::StaleState { .. } | StopReason::Disconnected(_)
        )
    });
}

#[test]
fn a_stuck_arm_and_the_button_stop_it() {
    stopped_by(
        Trouble::Stuck,
        |reason| matches!(reason, StopReason::Unfollowed { joint } | StopReason::Deviation { joint, .. } if joint == "left_s0"),
    );
    stopped_by(Trouble::EmergencyStop, |reason| {
        *reason == StopReason::EmergencyStop
    });
}

#[test]
fn states_at_10_hz_are_refused() {
    let server = MockServer::start("baxter");
    server.robot().trouble = Trouble::Slow;
    let refused = Bridge::connect(&server.address(), &profile("baxter"), &left_arm());
    let refused = refused.unwrap_err();
    let BridgeError::SlowStates { topic, rate, .. } = &refused else {
        panic!("{refused}");
    };
    assert_eq!(topic, "/robot/joint_states");
    // A busy machine makes it slower.
    assert!((1.0..12.0).contains(rate), "{refused}");
    assert!(server.robot().modes.is_empty());
}

#[test]
fn a_silent_health_stops_it() {
    stopped_by(Trouble::SilentHealth, |reason| {
        matches!(reason, StopReason::SilentHealth { .. })
    });
}

#[test]
fn a_second_publisher_stops_it_where_it_is() {
    retried(|| {
        let server = MockServer::start("baxter");
        let mut drive = under_way(&server)?;
        server.robot().trouble = Trouble::Jump;
        let before = server.robot().angles.clone();
        drive.until_stopped(&first_joint("left", 0.8));
        let reason = drive.0.stop();
        let is_jump = matches!(&reason, StopReason::Jump(jump) if jump.joint == "left_w2");
        assert!(is_jump, "{reason}");
        let after = server.robot().angles.clone();
        assert_eq!(before["left_w2"], after["left_w2"]);
        assert!((before["left_s0"] - after["left_s0"]).abs() < 0.3);
        Ok(())
    });
}

#[test]
fn bare_numbers_in_speeds_and_efforts_are_no_matter() {
    let server = MockServer::start("panda");
    server.robot().trouble = Trouble::BareNumbers;
    let shadow = Shadow::connect(&server.address(), &profile("panda")).unwrap();
    assert_eq!(shadow.state().joints.len(), 7);
    assert_eq!(shadow.state().joints["panda_joint1"].velocity, None);
}

#[test]
fn a_topic_of_another_type_is_called_so() {
    let server = MockServer::start("baxter");
    server.robot().trouble = Trouble::OtherType;
    let refused = Shadow::connect(&server.address(), &profile("baxter"));
    let refused = refused.unwrap_err().to_string();
    assert!(
        refused.ends_with(
            "/robot/joint_states is of the type std_msgs/String, not sensor_msgs/JointState"
        ),
        "{refused}"
    );
}

#[test]
fn a_program_that_falls_silent_stops_it() {
    let server = MockServer::start("baxter");
    let drive = retry(|| under_way(&server));
    drive.until_the_watchdog_stops();
    drive
        .stop_by(|reason| matches!(reason, StopReason::ProgramLate { .. }))
        .unwrap();
    let robot = server.robot();
    assert_eq!(robot.modes.last(), Some(&1));
}

/// A machine may be too busy for one try.
fn retry<T>(attempt: impl Fn() -> Result<T, Busy>) -> T {
    (0..5).find_map(|_| attempt().ok()).unwrap()
}

#[test]
fn unknown_software_is_refused() {
    let server = MockServer::start("baxter");
    server.robot().software = "1.1.1".into();
    let refused = Bridge::connect(&server.address(), &profile("baxter"), &left_arm());
    let Err(error @ BridgeError::Software { .. }) = refused else {
        panic!("{refused:?}");
    };
    assert_eq!(
        error.to_string(),
        "Baxter has the software 1.1.1, not 1.2.0; what it does with commands is not known"
    );
    let options = BridgeOptions {
        any_software: true,
        ..left_arm()
    };
    drop(Bridge::connect(&server.address(), &profile("baxter"), &options).unwrap());
    assert!(server.robot().modes.is_empty());
}

#[test]
fn motors_are_switched_on_only_with_leave() {
    let server = MockServer::start("baxter");
    server.robot().is_enabled = false;
    let refused = Bridge::connect(&server.address(), &profile("baxter"), &left_arm());
    assert!(matches!(
        refused,
        Err(BridgeError::NotReady {
            reason: StopReason::Disabled,
            ..
        })
    ));
    let options = BridgeOptions {
        enable: true,
        ..left_arm()
    };
    drop(Bridge::connect(&server.address(), &profile("baxter"), &options).unwrap());
    assert!(server.robot().is_enabled);
    server.robot().trouble = Trouble::EmergencyStop;
    let refused = Bridge::connect(&server.address(), &profile("baxter"), &options);
    assert!(matches!(
        refused,
        Err(BridgeError::NotReady {
            reason: StopReason::EmergencyStop,
            ..
        })
    ));
}

#[test]
fn pictures_come_on_a_connection_of_their_own() {
    let server = MockServer::start("baxter");
    let shadow = Shadow::connect(&server.address(), &profile("baxter")).unwrap();
    let feed = PictureFeed::connect(&server.address(), &profile("baxter"), "head").unwrap();
    wait_until(|| feed.latest().is_some());
    let picture = feed.latest().unwrap();
    assert_eq!((picture.width, picture.height), (640, 400));
    assert!(
        picture
            .rgb
            .chunks_exact(3)
            .all(|pixel| pixel == [30, 20, 10])
    );
    // States go on beside them.
    let first = shadow.state().joints_at;
    wait_until(|| shadow.state().joints_at > first && feed.latest().unwrap().at > picture.at);
    assert_eq!((feed.nonsense(), feed.fault()), (0, None));
    let refused = PictureFeed::connect(&server.address(), &profile("baxter"), "tail");
    assert_eq!(
        refused.unwrap_err().to_string(),
        "Baxter has no camera \"tail\""
    );
}

#[test]
fn another_robot_is_no_baxter() {
    let server = MockServer::start("panda");
    let refused = Shadow::connect(&server.address(), &profile("baxter")).unwrap_err();
    let refused = refused.to_string();
    assert!(
        refused.contains("left_s0, left_s1")
            && refused.ends_with("/robot/joint_states is published by nobody"),
        "{refused}"
    );
}

#[test]
fn what_is_no_rosbridge_is_refused_in_time() {
    let silent = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let port = silent.local_addr().unwrap().port();
    let address = format!("baxter:ws://127.0.0.1:{port}").parse().unwrap();
    let refused = Shadow::connect(&address, &profile("baxter")).unwrap_err();
    assert_eq!(
        refused.to_string(),
        format!("no answer from 127.0.0.1:{port} within 2 s")
    );
    drop(silent);
    let refused = Shadow::connect(&address, &profile("baxter"))
        .unwrap_err()
        .to_string();
    assert!(
        refused.starts_with(&format!("127.0.0.1:{port} cannot be reached")),
        "{refused}"
    );
}

/// Forbids angles beyond 0.3 rad.
struct Fence;

impl Guard for Fence {
    fn veto(&mut self, state: &RobotState, _: &PredictedMotion) -> Option<String> {
        let angle = state.joints["left_s0"].position;
        (angle > 0.3).then(|| "the left arm would touch the fence".to_owned())
    }
}

#[test]
fn a_guard_lets_the_arm_rest() {
    retried(|| {
        let server = MockServer::start("baxter");
        let mut drive = begin(&server);
        drive.0.set_guard(Fence);
        let target = first_joint("left", 0.5);
        drive.until(&target, |state| state.joints["left_s0"].position > 0.28)?;
        let mut vetoes = 0;
        let mut last = f64::NAN;
        // The program goes on, and the arm comes to rest.
        while vetoes < 100 {
            match drive.0.aim(target.clone()) {
                Ok(()) => {}
                Err(TargetError::Vetoed(why)) => {
                    assert_eq!(why, "the left arm would touch the fence");
                    vetoes += 1;
                    last = server.robot().angles["left_s0"];
                }
                Err(_) => break,
            }
            std::thread::sleep(std::time::Duration::from_millis(10));
        }
        drive.stop(StopReason::Asked)?;
        assert!((last - server.robot().angles["left_s0"]).abs() < 1e-3);
        assert!(last < 0.4, "{last}");
        Ok(())
    });
}
