//! A Baxter without a body, in virtual time: what it is told it does after a while, and what it does it says after a while.

use std::{collections::VecDeque, time::Duration};

use serde_json::{Value as Json, json};
use tabletop_bridge::{BridgeProfile, Received};

use crate::history::{Fault, History};

const SIDES: [&str; 2] = ["left", "right"];

/// How long joints go on without a command until somebody sets another limit, in s.
const TIME_LIMIT: f64 = 0.2;

pub struct SimulatedBaxter {
    profile: BridgeProfile,
    noise: f64,
    pace: f64,
    delays: [Duration; 2],
    now: Duration,
    pub fault: Option<Fault>,
    pub arms: [SimulatedArm; 2],
    /// Messages on their way to it, and from it.
    commands: VecDeque<(Duration, String, Json)>,
    said: VecDeque<(Duration, String, Json)>,
    /// Commands that passed a limit of a joint, and were dropped.
    pub dropped: usize,
    /// Commands of motion that were received.
    pub received: usize,
}

/// An arm: where it truly is.
#[derive(Clone, Debug)]
pub struct SimulatedArm {
    pub angles: Vec<f64>,
    /// What encoders say beyond that.
    offsets: Vec<f64>,
    pub speeds: Vec<f64>,
    goals: Option<Vec<f64>>,
    commanded_at: Duration,
    time_limit: f64,
    pub opening: f64,
    sequence: Option<u64>,
}

impl SimulatedBaxter {
    pub fn new(profile: &BridgeProfile, history: &History, postures: [Vec<f64>; 2]) -> Self {
        Self {
            profile: profile.clone(),
            noise: history.noise,
            pace: history.pace,
            delays: [history.state_delay, history.command_delay],
            now: Duration::ZERO,
            fault: None,
            arms: postures.map(|angles| SimulatedArm {
                offsets: vec![0.0; angles.len()],
                speeds: vec![0.0; angles.len()],
                goals: None,
                angles,
                commanded_at: Duration::ZERO,
                time_limit: TIME_LIMIT,
                opening: 1.0,
                sequence: None,
            }),
            commands: VecDeque::new(),
            said: VecDeque::new(),
            dropped: 0,
            received: 0,
        }
    }

    /// Something goes wrong.
    pub fn suffer(&mut self, fault: Fault) {
        self.fault = Some(fault);
        if let Fault::Restart(limb, joint) = fault {
            self.arms[limb].offsets[joint] = 1.5;
        }
    }

    /// A message is sent to it.
    pub fn send(&mut self, topic: String, message: Json) {
        let is_cut = matches!(self.fault, Some(Fault::Deaf));
        if !is_cut {
            self.commands
                .push_back((self.now + self.delays[1], topic, message));
        }
    }

    /// Time passes until a moment.
    pub fn pass(&mut self, now: Duration) {
        let seconds = (now - self.now).as_secs_f64();
        self.now = now;
        while self.commands.front().is_some_and(|(at, ..)| *at <= now) {
            let (_, topic, message) = self.commands.pop_front().unwrap();
            self.obey(&topic, &message);
        }
        let is_off = matches!(self.fault, Some(Fault::EmergencyStop | Fault::Disabled));
        for (limb, arm) in self.arms.iter_mut().enumerate() {
            let stuck = match self.fault {
                Some(Fault::Stuck(of, joint)) if of == limb => Some(joint),
                _ => None,
            };
            // A simulator that is slow moves slowly, too.
            arm.pass(now, seconds * self.pace, is_off, stuck);
        }
    }

    fn obey(&mut self, topic: &str, message: &Json) {
        let limb = usize::from(topic.contains("right"));
        let now = self.now;
        let arm = &mut self.arms[limb];
        if topic.ends_with("/joint_command") {
            self.received += 1;
            let numbers = message["command"].as_array().unwrap().iter();
            let numbers: Vec<_> = numbers.map(|it| it.as_f64().unwrap()).collect();
            arm.commanded_at = now;
            match message["mode"].as_i64().unwrap() {
                2 => {
                    let joints = self.profile.limbs[limb].joints.iter();
                    let passes = joints.zip(&arm.angles).zip(&numbers).zip(&arm.offsets).any(
                        |(((joint, angle), speed), offset)| {
                            let next = angle + offset + 0.01 * speed;
                            (next < joint.limits.0 && *speed < 0.0)
                                || (next > joint.limits.1 && *speed > 0.0)
                        },
                    );
                    // Where a restarted encoder has it is nobody's fault.
                    if passes && arm.offsets.iter().all(|it| *it == 0.0) {
                        self.dropped += 1;
                        return;
                    }
                    (arm.speeds, arm.goals) = (numbers, None);
                }
                1 => arm.goals = Some(numbers),
                mode => panic!("mode {mode}"),
            }
        } else if topic.ends_with("/joint_command_timeout") {
            arm.time_limit = message["data"].as_f64().unwrap();
        } else if topic.ends_with("_gripper/command") {
            self.received += 1;
            arm.sequence = message["sequence"].as_u64();
            let arguments: Json = serde_json::from_str(message["args"].as_str().unwrap()).unwrap();
            arm.opening = arguments["position"].as_f64().unwrap() / 100.0;
        }
    }

    /// What arrives of it until now; it speaks 100 times a second, of its health and its grippers ten times.
    pub fn hear(&mut self, tick: u64) -> Vec<Received> {
        if self.fault == Some(Fault::Lost) {
            return Vec::new();
        }
        for (topic, message) in self.messages(tick) {
            self.said
                .push_back((self.now + self.delays[0], topic, message));
        }
        let mut heard = Vec::new();
        while self.said.front().is_some_and(|(at, ..)| *at <= self.now) {
            let (_, topic, message) = self.said.pop_front().unwrap();
            let at = self.now;
            heard.push(Received { topic, message, at });
        }
        heard
    }

    fn messages(&self, tick: u64) -> Vec<(String, Json)> {
        let mut messages = Vec::new();
        if self.fault != Some(Fault::SilentStates) {
            messages.push((self.profile.joint_states.clone(), self.joints(tick)));
        }
        if tick.is_multiple_of(10) {
            if self.fault != Some(Fault::SilentHealth) {
                let is = |fault: Fault| self.fault == Some(fault);
                let is_stopped = is(Fault::EmergencyStop);
                let health = json!({
                    "ready": true, "enabled": !is_stopped && !is(Fault::Disabled), "stopped": is_stopped, "error": is(Fault::Error),
                    "estop_button": u8::from(is_stopped), "estop_source": 0,
                });
                messages.push((self.profile.health.topic().to_owned(), health));
            }
            if self.fault != Some(Fault::SilentGripper) {
                for (side, arm) in SIDES.iter().zip(&self.arms) {
                    let error = u8::from(self.fault == Some(Fault::GripperError));
                    let state = json!({
                        "id": 65538, "calibrated": 1, "gripping": 0, "error": error, "position": 100.0 * arm.opening,
                        "command_sender": "tabletop", "command_sequence": arm.sequence.unwrap_or(0),
                    });
                    messages.push((format!("/robot/end_effector/{side}_gripper/state"), state));
                }
            }
        }
        messages
    }

    fn joints(&self, tick: u64) -> Json {
        let sent = 1000.0 + self.pace * self.now.as_secs_f64();
        let stamp = json!({"secs": sent as u64, "nsecs": (sent.fract() * 1e9) as u64});
        let (mut names, mut angles, mut speeds) =
            (vec!["head_pan".to_owned()], vec![0.0], vec![0.0]);
        for (limb, arm) in self.profile.limbs.iter().zip(&self.arms) {
            for (place, joint) in limb.joints.iter().enumerate() {
                let number = tick as f64 + 100.0 * place as f64;
                let noise = self.noise * (2.0 * (number * 0.618_034).fract() - 1.0);
                names.push(joint.name.clone());
                angles.push(arm.angles[place] + arm.offsets[place] + noise);
                speeds.push(arm.speeds[place]);
            }
        }
        if self.fault == Some(Fault::SecondPublisher) && tick.is_multiple_of(3) {
            angles.iter_mut().for_each(|angle| *angle = 0.9 - *angle);
        }
        json!({"header": {"stamp": stamp}, "name": names, "position": angles, "velocity": speeds})
    }
}

impl SimulatedArm {
    fn pass(&mut self, now: Duration, seconds: f64, is_off: bool, stuck: Option<usize>) {
        let is_over = (now - self.commanded_at).as_secs_f64() > self.time_limit;
        if is_off || is_over {
            self.speeds.fill(0.0);
            self.goals = None;
        }
        if let Some(goals) = &self.goals {
            let ways = goals.iter().zip(&self.angles).zip(&self.offsets);
            let speeds = ways.map(|((goal, angle), offset)| {
                ((goal - angle - offset) / seconds).clamp(-4.0, 4.0)
            });
            self.speeds = speeds.collect();
        }
        for (joint, (angle, speed)) in self.angles.iter_mut().zip(&self.speeds).enumerate() {
            if stuck != Some(joint) {
                *angle += speed * seconds;
            }
        }
    }
}
