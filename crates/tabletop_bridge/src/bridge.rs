//! A robot that is driven.

use std::{
    fmt, mem,
    sync::{Arc, Mutex, MutexGuard, PoisonError},
    thread::{Builder, JoinHandle},
    time::Duration,
};

use serde_json::Value as Json;

use crate::{
    address::{Address, RobotWay},
    clock::WallClock,
    error::BridgeError,
    guard::Guard,
    observation::{PATIENCE, observe, read_until},
    orders::{GripperMotion, RobotOrder, message, topics},
    profile::BridgeProfile,
    ros1::Ros1,
    rosbridge::Rosbridge,
    state::{RobotHealth, RobotState, StateReader},
    target::{RobotTarget, TargetError},
    transport::{Transport, TransportError},
    watchdog::{PERIOD, REPETITION, StopReason, Watchdog, WatchdogState, unfit},
};

/// The time from one request to be switched on to the next.
const ENABLE_PERIOD: Duration = Duration::from_millis(100);

/// How long a gripper may take to find out its range.
const CALIBRATION: Duration = Duration::from_secs(10);

/// How soon the watchdog notices that there is a new target, and that a new state is known.
const ATTENTION: Duration = Duration::from_millis(1);

/// How a robot is driven.
#[derive(Clone, Debug, PartialEq)]
pub struct BridgeOptions {
    /// The limbs that are driven, by name; all if there is none.
    pub limbs: Vec<String>,
    /// The share of the joints' greatest speeds that they may have, above 0 and at most 1.
    pub speed: f64,
    /// Whether positions may be farther away than [`FARTHEST_STEP`](crate::FARTHEST_STEP).
    pub allow_moves: bool,
    /// Whether its motors may be switched on at the start. They are never switched on again.
    pub enable: bool,
    /// Whether grippers that do not know their range may find it out at the start, by closing and opening.
    pub calibrate: bool,
    /// Whether a robot is driven whose software is not known.
    pub any_software: bool,
}

impl Default for BridgeOptions {
    fn default() -> Self {
        Self {
            limbs: Vec::new(),
            speed: 0.3, // as Baxter's SDK has it
            allow_moves: false,
            enable: false,
            calibrate: false,
            any_software: false,
        }
    }
}

/// A robot that is driven. A thread of its own, the watchdog's, has the connection; the program sets a target, and reads the state.
///
/// Dropping it brings the robot to rest.
pub struct Bridge {
    profile: BridgeProfile,
    driven: Vec<usize>,
    allow_moves: bool,
    clock: WallClock,
    shared: Arc<Mutex<Driving>>,
    guard: Option<Box<dyn Guard>>,
    thread: Option<JoinHandle<()>>,
}

/// What program and watchdog share.
struct Driving {
    watchdog: Watchdog,
    state: RobotState,
    target: RobotTarget,
    set_at: Duration,
    /// Orders of the program that wait to be sent.
    waiting: Vec<RobotOrder>,
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
    /// It cannot be reached, is silent, has unknown software, or is not on.
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
        if !(options.speed > 0.0 && options.speed <= 1.0) {
            return Err(BridgeError::Speed(options.speed));
        }
        let driven = driven(profile, options)?;
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
        if let Some(reason) = unfit(clock.now(), reader.state())
            && !matches!(reason, StopReason::StaleState { .. })
        {
            return Err(BridgeError::NotReady {
                robot: profile.robot.clone(),
                reason,
            });
        }
        if options.calibrate {
            for limb in &driven {
                calibrate(&mut *transport, &mut reader, profile, *limb, clock)?;
            }
        }
        let shared = Arc::new(Mutex::new(Driving {
            watchdog: Watchdog::new(profile.clone(), &driven, options.speed),
            state: reader.state().clone(),
            target: RobotTarget::default(),
            set_at: Duration::ZERO,
            waiting: Vec::new(),
        }));
        let of_thread = shared.clone();
        let of_robot = profile.clone();
        let thread = Builder::new().name("robot's watchdog".into());
        let thread =
            thread.spawn(move || watch(&mut *transport, reader, &of_robot, &of_thread, clock));
        Ok(Self {
            profile: profile.clone(),
            driven,
            allow_moves: options.allow_moves,
            clock,
            shared,
            guard: None,
            thread: Some(thread.map_err(BridgeError::Thread)?),
        })
    }

    /// Gives somebody a say in what the robot is sent.
    pub fn set_guard(&mut self, guard: impl Guard + 'static) {
        self.guard = Some(Box::new(guard));
    }

    /// Begins to drive the robot, which stays where it is until there is a target. From now on targets must be set again and again.
    ///
    /// # Errors
    /// It cannot be driven now, or was stopped.
    pub fn arm(&mut self) -> Result<(), BridgeError> {
        let now = self.clock.now();
        let mut driving = lock(&self.shared);
        let Driving {
            watchdog,
            state,
            waiting,
            ..
        } = &mut *driving;
        let armed = watchdog.arm(now, state);
        let orders = armed.map_err(|reason| BridgeError::NotReady {
            robot: self.profile.robot.clone(),
            reason,
        })?;
        waiting.extend(orders);
        Ok(())
    }

    /// Says what the robot is to do from now on, for [`OLDEST_TARGET`](crate::OLDEST_TARGET) at most.
    ///
    /// # Errors
    /// The robot cannot do it, the guard vetoes it (then the joints rest), or the robot is not driven (any more).
    pub fn aim(&mut self, target: RobotTarget) -> Result<(), TargetError> {
        let state = {
            let driving = lock(&self.shared);
            let is_over = self.thread.as_ref().is_none_or(JoinHandle::is_finished);
            match driving.watchdog.state() {
                WatchdogState::Armed if is_over => {
                    return Err(TargetError::NotDriven("its watchdog has ended".into()));
                }
                WatchdogState::Armed => {}
                WatchdogState::Watching => {
                    return Err(TargetError::NotDriven("it is not armed".into()));
                }
                WatchdogState::Ramping(reason) | WatchdogState::Held(reason) => {
                    return Err(TargetError::NotDriven(reason.to_string()));
                }
            }
            driving.state.clone()
        };
        target.check(&self.profile, &self.driven, &state, self.allow_moves)?;
        // Without the lock: the watchdog waits for nobody.
        let veto = self
            .guard
            .as_mut()
            .and_then(|guard| guard.veto(&state, &target));
        let mut driving = lock(&self.shared);
        driving.target = match veto {
            Some(_) => RobotTarget::default(),
            None => target,
        };
        driving.set_at = self.clock.now();
        veto.map_or(Ok(()), |why| Err(TargetError::Vetoed(why)))
    }

    /// The robot's state as of its last messages.
    pub fn state(&self) -> RobotState {
        lock(&self.shared).state.clone()
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
        let driving = lock(&self.shared);
        driving.state.age(self.clock.now()).unwrap_or(Duration::MAX)
    }

    /// What the watchdog does.
    pub fn watchdog(&self) -> WatchdogState {
        lock(&self.shared).watchdog.state().clone()
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
        lock(&self.shared)
            .watchdog
            .stop(StopReason::Asked, self.clock.now());
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

fn lock(shared: &Mutex<Driving>) -> MutexGuard<'_, Driving> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The places of the limbs that are driven.
fn driven(profile: &BridgeProfile, options: &BridgeOptions) -> Result<Vec<usize>, BridgeError> {
    if options.limbs.is_empty() {
        return Ok((0..profile.limbs.len()).collect());
    }
    let places = options.limbs.iter().map(|name| {
        profile.limb(name).ok_or_else(|| BridgeError::NoLimb {
            robot: profile.robot.clone(),
            limb: name.clone(),
        })
    });
    let mut places: Vec<_> = places.collect::<Result<_, _>>()?;
    places.sort_unstable();
    places.dedup();
    Ok(places)
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

/// The watchdog's thread: reads until the next look is due or the program has set a target, looks, and sends.
fn watch(
    transport: &mut dyn Transport,
    mut reader: StateReader,
    profile: &BridgeProfile,
    shared: &Mutex<Driving>,
    clock: WallClock,
) {
    let mut due = clock.now();
    let mut answered = Duration::ZERO;
    loop {
        // A look that was missed is not made up for.
        due = (due + PERIOD).max(clock.now() + PERIOD / 10);
        let read = loop {
            let slice = clock.until(due).min(ATTENTION);
            let read = read_until(transport, &mut reader, clock, slice, |_| false);
            let mut driving = lock(shared);
            if driving.state.joints_at != reader.state().joints_at {
                driving.state.clone_from(reader.state());
            }
            if read.is_err() || driving.set_at > answered || clock.until(due).is_zero() {
                answered = driving.set_at;
                break read;
            }
        };
        let now = clock.now();
        let (orders, is_done) = {
            let mut driving = lock(shared);
            driving.state = reader.state().clone();
            driving.state.nonsense += transport.nonsense();
            let Driving {
                watchdog,
                state,
                target,
                set_at,
                waiting,
            } = &mut *driving;
            if let Err(error) = read {
                watchdog.stop(StopReason::Disconnected(error.to_string()), now);
            }
            let mut orders = mem::take(waiting);
            orders.extend(watchdog.tick(now, state, target, *set_at));
            (orders, watchdog.is_done(now))
        };
        let sent = orders.iter().filter_map(|order| message(profile, order));
        let sent: Result<(), _> = sent
            .into_iter()
            .try_for_each(|(topic, message)| transport.publish(&topic, &message));
        if let Err(error) = sent {
            lock(shared)
                .watchdog
                .stop(StopReason::Disconnected(error.to_string()), clock.now());
        }
        if is_done {
            return;
        }
    }
}
