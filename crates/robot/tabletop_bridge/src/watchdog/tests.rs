use proptest::prelude::*;

use super::*;
use crate::{
    limits::{ACCELERATION, LIMIT_MARGIN},
    state::{GripperReading, JointJump, JointReading},
    tolerances::{LEAST_WAY, LONGEST_ANSWER, MOST_DEVIATION, RESPONSE},
};

/// A Baxter in simulated time that does what it is told, and drops what its limits forbid.
struct Rig {
    profile: BridgeProfile,
    watchdog: Watchdog,
    now: Duration,
    /// Angles of the left arm, and the speeds or goals that it was sent last.
    angles: Vec<f64>,
    speeds: Vec<f64>,
    state: RobotState,
    target: RobotTarget,
    set_at: Duration,
    dropped: usize,
    /// The orders of the last tick.
    orders: Vec<RobotOrder>,
}

impl Rig {
    fn watching(angles: &[f64]) -> Self {
        let profile = BridgeProfile::shipped("baxter").unwrap();
        let mut rig = Self {
            watchdog: Watchdog::new(profile.clone(), &[0], 1.0),
            profile,
            now: Duration::from_secs(100),
            angles: angles.to_owned(),
            speeds: vec![0.0; 7],
            state: RobotState {
                health: Some(RobotHealth::Enabled),
                ..RobotState::default()
            },
            target: RobotTarget::default(),
            set_at: Duration::ZERO,
            dropped: 0,
            orders: Vec::new(),
        };
        rig.measure();
        rig
    }

    fn armed(angles: &[f64]) -> Self {
        let mut rig = Self::watching(angles);
        rig.watchdog.arm(rig.now, &rig.state).unwrap();
        rig
    }

    fn measure(&mut self) {
        for (joint, position) in self.profile.limbs[0].joints.iter().zip(&self.angles) {
            let reading = JointReading {
                position: *position,
                ..JointReading::default()
            };
            self.state.joints.insert(joint.name.clone(), reading);
        }
        self.state.joints_at = Some(self.now);
        self.state.health_at = Some(self.now);
    }

    fn aim(&mut self, target: LimbTarget) {
        self.target.limbs = [("left".to_owned(), target)].into();
        self.set_at = self.now;
    }

    /// A period passes, in which the robot moves and is measured, unless it is not.
    fn tick(&mut self, is_measured: bool) {
        self.pass();
        if is_measured {
            self.measure();
        }
        self.look();
    }

    /// A period passes, in which the robot moves and is measured, but wrongly.
    fn tick_measured(&mut self, wrongly: impl Fn(&mut Self)) {
        self.pass();
        self.measure();
        wrongly(self);
        self.look();
    }

    fn pass(&mut self) {
        self.now += PERIOD;
        for (angle, speed) in self.angles.iter_mut().zip(&self.speeds) {
            *angle += speed * PERIOD.as_secs_f64();
        }
    }

    fn look(&mut self) {
        self.orders = self
            .watchdog
            .tick(self.now, &self.state, &self.target, self.set_at);
        for order in self.orders.clone() {
            self.obey(&order);
        }
    }

    fn obey(&mut self, order: &RobotOrder) {
        let joints = &self.profile.limbs[0].joints;
        match order {
            RobotOrder::Velocities { speeds, .. } => {
                let passes =
                    joints
                        .iter()
                        .zip(&self.angles)
                        .zip(speeds)
                        .any(|((joint, angle), speed)| {
                            let next = angle + speed * PERIOD.as_secs_f64();
                            next < joint.limits.0 || next > joint.limits.1
                        });
                match passes {
                    true => self.dropped += 1,
                    false => self.speeds.clone_from(speeds),
                }
            }
            RobotOrder::Positions { angles, .. } => {
                let ways = angles
                    .iter()
                    .zip(&self.angles)
                    .map(|(goal, angle)| goal - angle);
                let speeds = ways.zip(joints).map(|(way, joint)| {
                    (way / PERIOD.as_secs_f64()).clamp(-joint.speed, joint.speed)
                });
                self.speeds = speeds.collect();
            }
            RobotOrder::MoveGripper { .. }
            | RobotOrder::TurnHead(_)
            | RobotOrder::LimitTime { .. }
            | RobotOrder::LimitSpeed { .. }
            | RobotOrder::Enable => {}
        }
    }

    fn run(&mut self, ticks: usize, target: &LimbTarget) {
        for _ in 0..ticks {
            self.aim(target.clone());
            self.tick(true);
        }
    }

    fn speeds_sent(&self) -> Option<&[f64]> {
        self.orders.iter().find_map(|order| match order {
            RobotOrder::Velocities { speeds, .. } => Some(speeds.as_slice()),
            RobotOrder::Positions { .. }
            | RobotOrder::MoveGripper { .. }
            | RobotOrder::TurnHead(_)
            | RobotOrder::LimitTime { .. }
            | RobotOrder::LimitSpeed { .. }
            | RobotOrder::Enable => None,
        })
    }
}

fn first_joint(speed: f64) -> LimbTarget {
    let mut speeds = vec![0.0; 7];
    speeds[0] = speed;
    LimbTarget::Velocities(speeds)
}

const MIDDLE: [f64; 7] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];

#[test]
fn nothing_is_sent_before_it_is_armed() {
    let mut rig = Rig::watching(&MIDDLE);
    rig.run(50, &first_joint(1.0));
    assert_eq!(rig.orders, []);
    assert_eq!(rig.angles, MIDDLE);
    rig.watchdog.stop(StopReason::Asked, rig.now);
    rig.run(1, &first_joint(1.0));
    assert_eq!(rig.orders, []);
    assert!(rig.watchdog.is_done(rig.now));
}

#[test]
fn arming_limits_time_and_speed_and_moves_nothing() {
    let mut rig = Rig::watching(&MIDDLE);
    let orders = rig.watchdog.arm(rig.now, &rig.state).unwrap();
    let [
        RobotOrder::LimitTime { seconds, .. },
        RobotOrder::LimitSpeed { ratio, .. },
    ] = &orders[..]
    else {
        panic!("{orders:?}");
    };
    assert_eq!((*seconds, *ratio), (0.1, 1.0));
    rig.tick(true);
    assert_eq!(rig.speeds_sent().unwrap(), [0.0; 7]);
}

#[test]
fn a_speed_is_reached_by_the_acceleration() {
    let mut rig = Rig::armed(&MIDDLE);
    rig.run(10, &first_joint(1.0));
    let speed = rig.speeds_sent().unwrap()[0];
    assert!(
        (speed - 10.0 * PERIOD.as_secs_f64() * ACCELERATION).abs() < 1e-9,
        "{speed}"
    );
    rig.run(40, &first_joint(1.0));
    assert_eq!(rig.speeds_sent().unwrap()[0], 1.0);
}

#[test]
fn positions_are_reached_and_kept() {
    let mut rig = Rig::armed(&MIDDLE);
    let goal = [0.5, -0.6, 1.0, 1.5, -1.0, 0.3, 2.0];
    rig.run(400, &LimbTarget::Positions(goal.into()));
    for (angle, goal) in rig.angles.iter().zip(goal) {
        assert!((angle - goal).abs() < 1e-3, "{:?}", rig.angles);
    }
    assert_eq!(rig.watchdog.state(), &WatchdogState::Armed);
}

#[test]
fn a_position_beyond_a_limit_ends_before_it() {
    let mut rig = Rig::armed(&MIDDLE);
    let mut goal = MIDDLE;
    goal[0] = 3.0;
    rig.run(500, &LimbTarget::Positions(goal.into()));
    let limit = 1.70167993878 - LIMIT_MARGIN;
    assert!((rig.angles[0] - limit).abs() < 1e-3, "{:?}", rig.angles);
}

/// Runs at a speed until something is the matter, and returns the reason.
fn stopped_by(matter: impl Fn(&mut Rig)) -> (Rig, StopReason) {
    let mut rig = Rig::armed(&MIDDLE);
    rig.run(60, &first_joint(0.9));
    for _ in 0..60 {
        matter(&mut rig);
        match rig.watchdog.state() {
            WatchdogState::Ramping(reason) | WatchdogState::Held(reason) => {
                let reason = reason.clone();
                return (rig, reason);
            }
            WatchdogState::Watching | WatchdogState::Armed => {}
        }
    }
    panic!("nothing stopped it");
}

#[test]
fn each_thing_that_is_the_matter_stops_the_robot() {
    let health = |health: RobotHealth| {
        let (_, reason) = stopped_by(|rig| {
            rig.state.health = Some(health);
            rig.run(1, &first_joint(0.9));
        });
        reason
    };
    assert_eq!(
        health(RobotHealth::EmergencyStop),
        StopReason::EmergencyStop
    );
    assert_eq!(health(RobotHealth::Disabled), StopReason::Disabled);
    assert_eq!(health(RobotHealth::Error), StopReason::RobotError);

    let (_, reason) = stopped_by(|rig| {
        rig.aim(first_joint(0.9));
        rig.tick(false);
    });
    assert_eq!(
        reason,
        StopReason::StaleState {
            age: OLDEST_STATE + PERIOD
        }
    );

    let (_, reason) = stopped_by(|rig| rig.tick(true));
    assert_eq!(
        reason,
        StopReason::ProgramLate {
            by: OLDEST_TARGET + PERIOD
        }
    );

    let (_, reason) = stopped_by(|rig| {
        rig.now += OLDEST_TARGET;
        rig.run(1, &first_joint(0.9));
    });
    assert_eq!(
        reason,
        StopReason::WatchdogLate {
            by: OLDEST_TARGET + PERIOD
        }
    );

    let jump = JointJump {
        joint: "left_w2".into(),
        by: 5.0,
        within: PERIOD,
    };
    let (_, reason) = stopped_by(|rig| {
        rig.state.jump = Some(jump.clone());
        rig.run(1, &first_joint(0.9));
    });
    assert_eq!(reason, StopReason::Jump(jump));
}

#[test]
fn a_silent_health_stops_it() {
    let mut rig = Rig::armed(&MIDDLE);
    let told = rig.now;
    while *rig.watchdog.state() == WatchdogState::Armed {
        rig.aim(first_joint(0.1));
        rig.state.health_at = Some(told);
        rig.tick_measured(|rig| rig.state.health_at = Some(told));
        assert!(rig.now - told < 2 * OLDEST_REPORT);
    }
    let expected = StopReason::SilentHealth {
        age: OLDEST_REPORT + PERIOD,
    };
    assert_eq!(*rig.watchdog.state(), WatchdogState::Ramping(expected));
}

fn gripper(rig: &Rig) -> GripperReading {
    GripperReading {
        id: 65538,
        is_calibrated: true,
        is_gripping: false,
        has_error: false,
        opening: 1.0,
        sequence: None,
        at: rig.now,
    }
}

#[test]
fn a_silent_or_faulty_gripper_that_is_moved_stops_it() {
    for (is_faulty, is_moved) in [(true, true), (true, false), (false, true), (false, false)] {
        let mut rig = Rig::armed(&MIDDLE);
        let reading = GripperReading {
            has_error: is_faulty,
            ..gripper(&rig)
        };
        rig.state.grippers.insert("left".into(), reading);
        if is_moved {
            rig.target.grippers = [("left".to_owned(), 0.5)].into();
        }
        rig.run(150, &first_joint(0.0));
        let limb = || "left".to_owned();
        match (rig.watchdog.state(), is_faulty, is_moved) {
            (WatchdogState::Held(StopReason::GripperError { limb: of }), true, true)
            | (WatchdogState::Held(StopReason::SilentGripper { limb: of, .. }), false, true) => {
                assert_eq!(*of, limb());
            }
            (state, _, is_moved) => {
                assert_eq!((state, is_moved), (&WatchdogState::Armed, false));
            }
        }
    }
}

#[test]
fn a_stuck_joint_is_found_out_at_any_speed() {
    for speed in [0.01, 0.03, 0.1, 0.25, 0.4] {
        let mut rig = Rig::armed(&MIDDLE);
        rig.run(40, &first_joint(speed));
        let (from, noise) = (rig.now, [2e-3, -2e-3, 1e-3]);
        while *rig.watchdog.state() == WatchdogState::Armed {
            rig.speeds.fill(0.0);
            rig.aim(first_joint(speed));
            rig.tick_measured(|rig| {
                let tick = (rig.now.as_millis() / 10) as usize;
                let reading = rig.state.joints.get_mut("left_s0").unwrap();
                reading.position += noise[tick % noise.len()];
            });
        }
        let expected = StopReason::Unfollowed {
            joint: "left_s0".into(),
        };
        assert_eq!(*rig.watchdog.state(), WatchdogState::Ramping(expected));
        let seconds = (rig.now - from).as_secs_f64();
        let most = 2.0 * (LONGEST_ANSWER + LEAST_WAY / speed) + 0.05;
        assert!(seconds < most, "{speed}: {seconds}");
    }
}

#[test]
fn speeds_that_are_followed_to_some_percent_are_no_fault() {
    // And an arm that answers late.
    for (factor, delay) in [(0.8, 0), (1.2, 0), (1.0, 20)] {
        let mut rig = Rig::armed(&MIDDLE);
        let mut sent = Vec::new();
        for second in 0..4 {
            let speed = if second % 2 == 0 { 0.5 } else { -0.5 };
            for _ in 0..100 {
                sent.push(rig.speeds.clone());
                let late: Vec<f64> = sent[sent.len().saturating_sub(1 + delay)].clone();
                rig.speeds = late.iter().map(|it| it * factor).collect();
                rig.aim(first_joint(speed));
                rig.tick(true);
                assert_eq!(
                    *rig.watchdog.state(),
                    WatchdogState::Armed,
                    "{factor} {delay}"
                );
            }
        }
    }
}

#[test]
fn a_joint_that_turns_by_itself_stops_it() {
    // Three times as fast as it should, and while it should rest.
    for (speed, own, is_by_itself) in [(0.2, 0.9, false), (0.0, 0.05, true)] {
        let mut rig = Rig::armed(&MIDDLE);
        while *rig.watchdog.state() == WatchdogState::Armed {
            rig.speeds[0] = own;
            rig.run(1, &first_joint(speed));
            assert!(rig.angles[0] < 0.6, "{:?}", rig.angles);
        }
        let is_deviation = matches!(
            rig.watchdog.state(),
            WatchdogState::Ramping(StopReason::Deviation { .. })
        );
        assert_eq!(is_deviation, is_by_itself);
    }
}

#[test]
fn a_joint_that_is_pushed_away_stops_it() {
    let mut rig = Rig::armed(&MIDDLE);
    rig.run(50, &LimbTarget::Positions(MIDDLE.into()));
    rig.angles[0] += MOST_DEVIATION + 0.01;
    rig.run(1, &LimbTarget::Positions(MIDDLE.into()));
    let WatchdogState::Ramping(StopReason::Deviation { joint, by }) = rig.watchdog.state() else {
        panic!("{:?}", rig.watchdog.state());
    };
    assert_eq!(joint, "left_s0");
    assert!((by - MOST_DEVIATION - 0.01).abs() < 1e-9, "{by}");
}

#[test]
fn what_is_far_from_where_it_should_be_is_held_by_no_speed() {
    let mut rig = Rig::armed(&MIDDLE);
    rig.run(20, &first_joint(0.2));
    // A state that nobody believes: the arm is not there.
    while !rig.watchdog.is_done(rig.now) {
        rig.tick_measured(|rig| {
            rig.state.joints.get_mut("left_w2").unwrap().position = 5.0;
        });
        let is_speed = |order: &RobotOrder| !matches!(order, RobotOrder::Positions { .. });
        assert!(rig.orders.iter().all(is_speed), "{:?}", rig.orders);
    }
    assert!(rig.angles[6].abs() < 1e-9, "{:?}", rig.angles);
}

#[test]
fn a_prediction_is_no_shorter_than_the_way_to_rest() {
    for (speed, answers_after) in [(0.1, 0), (0.9, 0), (1.5, 0), (1.5, 5)] {
        let mut rig = Rig::armed(&MIDDLE);
        let mut sent = vec![vec![0.0; 7]; answers_after];
        let late = |rig: &mut Rig, sent: &mut Vec<Vec<f64>>| {
            sent.push(rig.speeds.clone());
            rig.speeds.clone_from(&sent[sent.len() - 1 - answers_after]);
        };
        for _ in 0..40 {
            rig.aim(first_joint(speed));
            rig.tick(true);
            late(&mut rig, &mut sent);
        }
        assert!(Duration::from_millis(answers_after as u64 * 10) <= RESPONSE);
        let motion = rig
            .watchdog
            .predict(rig.now, &rig.state, &rig.target, &rig.target);
        let last = motion.angles("left", motion.moments() - 1).unwrap()[0];
        // The program falls silent.
        let mut farthest = rig.angles[0];
        for _ in 0..100 {
            rig.tick(true);
            late(&mut rig, &mut sent);
            farthest = farthest.max(rig.angles[0]);
        }
        assert!(farthest < last + 1e-9, "{speed}: {farthest} {last}");
        assert!(last < farthest + 0.35, "{speed}: {farthest} {last}");
    }
}

#[test]
fn what_gets_old_slows_the_joints() {
    // States, or the program's targets: in 50 ms as far as before, then evenly slower.
    for is_measured in [false, true] {
        let mut rig = Rig::armed(&MIDDLE);
        rig.run(40, &first_joint(0.5));
        let from = rig.angles[0];
        while *rig.watchdog.state() == WatchdogState::Armed {
            if !is_measured {
                rig.aim(first_joint(0.5));
            }
            rig.tick(is_measured);
        }
        let way = rig.angles[0] - from;
        assert!((0.035..0.05).contains(&way), "{way}");
        assert!(rig.speeds[0].abs() < 0.01, "{:?}", rig.speeds);
    }
    // New ones let it go on evenly.
    let mut rig = Rig::armed(&MIDDLE);
    rig.run(40, &first_joint(0.5));
    for _ in 0..8 {
        rig.tick(true);
    }
    let slow = rig.speeds[0];
    rig.run(1, &first_joint(0.5));
    assert!(slow < 0.3, "{slow}");
    assert!(
        (rig.speeds[0] - slow - 0.05).abs() < 1e-9,
        "{slow} {:?}",
        rig.speeds
    );
}

#[test]
fn the_whole_way_of_a_move_is_looked_at() {
    let rig = Rig::armed(&MIDDLE);
    let mut goal = MIDDLE.to_vec();
    (goal[0], goal[5]) = (1.5, 2.0);
    let target = RobotTarget {
        limbs: [("left".to_owned(), LimbTarget::Positions(goal.clone()))].into(),
        ..RobotTarget::default()
    };
    let none = RobotTarget::default();
    let motion = rig.watchdog.predict(rig.now, &rig.state, &target, &none);
    let near = rig.watchdog.predict(rig.now, &rig.state, &target, &target);
    assert!(near.moments() < 40 && motion.moments() > 100);
    let last = motion.angles("left", motion.moments() - 1).unwrap();
    for (angle, goal) in last.iter().zip(goal) {
        assert!((angle - goal).abs() < 1e-3, "{last:?}");
    }
}

#[test]
fn a_stop_is_an_even_ramp_then_a_hold_then_silence() {
    let (mut rig, _) = stopped_by(|rig| {
        rig.state.health = Some(RobotHealth::Error);
        rig.run(1, &first_joint(0.9));
    });
    let mut speeds = vec![rig.speeds_sent().unwrap()[0]];
    let from = rig.now;
    while matches!(rig.watchdog.state(), WatchdogState::Ramping(_)) {
        rig.tick(true);
        speeds.extend(rig.speeds_sent().map(|speeds| speeds[0]));
    }
    assert_eq!(rig.now - from, RAMP);
    let differences: Vec<_> = speeds.windows(2).map(|pair| pair[0] - pair[1]).collect();
    assert!(
        differences
            .iter()
            .all(|difference| (difference - 0.9 / 11.0).abs() < 1e-9),
        "{speeds:?}"
    );
    let [
        RobotOrder::LimitTime { seconds: 0.2, .. },
        RobotOrder::Positions { angles, .. },
    ] = &rig.orders[..]
    else {
        panic!("{:?}", rig.orders);
    };
    assert_eq!(angles, &rig.angles);
    let held = rig.angles.clone();
    let mut holds = 0;
    while !rig.watchdog.is_done(rig.now) {
        rig.tick(true);
        holds += usize::from(!rig.orders.is_empty());
    }
    assert_eq!(holds, 30);
    assert_eq!(rig.angles, held);
    rig.run(100, &first_joint(1.0));
    assert_eq!(rig.orders, []);
}

#[test]
fn a_robot_without_states_is_held_by_no_speed() {
    let (mut rig, _) = stopped_by(|rig| {
        rig.aim(first_joint(0.9));
        rig.tick(false);
    });
    while !rig.watchdog.is_done(rig.now) {
        rig.tick(false);
        let is_speed = |order: &RobotOrder| !matches!(order, RobotOrder::Positions { .. });
        assert!(rig.orders.iter().all(is_speed), "{:?}", rig.orders);
    }
    assert_eq!(rig.speeds, [0.0; 7]);
}

#[test]
fn a_robot_that_is_stopped_is_sent_nothing_more() {
    for health in [RobotHealth::EmergencyStop, RobotHealth::Disabled] {
        let (mut rig, _) = stopped_by(|rig| {
            rig.state.health = Some(health);
            rig.run(1, &first_joint(0.9));
        });
        assert_eq!(rig.orders, []);
        rig.state.health = Some(RobotHealth::Enabled);
        rig.run(200, &first_joint(0.9));
        assert_eq!(rig.orders, []);
        assert!(rig.watchdog.arm(rig.now, &rig.state).is_err());
    }
}

#[test]
fn a_robot_that_rests_waits_for_its_program() {
    let mut rig = Rig::armed(&MIDDLE);
    rig.run(10, &LimbTarget::Velocities(vec![0.0; 7]));
    for _ in 0..100 {
        rig.tick(true);
    }
    assert_eq!(*rig.watchdog.state(), WatchdogState::Armed);
    rig.run(10, &first_joint(0.9));
    assert_eq!(*rig.watchdog.state(), WatchdogState::Armed);
}

#[test]
fn a_stop_while_it_comes_to_rest_ends_the_commands() {
    let (mut rig, reason) = stopped_by(|rig| rig.tick(true));
    assert!(matches!(reason, StopReason::ProgramLate { .. }));
    rig.state.health = Some(RobotHealth::EmergencyStop);
    rig.tick(true);
    assert_eq!(rig.orders, []);
    assert_eq!(
        rig.watchdog.state(),
        &WatchdogState::Held(StopReason::EmergencyStop)
    );
}

#[test]
fn a_robot_that_is_not_fit_is_not_armed() {
    let mut rig = Rig::watching(&MIDDLE);
    rig.now += Duration::from_millis(101);
    let refused = rig.watchdog.arm(rig.now, &rig.state);
    assert!(matches!(refused, Err(StopReason::StaleState { .. })));
    rig.measure();
    rig.state.health = None;
    assert_eq!(
        rig.watchdog.arm(rig.now, &rig.state),
        Err(StopReason::Disabled)
    );
    rig.state.health = Some(RobotHealth::Enabled);
    rig.watchdog.arm(rig.now, &rig.state).unwrap();
}

#[test]
fn grippers_and_head_are_sent_only_what_is_new() {
    let mut rig = Rig::armed(&MIDDLE);
    rig.state.grippers.insert("left".into(), gripper(&rig));
    let (mut openings, mut turns) = (0, 0);
    for tick in 0..200 {
        let wanted = f64::from(tick) / 200.0;
        rig.state.grippers.insert("left".into(), gripper(&rig));
        rig.target.grippers = [("left".to_owned(), wanted)].into();
        rig.target.head = Some(wanted);
        rig.run(1, &first_joint(0.0));
        openings += rig
            .orders
            .iter()
            .filter(|order| matches!(order, RobotOrder::MoveGripper { id: 65538, .. }))
            .count();
        turns += rig
            .orders
            .iter()
            .filter(|order| matches!(order, RobotOrder::TurnHead(_)))
            .count();
    }
    assert_eq!((openings, turns), (40, 20));

    // What was heard is not said again, the rest twice a second.
    let count = |rig: &mut Rig, sequence: Option<u32>| {
        (0..200)
            .map(|_| {
                rig.state.grippers.insert(
                    "left".into(),
                    GripperReading {
                        sequence,
                        ..gripper(rig)
                    },
                );
                rig.run(1, &first_joint(0.0));
                rig.orders
                    .iter()
                    .filter(|order| matches!(order, RobotOrder::MoveGripper { .. }))
                    .count()
            })
            .sum::<usize>()
    };
    assert_eq!(count(&mut rig, None), 4);
    assert_eq!(count(&mut rig, Some(41)), 0);
}

proptest! {
    #[test]
    fn whatever_a_program_wants_no_command_is_dropped(
        starts in prop::collection::vec(0.02..0.98f64, 7),
        targets in prop::collection::vec((any::<bool>(), prop::collection::vec(-6.0..6.0f64, 7)), 1..12),
        measured in prop::collection::vec(any::<bool>(), 40),
    ) {
        let limits = BridgeProfile::shipped("baxter").unwrap().limbs[0].joints.clone();
        let angles: Vec<_> = limits.iter().zip(&starts).map(|(it, share)| it.limits.0 + share * (it.limits.1 - it.limits.0)).collect();
        let mut rig = Rig::armed(&angles);
        for (is_by_positions, numbers) in targets {
            let target = match is_by_positions {
                true => LimbTarget::Positions(numbers),
                false => LimbTarget::Velocities(numbers),
            };
            for (tick, is_measured) in measured.iter().enumerate() {
                rig.aim(target.clone());
                // Every other state may be missing.
                rig.tick(tick % 2 == 0 || *is_measured);
                prop_assert_eq!(rig.watchdog.state(), &WatchdogState::Armed);
                for ((joint, angle), speed) in limits.iter().zip(&rig.angles).zip(&rig.speeds) {
                    prop_assert!((joint.limits.0..=joint.limits.1).contains(angle), "{} at {angle}", joint.name);
                    prop_assert!(speed.abs() <= joint.speed + 1e-9, "{} at {speed}", joint.name);
                }
            }
        }
        prop_assert_eq!(rig.dropped, 0);
    }

    #[test]
    fn whatever_happens_a_stopped_robot_comes_to_rest(
        events in prop::collection::vec((0..6u8, 1..15usize), 1..20),
        speeds in prop::collection::vec(-4.0..4.0f64, 7),
    ) {
        let mut rig = Rig::armed(&MIDDLE);
        let mut was_stopped = None;
        for (event, ticks) in events {
            for _ in 0..ticks {
                match event {
                    0 => rig.state.health = Some(RobotHealth::EmergencyStop),
                    1 => rig.state.health = Some(RobotHealth::Enabled),
                    2 => rig.state.health = Some(RobotHealth::Error),
                    _ => {}
                }
                if event != 3 {
                    rig.aim(LimbTarget::Velocities(speeds.clone()));
                }
                rig.tick(event != 4);
                if *rig.watchdog.state() != WatchdogState::Armed {
                    let since = *was_stopped.get_or_insert(rig.now);
                    if rig.now - since > RAMP + HOLD + PERIOD {
                        prop_assert!(rig.orders.is_empty());
                        prop_assert!(rig.watchdog.is_done(rig.now));
                    }
                    if rig.now - since > RAMP {
                        let is_moving = rig.speeds_sent().is_some_and(|speeds| speeds.iter().any(|speed| *speed != 0.0));
                        prop_assert!(!is_moving);
                    }
                } else {
                    prop_assert_eq!(was_stopped, None);
                }
            }
        }
    }
}
