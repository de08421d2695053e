//! The guard of a robot's body.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use std::time::Duration;

use tabletop_bridge::{
    BridgeOptions, BridgeProfile, JointReading, LimbTarget, PERIOD, Pilot, RobotHealth, RobotState,
    RobotTarget, TargetError,
};
use tabletop_controller::{Angles, angles};
use tabletop_core::{Random, RobotLayout, Table};
use tabletop_planner::{PartGap, RobotBody};
use tabletop_real::BodyGuard;

/// A Baxter at a table that does what it is told, and its pilot.
struct Rig {
    body: RobotBody,
    gaps: Vec<PartGap>,
    pilot: Pilot,
    guard: BodyGuard,
    now: Duration,
    /// The angles of both arms, and the speeds that they were told last.
    angles: Vec<Vec<f64>>,
    speeds: Vec<Vec<f64>>,
    state: RobotState,
}

impl Rig {
    fn at_home() -> Self {
        let [left, right] = [0, 1].map(home);
        Self::at([&left, &right])
    }

    fn at(postures: [&[f64]; 2]) -> Self {
        let profile = BridgeProfile::shipped("baxter").unwrap();
        let options = BridgeOptions {
            speed: 1.0,
            allow_moves: true,
            ..BridgeOptions::default()
        };
        let model = tabletop_kinematics::baxter().unwrap();
        let table = Table::default();
        let body = RobotBody::new(RobotLayout::baxter(), model, &table).unwrap();
        let mut rig = Self {
            pilot: Pilot::new(&profile, &options).unwrap(),
            guard: BodyGuard::new(body.clone(), table),
            gaps: body.gaps(),
            body,
            now: Duration::from_secs(10),
            angles: postures.map(<[f64]>::to_vec).into(),
            speeds: vec![vec![0.0; 7]; 2],
            state: RobotState {
                health: Some(RobotHealth::Enabled),
                ..RobotState::default()
            },
        };
        rig.measure(0.0);
        rig.pilot.arm(rig.now).unwrap();
        rig
    }

    /// Is measured, with this much noise, in rad.
    fn measure(&mut self, noise: f64) {
        let profile = self.pilot.profile().clone();
        for (limb, angles) in profile.limbs.iter().zip(&self.angles) {
            for (place, (joint, angle)) in limb.joints.iter().zip(angles).enumerate() {
                // It looks random.
                let number = self.now.as_millis() as f64 / 10.0 + 100.0 * place as f64;
                let off = noise * (2.0 * (number * 0.618_034).fract() - 1.0);
                let reading = JointReading {
                    position: angle + off,
                    velocity: Some(0.0),
                    effort: None,
                };
                self.state.joints.insert(joint.name.clone(), reading);
            }
        }
        self.state.joints_at = Some(self.now);
        self.state.health_at = Some(self.now);
        self.pilot.hear(&self.state);
    }

    /// A period, with this target.
    fn tick(&mut self, target: &RobotTarget, noise: f64) -> Result<(), TargetError> {
        self.now += PERIOD;
        for (angles, speeds) in self.angles.iter_mut().zip(&self.speeds) {
            for (angle, speed) in angles.iter_mut().zip(speeds) {
                *angle += speed * PERIOD.as_secs_f64();
            }
        }
        self.measure(noise);
        let aimed = self
            .pilot
            .aim(self.now, target.clone(), Some(&mut self.guard));
        for (topic, message) in self.pilot.tick(self.now) {
            let limb = usize::from(topic.contains("right"));
            let numbers = message["command"].as_array();
            let numbers: Vec<_> = numbers
                .into_iter()
                .flatten()
                .map(|it| it.as_f64().unwrap())
                .collect();
            match message["mode"].as_i64() {
                Some(2) => self.speeds[limb] = numbers,
                Some(1) => {
                    let ways = numbers.iter().zip(&self.angles[limb]);
                    let speed = |way: f64| (way / PERIOD.as_secs_f64()).clamp(-1.5, 1.5);
                    self.speeds[limb] = ways.map(|(goal, angle)| speed(goal - angle)).collect();
                }
                Some(_) | None => {}
            }
        }
        aimed
    }

    fn postures(&self) -> Vec<Angles> {
        let all = self.angles.iter();
        all.map(|angles_| angles(angles_.iter().copied())).collect()
    }

    /// The narrowest gap of links, and that of fingers above the table, in units.
    fn narrowest(&self) -> [f32; 2] {
        let widest: Vec<_> = self.body.limbs.iter().map(|limb| limb.widest).collect();
        let posed = self.body.posed(&self.postures(), &widest);
        [false, true].map(|of_fingers| {
            let gaps = self
                .gaps
                .iter()
                .filter(|gap| gap.is_of_fingers == of_fingers);
            let widths = gaps.map(|gap| self.body.width(gap, &posed, &Table::default(), 5.0));
            widths.fold(5.0, f32::min)
        })
    }
}

fn home(limb: usize) -> Vec<f64> {
    let layout = RobotLayout::baxter();
    let joints = layout.limbs[limb].joints.iter();
    joints.map(|&joint| layout.joint(joint).home).collect()
}

fn turn(limb: &str, joint: usize, speed: f64) -> RobotTarget {
    let mut speeds = vec![0.0; 7];
    speeds[joint] = speed;
    RobotTarget {
        limbs: [(limb.to_owned(), LimbTarget::Velocities(speeds))].into(),
        ..RobotTarget::default()
    }
}

fn go(limb: &str, angles: &[f64]) -> RobotTarget {
    RobotTarget {
        limbs: [(limb.to_owned(), LimbTarget::Positions(angles.to_vec()))].into(),
        ..RobotTarget::default()
    }
}

fn is_vetoed(aimed: &Result<(), TargetError>) -> bool {
    matches!(aimed, Err(TargetError::Vetoed(_)))
}

#[test]
fn a_robot_at_home_may_turn_each_joint() {
    for limb in ["left", "right"] {
        for joint in 0..7 {
            for speed in [-0.1, 0.1] {
                let mut rig = Rig::at_home();
                rig.tick(&turn(limb, joint, speed), 0.0).unwrap();
            }
        }
    }
}

#[test]
fn links_and_fingers_keep_their_distance() {
    for joint in 0..7 {
        // However fast is wanted: it is never too near for ever, and never nearer than that.
        for speed in [-9.0_f64, -1.0, -0.1, 0.1, 1.0, 9.0] {
            let mut rig = Rig::at_home();
            let before = rig.angles[0][joint];
            for _ in 0..if speed.abs() < 0.5 { 1000 } else { 200 } {
                drop(rig.tick(&turn("left", joint, speed), 0.0));
            }
            let [links, fingers] = rig.narrowest();
            assert!(
                links > 0.3 && fingers > 0.05,
                "{joint} {speed}: {links} {fingers}"
            );
            let way = rig.angles[0][joint] - before;
            let (low, high) = rig.pilot.profile().limbs[0].joints[joint].limits;
            let room = if speed > 0.0 {
                high - before
            } else {
                before - low
            };
            assert!(
                way.abs() > 0.1_f64.min(room - 0.01),
                "{joint} {speed}: {way}"
            );
        }
    }
}

/// The first of random postures of the left arm for which something holds.
fn some_posture(mut holds: impl FnMut(&[f64]) -> bool) -> Vec<f64> {
    let profile = BridgeProfile::shipped("baxter").unwrap();
    let limits = &profile.limbs[0].joints;
    let mut random = Random::new(7);
    for _ in 0..100_000 {
        let posture = limits.iter().map(|joint| {
            let (low, high) = joint.limits;
            f64::from(random.between((low as f32 + 0.1, high as f32 - 0.1)))
        });
        let posture: Vec<f64> = posture.collect();
        if holds(&posture) {
            return posture;
        }
    }
    panic!("there is no such posture");
}

/// A posture of the left arm that is free, while the way there leads through the table.
fn beyond_the_table() -> Vec<f64> {
    let mut rig = Rig::at_home();
    let from = rig.angles[0].clone();
    let mut at = |angles: Vec<f64>| {
        rig.angles[0] = angles;
        rig.narrowest()
    };
    some_posture(|goal| {
        let middle = goal.iter().zip(&from).map(|(a, b)| f64::midpoint(*a, *b));
        let [links, fingers] = at(goal.to_vec());
        links > 0.5 && fingers > 0.5 && at(middle.collect())[1] < -0.5
    })
}

#[test]
fn a_move_through_the_table_is_vetoed_before_it_begins() {
    let goal = beyond_the_table();
    let mut rig = Rig::at_home();
    let before = rig.angles.clone();
    for _ in 0..50 {
        let vetoed = rig.tick(&go("left", &goal), 0.0).unwrap_err();
        assert!(
            vetoed.to_string().starts_with("limb left would come"),
            "{vetoed}"
        );
    }
    assert_eq!(rig.angles, before);
    // Half as far, in steps that a script may make.
    for _ in 0..400 {
        let ways = goal.iter().zip(&rig.angles[0]);
        let step = ways.map(|(goal, at)| at + (goal - at).clamp(-0.15, 0.15));
        let step: Vec<_> = step.collect();
        drop(rig.tick(&go("left", &step), 0.0));
    }
    let [links, fingers] = rig.narrowest();
    assert!(links > 0.3 && fingers > 0.05, "{links} {fingers}");
}

#[test]
fn the_other_arm_is_no_less_in_the_way_when_it_moves_as_well() {
    let mut rig = Rig::at_home();
    let mut both = turn("left", 0, -0.4);
    both.limbs.extend(turn("right", 0, 0.4).limbs);
    for _ in 0..500 {
        drop(rig.tick(&both, 0.0));
    }
    let [links, fingers] = rig.narrowest();
    assert!(links > 0.3 && fingers > 0.05, "{links} {fingers}");
}

/// The left fingers 8 mm above the table, and lower if the joint S1 turns on.
fn low() -> Rig {
    let rig = std::cell::RefCell::new(Rig::at_home());
    let at = |posture: &[f64], s1: f64| {
        let mut rig = rig.borrow_mut();
        rig.angles[0] = posture.to_vec();
        rig.angles[0][1] = s1;
        rig.narrowest()
    };
    let mut s1 = 0.0;
    let mut is_low = |posture: &[f64]| {
        if at(posture, posture[1])[1] < 0.1 || at(posture, posture[1] + 0.2)[1] > 0.0 {
            return false;
        }
        let (mut high, mut low) = (posture[1], posture[1] + 0.2);
        while low - high > 1e-6 {
            s1 = f64::midpoint(high, low);
            match at(posture, s1)[1] > 0.08 {
                true => high = s1,
                false => low = s1,
            }
        }
        at(posture, s1)[0] > 0.4
    };
    let posture = some_posture(&mut is_low);
    at(&posture, s1);
    let angles = rig.into_inner().angles;
    Rig::at([&angles[0], &angles[1]])
}

#[test]
fn what_is_too_near_can_only_leave() {
    let mut rig = low();
    let before = rig.narrowest();
    for _ in 0..300 {
        let down = rig.tick(&turn("left", 1, 0.1), 0.0);
        assert!(is_vetoed(&down), "{down:?}");
    }
    assert_eq!(rig.narrowest(), before);
    for _ in 0..300 {
        rig.tick(&turn("left", 1, -0.1), 0.0).unwrap();
    }
    assert!(rig.narrowest()[1] > 0.5, "{:?}", rig.narrowest());
}

#[test]
fn noise_is_no_ratchet() {
    // Near already, and from above.
    for is_near in [true, false] {
        let mut rig = if is_near { low() } else { Rig::at_home() };
        let begun = rig.narrowest()[1];
        for tick in 0..6000 {
            let speed = if tick < 3000 && !is_near { 0.3 } else { 0.02 };
            drop(rig.tick(&turn("left", 1, speed), 2e-3));
        }
        let [links, fingers] = rig.narrowest();
        let least = begun.min(0.1) - 0.05;
        assert!(fingers > least && links > 0.3, "{begun}: {fingers} {links}");
    }
}
