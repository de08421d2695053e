//! The end of this process by a signal or a panic: robots that it drives are brought to rest first.

use std::{
    panic,
    process::exit,
    sync::{
        Arc, Mutex, Once, PoisonError, TryLockError, Weak,
        atomic::{AtomicBool, Ordering},
    },
    thread::sleep,
    time::{Duration, Instant},
};

use crate::{
    clock::WallClock,
    pilot::Pilot,
    tolerances::{HOLD, RAMP},
    watchdog::StopReason,
};

/// A robot that is driven by this process.
struct Driven {
    pilot: Weak<Mutex<Pilot>>,
    clock: WallClock,
}

static DRIVEN: Mutex<Vec<Driven>> = Mutex::new(Vec::new());
static IS_INTERRUPTED: AtomicBool = AtomicBool::new(false);
static WATCH: Once = Once::new();

/// How long the program may take to end by itself, so that recordings are whole, once its robots rest.
const GRACE: Duration = Duration::from_secs(3);

/// The longest wait for a pilot that somebody else has at the moment, and from look to look.
const LONGEST_WAIT: Duration = Duration::from_millis(100);
const LOOK: Duration = Duration::from_millis(5);

/// The exit code of a program that was ended by Ctrl-C.
#[cfg(not(unix))]
const INTERRUPTED: i32 = 130;

/// From now on a signal (Ctrl-C, SIGTERM, SIGHUP as of a closed terminal) or a panic brings all robots that this process drives to rest. After a signal
/// the process may end by itself; after three seconds it is ended. As long as no robot is driven, signals do what they always do.
///
/// Call it before there are other threads: each of them could get a signal, too.
pub fn stop_robots_at_the_end() {
    WATCH.call_once(|| {
        signals::watch();
        let inner = panic::take_hook();
        panic::set_hook(Box::new(move |panic| {
            inner(panic);
            if stop_all("the program panicked") {
                wait_until_they_rest();
            }
        }));
    });
}

/// Brings all robots to rest, and then the process to its end. Returns if no robot is driven.
fn end_by(signal: &str, code: i32) {
    if !stop_all(&format!("{signal} ended the program")) {
        return;
    }
    IS_INTERRUPTED.store(true, Ordering::SeqCst);
    wait_until_they_rest();
    sleep(GRACE);
    exit(code);
}

#[cfg(unix)]
mod signals {
    use std::thread::Builder;

    use nix::sys::signal::{SigSet, Signal, raise};

    /// A thread waits for the signals, which all others leave alone.
    pub(super) fn watch() {
        let mut signals = SigSet::empty();
        for signal in [Signal::SIGINT, Signal::SIGTERM, Signal::SIGHUP] {
            signals.add(signal);
        }
        let thread = Builder::new().name("waits for signals".into());
        let wait = move || {
            loop {
                let Ok(signal) = signals.wait() else {
                    return;
                };
                super::end_by(name(signal), 128 + signal as i32);
                // What it does without us.
                let mut own = SigSet::empty();
                own.add(signal);
                let _ = own.thread_unblock().and_then(|()| raise(signal));
                let _ = own.thread_block();
            }
        };
        // What waits for a signal must block it, and a thread inherits that. Without the thread, signals must not be kept back.
        if signals.thread_block().is_ok() && thread.spawn(wait).is_err() {
            let _ = signals.thread_unblock();
        }
    }

    fn name(signal: Signal) -> &'static str {
        match signal == Signal::SIGINT {
            true => "Ctrl-C",
            false => signal.as_str(),
        }
    }
}

#[cfg(not(unix))]
mod signals {
    /// Somebody else's handler stays: then dropping the robots must do.
    pub(super) fn watch() {
        drop(ctrlc::set_handler(|| {
            super::end_by("Ctrl-C", super::INTERRUPTED);
            std::process::exit(super::INTERRUPTED);
        }));
    }
}

/// True once a signal has asked the process to end.
pub fn is_interrupted() -> bool {
    IS_INTERRUPTED.load(Ordering::SeqCst)
}

/// A robot is driven from now on, as long as its pilot lives.
pub(crate) fn register(pilot: &Arc<Mutex<Pilot>>, clock: WallClock) {
    let mut driven = DRIVEN.lock().unwrap_or_else(PoisonError::into_inner);
    driven.retain(|it| it.pilot.strong_count() > 0);
    let pilot = Arc::downgrade(pilot);
    driven.push(Driven { pilot, clock });
}

/// Stops all robots. True if there are any.
fn stop_all(reason: &str) -> bool {
    for_each(|pilot, now| pilot.stop(StopReason::Interrupted(reason.into()), now)) > 0
}

fn wait_until_they_rest() {
    let begun = Instant::now();
    while begun.elapsed() < RAMP + HOLD + LONGEST_WAIT {
        let mut all_rest = true;
        for_each(|pilot, now| all_rest &= pilot.is_done(now));
        if all_rest {
            return;
        }
        sleep(LOOK);
    }
}

/// Does something with each pilot, but one that this thread may have itself, and returns the number of them.
fn for_each(mut act: impl FnMut(&mut Pilot, Duration)) -> usize {
    let driven = DRIVEN.lock().unwrap_or_else(PoisonError::into_inner);
    let alive = driven
        .iter()
        .filter_map(|it| Some((it.pilot.upgrade()?, it.clock)));
    let mut count = 0;
    for (pilot, clock) in alive {
        let begun = Instant::now();
        loop {
            match pilot.try_lock() {
                Ok(mut pilot) => act(&mut pilot, clock.now()),
                Err(TryLockError::Poisoned(pilot)) => act(&mut pilot.into_inner(), clock.now()),
                Err(TryLockError::WouldBlock) if begun.elapsed() < LONGEST_WAIT => {
                    sleep(Duration::from_micros(100));
                    continue;
                }
                Err(TryLockError::WouldBlock) => {}
            }
            break;
        }
        count += 1;
    }
    count
}
