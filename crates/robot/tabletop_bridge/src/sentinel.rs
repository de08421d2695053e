//! A process of its own that brings a robot to rest when the one that drives it is killed.
//!
//! A robot without a time limit for commands keeps its last speed if nothing more comes. The driving process cannot help that when it is killed (`kill -9`);
//! so a second one, with a connection of its own, waits for the end of a pipe.

use std::{
    io::{self, BufRead, Write as _},
    process::{Child, ChildStdin, Command, Stdio},
    thread::sleep,
};

use crate::{
    address::{Address, RobotWay},
    clock::WallClock,
    error::BridgeError,
    orders::{RobotOrder, message, topics},
    profile::BridgeProfile,
    ros1::Ros1,
    rosbridge::Rosbridge,
    tolerances::HOLD,
    transport::Transport,
    watchdog::PERIOD,
};

/// The words by which the driving process says that it drives, and that the robot rests; and the one by which the sentinel says that it is ready.
const DRIVES: &str = "drives";
const RESTS: &str = "rests";
const READY: &str = "ready";

/// A sentinel that is running.
#[derive(Debug)]
pub struct Sentinel {
    process: Child,
    words: Option<ChildStdin>,
}

impl Sentinel {
    /// Starts a sentinel: a command that calls [`keep_watch`], and waits until it is ready.
    ///
    /// # Errors
    /// It does not start, or cannot reach the robot.
    pub fn start(mut command: Command) -> Result<Self, BridgeError> {
        set_apart(&mut command);
        command.stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut process = command.spawn().map_err(BridgeError::Sentinel)?;
        let words = process.stdin.take();
        let mut answer = String::new();
        if let Some(output) = process.stdout.take() {
            let read = io::BufReader::new(output).read_line(&mut answer);
            read.map_err(BridgeError::Sentinel)?;
        }
        match answer.trim() == READY {
            true => Ok(Self { process, words }),
            false => Err(BridgeError::Sentinel(io::ErrorKind::BrokenPipe.into())),
        }
    }

    /// Says that the robot is driven from now on.
    ///
    /// # Errors
    /// The sentinel has ended.
    pub(crate) fn arm(&mut self) -> Result<(), BridgeError> {
        self.say(DRIVES).map_err(BridgeError::Sentinel)
    }

    fn say(&mut self, word: &str) -> io::Result<()> {
        let words = self.words.as_mut().ok_or(io::ErrorKind::BrokenPipe)?;
        writeln!(words, "{word}")?;
        words.flush()
    }
}

impl Drop for Sentinel {
    /// The robot rests, or its watchdog has done what it could.
    fn drop(&mut self) {
        drop(self.say(RESTS));
        drop(self.words.take());
        drop(self.process.wait());
    }
}

/// What a terminal sends to the driving process, such as Ctrl-C, does not end it.
#[cfg(unix)]
fn set_apart(command: &mut Command) {
    std::os::unix::process::CommandExt::process_group(command, 0);
}

/// There is no such way here.
#[cfg(not(unix))]
fn set_apart(_: &mut Command) {}

/// Waits until a driving process ends, of which this is the other end of a pipe, and brings the limbs that it drove to rest. All limbs, if none is named.
///
/// # Errors
/// The robot cannot be reached, or has no such limb.
pub fn keep_watch(
    address: &Address,
    profile: &BridgeProfile,
    limbs: &[String],
    words: impl BufRead,
    ready: impl FnOnce() -> io::Result<()>,
) -> Result<(), BridgeError> {
    let clock = WallClock::start();
    let (host, port) = (&address.host, address.port);
    let mut transport: Box<dyn Transport> = match address.way {
        RobotWay::Ros => Box::new(Ros1::connect(host, port, clock)?),
        RobotWay::Rosbridge => Box::new(Rosbridge::connect(host, port, clock)?),
    };
    let driven = profile.places(limbs);
    let driven = driven.map_err(|limb| BridgeError::no_limb(profile, limb))?;
    for (topic, is_latched) in topics(profile, &driven) {
        transport.advertise(&topic, is_latched)?;
    }
    ready().map_err(BridgeError::Sentinel)?;
    let mut is_driven = false;
    for word in words.lines().map_while(Result::ok) {
        is_driven = word.trim() == DRIVES;
    }
    let begun = clock.now();
    while is_driven && clock.now() - begun < HOLD {
        for &limb in &driven {
            let speeds = vec![0.0; profile.limbs[limb].joints.len()];
            let order = RobotOrder::Velocities { limb, speeds };
            if let Some((topic, message)) = message(profile, &order) {
                transport.publish(&topic, &message)?;
            }
        }
        sleep(PERIOD);
    }
    Ok(())
}
