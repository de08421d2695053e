//! A robot that is driven.

use std::{
    fmt,
    sync::{Arc, Mutex, MutexGuard, PoisonError},
    thread::{Builder, JoinHandle, sleep},
    time::Duration,
};

use serde_json::Value as Json;

use crate::{
    address::{Address, RobotWay},
    clock::WallClock,
    error::BridgeError,
    guard::Guard,
    interruption,
    observation::{PATIENCE, observe, read_until},
    options::BridgeOptions,
    orders::{GripperMotion, RobotOrder, message, topics},
    pilot::Pilot,
    profile::BridgeProfile,
    ros1::Ros1,
    rosbridge::Rosbridge,
    sentinel::Sentinel,
    state::{RobotHealth, RobotState, StateReader},
    target::{RobotTarget, TargetError},
    tolerances::{LONGEST_PERIOD, REPETITION},
    transport::{Transport, TransportError},
    watchdog::{PERIOD, StopReason, WatchdogState, unfit},
};

/// The time from one request to be switched on to the next.
const ENABLE_PERIOD: Duration = Duration::from_millis(100);

/// How long a gripper may take to find out its range.
const CALIBRATION: Duration = Duration::from_secs(10);

/// The least time for which states are looked at before a robot is driven: they may come too seldom.
const LEAST_LOOK: Duration = Duration::from_millis(200);

/// How soon the watchdog notices that there is a new target, and that a new state is known.
const ATTENTION: Duration = Duration::from_millis(1);

/// A robot that is driven. A thread of its own, the watchdog's, has the connection; the program sets a target, and reads the state.
///
/// Dropping it brings the robot to rest.
pub struct Bridge {
    profile: BridgeProfile,
    driven: Vec<usize>,
    clock: WallClock,
    pilot: Arc<Mutex<Pilot>>,
    guard: Option<Box<dyn Guard>>,
    thread: Option<JoinHandle<()>>,
    /// After the thread: it is told that the robot rests.
    sentinel: Option<Sentinel>,
}

impl fmt::Debug for Bridge {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut debug = f.debug_struct("Bridge");
        debug.field("robot", &self.profile.robot);
        debug
            .field("watchdog", &self.watchdog())
            .finish_non_exhaustive()
    }
}

impl Bridge {
    /// Connects to a robot. Nothing moves before [`arm`](Self::arm), except for grippers that are calibrated.
    ///
    /// # Errors
    /// It cannot be reached, is silent or speaks too seldom, has unknown software, is not on, or nobody listens to its commands.
    pub fn connect(
        address: &Address,
        profile: &BridgeProfile,
        options: &BridgeOptions,
    ) -> Result<Self, BridgeError> {
        let clock = WallClock::start();
        let (host, port) = (&address.host, address.port);
        let transport: Box<dyn Transport> = match address.way {
            RobotWay::Ros => Box::new(Ros1::connect(host, port, clock)?),
            RobotWay::Rosbridge => Box::new(Rosbridge::connect(host, port, clock)?),
        };
        Self::over(transport, profile, options, clock)
    }

    /// The same over a connection, which has this clock.
    ///
    /// # Errors
    /// As [`connect`](Self::connect).
    pub fn over(
        mut transport: Box<dyn Transport>,
        profile: &BridgeProfile,
        options: &BridgeOptions,
        clock: WallClock,
    ) -> Result<Self, BridgeError> {
        let mut pilot = Pilot::new(profile, options)?;
        let driven = pilot.driven().to_vec();
        let mut reader = observe(&mut *transport, profile, clock)?;
        if !options.any_software {
            check_software(&mut *transport, profile)?;
        }
        for (topic, is_latched) in topics(profile, &driven) {
            transport.advertise(&topic, is_latched)?;
        }
        if options.enable {
            enable(&mut *transport, &mut reader, profile, clock)?;
        }
        look(&mut *transport, &mut reader, profile, clock)?;
        find_listeners(&mut *transport, &mut reader, profile, &driven, clock)?;
        if options.calibrate {
            for limb in &driven {
                calibrate(&mut *transport, &mut reader, profile, *limb, clock)?;
            }
        }
        pilot.hear(reader.state());
        let pilot = Arc::new(Mutex::new(pilot));
        interruption::register(&pilot, clock);
        let of_thread = pilot.clone();
        let commands = command_topics(profile, &driven);
        let thread = Builder::new().name("robot's watchdog".into());
        let thread =
            thread.spawn(move || watch(&mut *transport, reader, &commands, &of_thread, clock));
        Ok(Self {
            profile: profile.clone(),
            driven,
            clock,
            pilot,
            guard: None,
            sentinel: None,
            thread: Some(thread.map_err(BridgeError::Thread)?),
        })
    }

    /// Gives somebody a say in what the robot is sent.
    pub fn set_guard(&mut self, guard: impl Guard + 'static) {
        self.guard = Some(Box::new(guard));
    }

    /// Lets a process of its own bring the robot to rest if this one is killed.
    pub fn set_sentinel(&mut self, sentinel: Sentinel) {
        self.sentinel = Some(sentinel);
    }

    /// Begins to drive the robot, which stays where it is until there is a target. From now on targets must be set again and again.
    ///
    /// # Errors
    /// It cannot be driven now, or was stopped.
    pub fn arm(&mut self) -> Result<(), BridgeError> {
        lock(&self.pilot).arm(self.clock.now())?;
        let armed = self.sentinel.as_mut().map_or(Ok(()), Sentinel::arm);
        armed.inspect_err(|error| {
            let reason = StopReason::Interrupted(error.to_string());
            lock(&self.pilot).stop(reason, self.clock.now());
        })
    }

    /// Says what the robot is to do from now on, for [`OLDEST_TARGET`](crate::OLDEST_TARGET) at most.
    ///
    /// # Errors
    /// The robot cannot do it, the guard vetoes it (then the joints rest), or the robot is not driven (any more).
    pub fn aim(&mut self, target: RobotTarget) -> Result<(), TargetError> {
        let (motion, state) = {
            let pilot = lock(&self.pilot);
            let motion = pilot.consider(self.clock.now(), &target)?;
            if self.thread.as_ref().is_none_or(JoinHandle::is_finished) {
                return Err(TargetError::NotDriven("its watchdog has ended".into()));
            }
            (motion, pilot.state().clone())
        };
        // Without the lock: the watchdog waits for nobody.
        let guard = self.guard.as_mut();
        let veto = guard.and_then(|guard| guard.veto(&state, &motion));
        lock(&self.pilot).settle(self.clock.now(), target, veto)
    }

    /// The robot's state as of its last messages.
    pub fn state(&self) -> RobotState {
        lock(&self.pilot).state().clone()
    }

    /// Whether a limb, by its name, is driven.
    pub fn drives(&self, limb: &str) -> bool {
        let place = self.profile.limb(limb);
        place.is_some_and(|place| self.driven.contains(&place))
    }

    /// The robot's names for the joints of a limb, from its base to its tip.
    pub fn joints_of(&self, limb: &str) -> impl Iterator<Item = &str> {
        let place = self.profile.limb(limb);
        let joints = place.map_or(&[][..], |place| &self.profile.limbs[place].joints);
        joints.iter().map(|joint| joint.name.as_str())
    }

    /// How old its joints' angles are.
    pub fn age(&self) -> Duration {
        let age = lock(&self.pilot).state().age(self.clock.now());
        age.unwrap_or(Duration::MAX)
    }

    /// What the watchdog does.
    pub fn watchdog(&self) -> WatchdogState {
        lock(&self.pilot).watchdog().clone()
    }

    /// Brings the robot to rest, lets it hold its position, ends the connection, and says why the robot was stopped first: by this, or something before.
    pub fn stop(mut self) -> StopReason {
        self.end();
        match self.watchdog() {
            WatchdogState::Ramping(reason) | WatchdogState::Held(reason) => reason,
            WatchdogState::Watching | WatchdogState::Armed => StopReason::Asked,
        }
    }

    fn end(&mut self) {
        lock(&self.pilot).stop(StopReason::Asked, self.clock.now());
        if let Some(thread) = self.thread.take() {
            drop(thread.join());
        }
    }
}

impl Drop for Bridge {
    fn drop(&mut self) {
        self.end();
    }
}

fn lock(pilot: &Mutex<Pilot>) -> MutexGuard<'_, Pilot> {
    pilot.lock().unwrap_or_else(PoisonError::into_inner)
}

fn check_software(
    transport: &mut dyn Transport,
    profile: &BridgeProfile,
) -> Result<(), BridgeError> {
    let Some(software) = &profile.software else {
        return Ok(());
    };
    let found = transport.parameter(&software.parameter, PATIENCE)?;
    let found = found.as_ref().and_then(Json::as_str).map(str::trim);
    if found.is_some_and(|found| software.known.iter().any(|known| known == found)) {
        return Ok(());
    }
    let unknown = || format!("of no version in {}", software.parameter);
    Err(BridgeError::Software {
        robot: profile.robot.clone(),
        found: found.map_or_else(unknown, str::to_owned),
        known: software.known.clone(),
    })
}

/// Switches the motors on, once, if they are off and nothing else is the matter.
fn enable(
    transport: &mut dyn Transport,
    reader: &mut StateReader,
    profile: &BridgeProfile,
    clock: WallClock,
) -> Result<(), TransportError> {
    let Some((topic, message)) = message(profile, &RobotOrder::Enable) else {
        return Ok(());
    };
    let deadline = clock.now() + PATIENCE;
    let is_off = |reader: &StateReader| reader.state().health == Some(RobotHealth::Disabled);
    while is_off(reader) && !clock.until(deadline).is_zero() {
        transport.publish(&topic, &message)?;
        read_until(transport, reader, clock, ENABLE_PERIOD, |reader| {
            !is_off(reader)
        })?;
    }
    Ok(())
}

/// Lets a limb's gripper find out its range, if it has one that does not know it.
fn calibrate(
    transport: &mut dyn Transport,
    reader: &mut StateReader,
    profile: &BridgeProfile,
    limb: usize,
    clock: WallClock,
) -> Result<(), BridgeError> {
    let name = &profile.limbs[limb].name;
    let reading = |reader: &StateReader| reader.state().grippers.get(name).copied();
    if profile.limbs[limb].gripper.is_some() {
        read_until(transport, reader, clock, PATIENCE, |reader| {
            reading(reader).is_some()
        })?;
    }
    let Some(before) = reading(reader) else {
        return Ok(());
    };
    let order = RobotOrder::MoveGripper {
        limb,
        id: before.id,
        motion: GripperMotion::Calibrate,
        sequence: before.sequence.unwrap_or_default().wrapping_add(1),
    };
    let is_calibrated = |reader: &StateReader| reading(reader).is_some_and(|it| it.is_calibrated);
    let deadline = clock.now() + CALIBRATION;
    while !is_calibrated(reader) {
        if clock.until(deadline).is_zero() {
            return Err(BridgeError::NotCalibrated {
                limb: name.clone(),
                patience: CALIBRATION,
            });
        }
        // Once it has begun, it is not begun again.
        let has_begun = reading(reader).is_some_and(|it| it.sequence != before.sequence);
        if let Some((topic, message)) = message(profile, &order).filter(|_| !has_begun) {
            transport.publish(&topic, &message)?;
        }
        read_until(transport, reader, clock, REPETITION, is_calibrated)?;
    }
    Ok(())
}

/// Looks at the robot until it can be driven, which may take a moment: a backlog of messages comes first, and a simulator's clock must be known.
fn look(
    transport: &mut dyn Transport,
    reader: &mut StateReader,
    profile: &BridgeProfile,
    clock: WallClock,
) -> Result<(), BridgeError> {
    let begun = clock.now();
    read_until(transport, reader, clock, PATIENCE, |reader| {
        let now = clock.now();
        now.saturating_sub(begun) > LEAST_LOOK
            && reader.period().is_some_and(|it| it <= LONGEST_PERIOD)
            && unfit(now, reader.state()).is_none()
    })?;
    let rate = reader.period().map_or(0.0, |it| 1.0 / it.as_secs_f64());
    let reason = unfit(clock.now(), reader.state());
    let is_slow = rate * LONGEST_PERIOD.as_secs_f64() < 1.0;
    match reason {
        // Slow states are old ones.
        None | Some(StopReason::StaleState { .. }) if is_slow => Err(BridgeError::SlowStates {
            robot: profile.robot.clone(),
            topic: profile.joint_states.clone(),
            rate,
        }),
        Some(reason) => Err(BridgeError::NotReady {
            robot: profile.robot.clone(),
            reason,
        }),
        None => Ok(()),
    }
}

/// The topics of the limbs' commands.
fn command_topics(profile: &BridgeProfile, driven: &[usize]) -> Vec<String> {
    let limbs = driven.iter().map(|place| &profile.limbs[*place]);
    limbs
        .map(|limb| limb.velocities.topic().to_owned())
        .collect()
}

/// Waits until somebody listens to the commands, as far as the connection knows.
fn find_listeners(
    transport: &mut dyn Transport,
    reader: &mut StateReader,
    profile: &BridgeProfile,
    driven: &[usize],
    clock: WallClock,
) -> Result<(), BridgeError> {
    let commands = command_topics(profile, driven);
    let deadline = clock.now() + PATIENCE;
    loop {
        let mut topics = commands.iter();
        let Some(topic) = topics.find(|topic| transport.listeners(topic) == Some(0)) else {
            return Ok(());
        };
        if clock.until(deadline).is_zero() {
            let topic = topic.clone();
            return Err(BridgeError::NotReady {
                robot: profile.robot.clone(),
                reason: StopReason::Unheard { topic },
            });
        }
        read_until(transport, reader, clock, PERIOD, |_| false)?;
    }
}

/// The watchdog's thread: reads until the next look is due or the program has set a target, looks, and sends.
fn watch(
    transport: &mut dyn Transport,
    mut reader: StateReader,
    commands: &[String],
    pilot: &Mutex<Pilot>,
    clock: WallClock,
) {
    let mut due = clock.now();
    let mut answered = Duration::ZERO;
    let mut is_lost = false;
    loop {
        // A look that was missed is not made up for.
        due = (due + PERIOD).max(clock.now() + PERIOD / 10);
        let read = loop {
            if is_lost {
                sleep(clock.until(due));
                break Ok(());
            }
            let slice = clock.until(due).min(ATTENTION);
            let read = read_until(transport, &mut reader, clock, slice, |_| false);
            let mut pilot = lock(pilot);
            if pilot.state().joints_at != reader.state().joints_at {
                pilot.hear(reader.state());
            }
            if read.is_err() || pilot.set_at() > answered || clock.until(due).is_zero() {
                answered = pilot.set_at();
                break read;
            }
        };
        let now = clock.now();
        let (messages, is_done) = {
            let mut pilot = lock(pilot);
            let mut state = reader.state().clone();
            state.nonsense += transport.nonsense();
            pilot.hear(&state);
            if let Err(error) = read {
                is_lost = true;
                pilot.stop(StopReason::Disconnected(error.to_string()), now);
            }
            for topic in commands {
                if let Some(count) = transport.listeners(topic) {
                    pilot.note_listeners(now, topic, count);
                }
            }
            (pilot.tick(now), pilot.is_done(now))
        };
        for (topic, message) in messages {
            // What one limb no longer takes, the others still do.
            if let Err(error) = transport.publish(&topic, &message) {
                lock(pilot).stop(StopReason::Disconnected(error.to_string()), clock.now());
            }
        }
        if is_done {
            return;
        }
    }
}
