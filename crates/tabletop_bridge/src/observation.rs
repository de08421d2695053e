//! The first look at a robot.

use std::time::Duration;

use crate::{
    clock::WallClock,
    error::BridgeError,
    profile::BridgeProfile,
    state::StateReader,
    transport::{Listener, TransportError},
};

/// How long a robot is waited for: its state comes at least ten times a second.
pub(crate) const PATIENCE: Duration = Duration::from_secs(2);

/// Subscribes to what a robot says, and waits until it has said where all its joints are, and whether it is on.
pub(crate) fn observe<L: Listener + ?Sized>(
    listener: &mut L,
    profile: &BridgeProfile,
    clock: WallClock,
) -> Result<StateReader, BridgeError> {
    let mut reader = StateReader::new(profile);
    for topic in reader.topics() {
        listener.subscribe(&topic)?;
    }
    let is_known = |reader: &StateReader| {
        reader.state().joints_at.is_some() && reader.state().health.is_some()
    };
    read_until(listener, &mut reader, clock, PATIENCE, is_known)?;
    if reader.state().joints_at.is_none() {
        let missing = reader.missing().into_iter().map(str::to_owned);
        return Err(BridgeError::NoJoints {
            robot: profile.robot.clone(),
            joints: missing.collect(),
            topic: profile.joint_states.clone(),
            patience: PATIENCE,
        });
    }
    if reader.state().health.is_none() {
        return Err(BridgeError::NoHealth {
            robot: profile.robot.clone(),
            topic: profile.health.topic().to_owned(),
            patience: PATIENCE,
        });
    }
    Ok(reader)
}

/// Reads messages until a condition holds, or a time has passed.
pub(crate) fn read_until<L: Listener + ?Sized>(
    listener: &mut L,
    reader: &mut StateReader,
    clock: WallClock,
    patience: Duration,
    holds: impl Fn(&StateReader) -> bool,
) -> Result<(), TransportError> {
    let deadline = clock.now() + patience;
    while !holds(reader) {
        match listener.poll(deadline)? {
            Some(received) => reader.take(&received),
            None => return Ok(()),
        }
    }
    Ok(())
}
