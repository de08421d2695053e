//! The first look at a robot.

use std::time::Duration;

use crate::{
    clock::WallClock,
    error::{BridgeError, TopicFault},
    profile::BridgeProfile,
    state::StateReader,
    transport::{Listener, TopicType, TransportError},
};

/// How long a robot is waited for: its state comes at least ten times a second.
pub(crate) const PATIENCE: Duration = Duration::from_secs(2);

/// How long the type of a topic is waited for.
const TYPE_PATIENCE: Duration = Duration::from_secs(1);

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
    let topics = reader.topics();
    let what = if reader.state().joints_at.is_none() {
        Some((
            &topics[0],
            format!("where {} are", reader.missing().join(", ")),
        ))
    } else if reader.state().health.is_none() {
        Some((&topics[1], "whether it is on".to_owned()))
    } else {
        None
    };
    let Some((topic, what)) = what else {
        return Ok(reader);
    };
    Err(BridgeError::Silent {
        robot: profile.robot.clone(),
        what,
        topic: topic.topic.clone(),
        fault: Box::new(fault_of(listener, &reader, topic)),
        patience: PATIENCE,
    })
}

/// What is the matter with a topic that has not said what it should.
fn fault_of<L: Listener + ?Sized>(
    listener: &mut L,
    reader: &StateReader,
    topic: &TopicType,
) -> TopicFault {
    let strangers: Vec<_> = reader.strangers().map(str::to_owned).collect();
    if topic.topic == reader.topics()[0].topic && !strangers.is_empty() {
        return TopicFault::OtherJoints(strangers);
    }
    match listener.type_of(&topic.topic, TYPE_PATIENCE) {
        Ok(None) => TopicFault::Unpublished,
        Ok(Some(found)) if found != topic.message => TopicFault::OtherType {
            found,
            expected: topic.message.clone(),
        },
        // Who does not say of which type it is may be of the right one.
        Ok(Some(_)) | Err(_) => match reader.state().nonsense + listener.nonsense() {
            0 => TopicFault::Silent,
            _ => TopicFault::Nonsense,
        },
    }
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
