//! A trial: a program drives the robot through a history, and the invariants are looked after.

use std::{fmt, time::Duration};

use serde_json::Value as Json;
use tabletop_bridge::{
    BridgeOptions, BridgeProfile, HOLD, LimbTarget, PERIOD, Pilot, RAMP, RobotHealth, RobotTarget,
    StateReader, StopReason, TargetError, WatchdogState,
};
use tabletop_controller::angles;
use tabletop_core::{RobotLayout, Table};
use tabletop_planner::{PartGap, RobotBody};
use tabletop_real::BodyGuard;

use crate::{
    history::{Fault, History, TICKS, What},
    robot::SimulatedBaxter,
};

const LIMBS: [&str; 2] = ["left", "right"];

/// What no gap may be narrower than, in units: 3 cm, and 5 mm for fingers above the table.
const LINKS: f32 = 0.3;
const FINGERS: f32 = 0.05;

/// How much nearer a link may come whose arm has a stuck joint, in units.
const ASTRAY: f32 = 0.1;

/// The time, in s, for which a joint may go on at its speed after a fault: 0.06 rad at 0.5 rad/s. What it may go on beyond that, in rad: noise.
const RUN_ON: f64 = 0.12;
const SLACK: f64 = 0.006;

/// What a joint that gets faster may be faster, in rad/s, until it is stopped.
const GAIN: f64 = 0.5;

/// The greatest speed of any joint, in rad/s.
const MOST_SPEED: f64 = 4.0;

/// Every how many ticks gaps are looked at.
const LOOK: u64 = 4;

/// An invariant that does not hold.
#[derive(Debug)]
pub struct Violation {
    tick: u64,
    what: String,
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "at tick {}: {}", self.tick, self.what)
    }
}

pub struct Trial {
    profile: BridgeProfile,
    body: RobotBody,
    gaps: Vec<PartGap>,
    table: Table,
}

/// What was true when something went wrong.
struct Moment {
    angles: Vec<f64>,
    speeds: Vec<f64>,
    is_steady: Vec<bool>,
    was_driven: bool,
}

/// A trial that is going on.
struct Run<'t> {
    trial: &'t Trial,
    history: &'t History,
    robot: SimulatedBaxter,
    reader: StateReader,
    pilot: Pilot,
    guard: BodyGuard,
    now: Duration,
    target: Option<RobotTarget>,
    fault: Option<(Fault, Moment)>,
    stalled_until: u64,
    /// The true speeds of the last ticks.
    speeds: Vec<Vec<f64>>,
}

impl Trial {
    pub fn new() -> Self {
        let profile = BridgeProfile::shipped("baxter").unwrap();
        let model = tabletop_kinematics::baxter().unwrap();
        let table = Table::default();
        let body = RobotBody::new(RobotLayout::baxter(), model, &table).unwrap();
        Self {
            profile,
            gaps: body.gaps(),
            body,
            table,
        }
    }

    /// How it ends.
    pub fn run(&self, history: &History) -> Result<String, Violation> {
        let options = BridgeOptions {
            speed: history.share,
            allow_moves: true,
            ..BridgeOptions::default()
        };
        let home = [0, 1].map(|limb: usize| self.body.limbs[limb].home[..7].to_vec());
        let guard = BodyGuard::new(self.body.clone(), self.table);
        let mut run = Run {
            trial: self,
            history,
            robot: SimulatedBaxter::new(&self.profile, history, home),
            reader: StateReader::new(&self.profile),
            pilot: Pilot::new(&self.profile, &options).unwrap(),
            guard,
            now: Duration::ZERO,
            target: None,
            fault: None,
            stalled_until: 0,
            speeds: Vec::new(),
        };
        let rest = ((RAMP + HOLD).as_millis() / PERIOD.as_millis()) as u64 + 10;
        for tick in 0..TICKS + rest {
            run.tick(tick).map_err(|what| Violation { tick, what })?;
        }
        let tick = TICKS + rest;
        run.end().map_err(|what| Violation { tick, what })
    }
}

impl Run<'_> {
    fn tick(&mut self, tick: u64) -> Result<(), String> {
        for event in self.history.events.iter().filter(|it| it.tick == tick) {
            self.happen(&event.what, tick);
        }
        if tick == TICKS {
            self.pilot.stop(StopReason::Asked, self.now);
        }
        self.now += PERIOD;
        self.robot.pass(self.now);
        self.speeds.push(self.true_speeds());
        if tick >= self.stalled_until {
            self.program(tick);
            self.look()?;
        }
        if tick.is_multiple_of(LOOK) {
            self.check_gaps()?;
        }
        self.check_way()
    }

    fn happen(&mut self, what: &What, tick: u64) {
        let limb_target = |limb: usize, target: LimbTarget| RobotTarget {
            limbs: [(LIMBS[limb].to_owned(), target)].into(),
            ..RobotTarget::default()
        };
        match what {
            What::Turn(limb, speeds) => {
                self.target = Some(limb_target(*limb, LimbTarget::Velocities(speeds.clone())));
            }
            What::Go(limb, ways) => {
                let joints = &self.trial.profile.limbs[*limb].joints;
                let state = self.pilot.state();
                let goal = joints.iter().zip(ways).map(|(joint, way)| {
                    state.joints.get(&joint.name).map_or(0.0, |it| it.position) + way
                });
                self.target = Some(limb_target(*limb, LimbTarget::Positions(goal.collect())));
            }
            What::Grip(limb, opening) => {
                self.target = Some(RobotTarget {
                    grippers: [(LIMBS[*limb].to_owned(), *opening)].into(),
                    ..RobotTarget::default()
                });
            }
            What::Rest => self.target = Some(RobotTarget::default()),
            What::Silence => self.target = None,
            What::Fault(fault) => {
                self.fault = Some((*fault, self.moment()));
                self.robot.suffer(*fault);
                match fault {
                    Fault::Stall(ticks) => self.stalled_until = tick + ticks,
                    Fault::Signal => {
                        let reason = StopReason::Interrupted("SIGTERM ended the program".into());
                        self.pilot.stop(reason, self.now);
                    }
                    Fault::Lost => {
                        let reason = StopReason::Disconnected("it is lost".into());
                        self.pilot.stop(reason, self.now);
                    }
                    Fault::EmergencyStop
                    | Fault::Disabled
                    | Fault::Error
                    | Fault::SilentStates
                    | Fault::SilentHealth
                    | Fault::SilentGripper
                    | Fault::GripperError
                    | Fault::Restart(..)
                    | Fault::SecondPublisher
                    | Fault::Stuck(..)
                    | Fault::Deaf => {}
                }
            }
        }
    }

    /// The program, 60 times a second.
    fn program(&mut self, tick: u64) {
        for received in self.robot.hear(tick) {
            self.reader.take(&received);
        }
        self.pilot.hear(self.reader.state());
        if !matches!(tick % 5, 0 | 2 | 3) || tick > TICKS {
            return;
        }
        let Some(target) = self.target.clone() else {
            return;
        };
        let is_order = target != RobotTarget::default();
        if *self.pilot.watchdog() == WatchdogState::Watching
            && (!is_order || self.pilot.arm(self.now).is_err())
        {
            return;
        }
        match self.pilot.aim(self.now, target, Some(&mut self.guard)) {
            Ok(()) | Err(TargetError::Vetoed(_) | TargetError::NotDriven(_)) => {}
            Err(TargetError::NoGripper { .. }) => {}
            Err(error) => panic!("{error}"),
        }
    }

    /// The watchdog, 100 times a second.
    fn look(&mut self) -> Result<(), String> {
        let was_driven = *self.pilot.watchdog() != WatchdogState::Watching;
        let was_done = self.pilot.is_done(self.now);
        let messages = self.pilot.tick(self.now);
        if !was_driven && !messages.is_empty() {
            return Err(format!("a command without an order: {messages:?}"));
        }
        if was_done && !messages.is_empty() {
            return Err(format!("a command after the end: {messages:?}"));
        }
        let health = self.pilot.state().health;
        let is_off = [RobotHealth::EmergencyStop, RobotHealth::Disabled].map(Some);
        if is_off.contains(&health) && !messages.is_empty() {
            return Err(format!(
                "a command to a robot that is stopped: {messages:?}"
            ));
        }
        for (topic, message) in messages {
            self.check_speeds(&topic, &message)?;
            if !matches!(self.fault, Some((Fault::Lost, _))) {
                self.robot.send(topic, message);
            }
        }
        match self.robot.dropped {
            0 => Ok(()),
            _ => Err("a command beyond a limit".into()),
        }
    }

    fn check_speeds(&self, topic: &str, message: &Json) -> Result<(), String> {
        if message["mode"].as_i64() != Some(2) {
            return Ok(());
        }
        let limb = usize::from(topic.contains("right"));
        let joints = &self.trial.profile.limbs[limb].joints;
        let speeds = message["command"].as_array().unwrap().iter();
        let too_fast = joints.iter().zip(speeds).find(|(joint, speed)| {
            let most = joint.speed * self.history.share + 1e-9;
            speed.as_f64().is_none_or(|speed| speed.abs() > most)
        });
        too_fast.map_or(Ok(()), |(joint, speed)| {
            Err(format!("{} is to turn at {speed} rad/s", joint.name))
        })
    }

    fn check_gaps(&self) -> Result<(), String> {
        let Trial {
            body, gaps, table, ..
        } = self.trial;
        let postures = self.robot.arms.iter();
        let postures: Vec<_> = postures
            .map(|arm| angles(arm.angles.iter().copied()))
            .collect();
        let limbs = body.limbs.iter().zip(&self.robot.arms);
        let openings: Vec<_> = limbs
            .map(|(limb, arm)| limb.widest * arm.opening as f32)
            .collect();
        let posed = body.posed(&postures, &openings);
        // An arm with a stuck joint is elsewhere than it will be thought to be, until that is found out.
        let is_stuck = matches!(self.fault, Some((Fault::Stuck(..), _)));
        let astray = if is_stuck { ASTRAY } else { 0.0 };
        for gap in gaps {
            let least = if gap.is_of_fingers { FINGERS } else { LINKS } - astray;
            let width = body.width(gap, &posed, table, least);
            if width < least {
                return Err(format!("{}: {width} units", body.name(gap)));
            }
        }
        Ok(())
    }

    fn moment(&self) -> Moment {
        let speeds = self.true_speeds();
        let before = self.speeds.len().checked_sub(6).map(|at| &self.speeds[at]);
        let is_steady = speeds.iter().enumerate().map(|(place, speed)| {
            before.is_some_and(|before| (before[place] - speed).abs() < 0.02 * speed.abs())
        });
        Moment {
            angles: self.true_angles(),
            is_steady: is_steady.collect(),
            speeds,
            was_driven: *self.pilot.watchdog() == WatchdogState::Armed,
        }
    }

    fn true_angles(&self) -> Vec<f64> {
        let arms = self.robot.arms.iter();
        arms.flat_map(|arm| arm.angles.clone()).collect()
    }

    fn true_speeds(&self) -> Vec<f64> {
        let arms = self.robot.arms.iter();
        arms.flat_map(|arm| arm.speeds.clone()).collect()
    }

    /// Joints do not go on for long after a fault that is noticed at once.
    fn check_way(&self) -> Result<(), String> {
        let Some((fault, moment)) = &self.fault else {
            return Ok(());
        };
        let is_noticed_at_once = match fault {
            Fault::EmergencyStop
            | Fault::Disabled
            | Fault::Error
            | Fault::SilentStates
            | Fault::Restart(..)
            | Fault::SecondPublisher
            | Fault::Deaf
            | Fault::Stall(_)
            | Fault::Signal
            | Fault::Lost => true,
            Fault::SilentHealth | Fault::SilentGripper | Fault::GripperError | Fault::Stuck(..) => {
                false
            }
        };
        if !is_noticed_at_once || !moment.was_driven {
            return Ok(());
        }
        let History {
            state_delay,
            command_delay,
            ..
        } = self.history;
        // It speaks of its health ten times a second.
        let health_period = if *fault == Fault::Error { 0.1 } else { 0.0 };
        let seconds = RUN_ON + health_period + (*state_delay + *command_delay).as_secs_f64();
        let ways = self
            .true_angles()
            .into_iter()
            .zip(&moment.angles)
            .enumerate();
        for (place, (now, then)) in ways {
            let gain = if moment.is_steady[place] { 0.0 } else { GAIN };
            // Its own controller follows the encoder that began anew, until it is told to stop.
            let has_begun_anew = *fault == Fault::Restart(place / 7, place % 7);
            let astray = match has_begun_anew {
                true => MOST_SPEED * (seconds - RUN_ON + 0.03),
                false => 0.0,
            };
            let most = (moment.speeds[place].abs() + gain) * seconds + SLACK + astray;
            let way = (now - then).abs();
            if way > most {
                return Err(format!(
                    "joint {place} went on for {way:.4} rad after {fault:?}, at {:.3} rad/s ({most:.4} at most)",
                    moment.speeds[place]
                ));
            }
        }
        Ok(())
    }

    fn end(&self) -> Result<String, String> {
        let WatchdogState::Held(reason) = self.pilot.watchdog() else {
            return Err(format!("it has not ended: {:?}", self.pilot.watchdog()));
        };
        let fault = self.fault.as_ref();
        let fault = fault.filter(|(_, moment)| moment.was_driven).map(|it| it.0);
        let is_expected = match reason {
            StopReason::Asked => !matches!(
                fault,
                Some(
                    Fault::EmergencyStop
                        | Fault::Disabled
                        | Fault::Restart(..)
                        | Fault::Signal
                        | Fault::Lost
                )
            ),
            StopReason::ProgramLate { .. } => true,
            StopReason::Interrupted(_) => self.is_of(|it| it == Fault::Signal),
            StopReason::StaleState { .. } => {
                self.is_of(|it| matches!(it, Fault::SilentStates | Fault::Stall(_)))
            }
            StopReason::SilentHealth { .. } => {
                self.is_of(|it| matches!(it, Fault::SilentHealth | Fault::Stall(_)))
            }
            StopReason::Jump(_) => {
                self.is_of(|it| matches!(it, Fault::Restart(..) | Fault::SecondPublisher))
            }
            StopReason::EmergencyStop => self.is_of(|it| it == Fault::EmergencyStop),
            StopReason::Disabled => self.is_of(|it| it == Fault::Disabled),
            StopReason::RobotError => self.is_of(|it| it == Fault::Error),
            StopReason::WatchdogLate { .. } => self.is_of(|it| matches!(it, Fault::Stall(_))),
            StopReason::Deviation { .. } | StopReason::Unfollowed { .. } => self
                .is_of(|it| matches!(it, Fault::Stuck(..) | Fault::Deaf | Fault::SecondPublisher)),
            StopReason::Unheard { .. } => self.is_of(|it| it == Fault::Deaf),
            StopReason::GripperError { .. } => self.is_of(|it| it == Fault::GripperError),
            StopReason::SilentGripper { .. } => {
                self.is_of(|it| matches!(it, Fault::SilentGripper | Fault::Stall(_)))
            }
            StopReason::Disconnected(_) => self.is_of(|it| it == Fault::Lost),
        };
        match is_expected {
            true => {
                let name = format!("{reason:?}");
                let end = name.split([' ', '(', '{']).next().unwrap_or_default();
                Ok(end.to_owned())
            }
            false => Err(format!(
                "it ended without a cause, or for another one: {reason:?}"
            )),
        }
    }

    fn is_of(&self, is_cause: impl Fn(Fault) -> bool) -> bool {
        self.fault
            .as_ref()
            .is_some_and(|(fault, _)| is_cause(*fault))
    }
}
