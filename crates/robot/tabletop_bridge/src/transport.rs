//! What carries messages between this program and a robot.
//!
//! A message is JSON as rosbridge has it, whatever carries it: an object of the message type's fields, `uint8[]` as base64, numbers that are not finite
//! as null, and a time as an object of its seconds and nanoseconds.

use std::{io, time::Duration};

use serde_json::Value as Json;
use thiserror::Error;

/// A message of a topic that was subscribed to.
#[derive(Clone, Debug, PartialEq)]
pub struct Received {
    /// The topic.
    pub topic: String,
    /// The message.
    pub message: Json,
    /// When it arrived here, on the transport's clock.
    pub at: Duration,
}

/// A topic and the type of its messages, in the names of the robot's ROS: `std_msgs/Bool`, or `std_msgs/msg/Bool` in ROS 2.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TopicType {
    /// The topic, which begins with a slash.
    pub topic: String,
    /// The type.
    pub message: String,
}

/// Reads from a robot. Nothing that it does can move one.
pub trait Listener: Send {
    /// Asks for the messages of a topic. One message is waiting at most, so that none is old.
    ///
    /// # Errors
    /// The connection is lost, or the type is unknown.
    fn subscribe(&mut self, topic: &TopicType) -> Result<(), TransportError>;

    /// A parameter of the robot; none if it has no such parameter.
    ///
    /// # Errors
    /// The connection is lost, or there is no answer within the time.
    fn parameter(&mut self, name: &str, patience: Duration)
    -> Result<Option<Json>, TransportError>;

    /// The next message, or none if none came until the deadline.
    ///
    /// # Errors
    /// The connection is lost.
    fn poll(&mut self, deadline: Duration) -> Result<Option<Received>, TransportError>;

    /// The type of the messages that are published on a topic, as the robot names it; none if nobody publishes there.
    ///
    /// # Errors
    /// The connection is lost, or there is no answer within the time.
    fn type_of(
        &mut self,
        topic: &str,
        patience: Duration,
    ) -> Result<Option<String>, TransportError>;

    /// How many messages could not be understood. They are passed over.
    fn nonsense(&self) -> u64;
}

/// Reads from a robot and writes to it.
pub trait Transport: Listener {
    /// Announces that messages will be published on a topic. The last one of a latched topic is sent to those who come later.
    ///
    /// # Errors
    /// The connection is lost, or the type is unknown.
    fn advertise(&mut self, topic: &TopicType, latched: bool) -> Result<(), TransportError>;

    /// Sends a message. That it was sent does not mean that it was understood: rosbridge drops what it does not understand without a word.
    ///
    /// # Errors
    /// The connection is lost, the topic was not advertised, or the message is not of its type.
    fn publish(&mut self, topic: &str, message: &Json) -> Result<(), TransportError>;

    /// How many listen to what is published on a topic; none if that cannot be known.
    fn listeners(&self, topic: &str) -> Option<usize>;

    /// Calls a service and returns its answer.
    ///
    /// # Errors
    /// The connection is lost, the service refuses, or there is no answer within the time.
    fn call(&mut self, service: &ServiceCall, patience: Duration) -> Result<Json, TransportError>;
}

/// A call of a service.
#[derive(Clone, Debug, PartialEq)]
pub struct ServiceCall {
    /// The service, which begins with a slash.
    pub service: String,
    /// Its type, such as `baxter_core_msgs/OpenCamera`.
    pub service_type: String,
    /// The request.
    pub request: Json,
}

/// What goes wrong between this program and a robot.
#[derive(Debug, Error)]
pub enum TransportError {
    /// There is nobody at the address.
    #[error("{address} cannot be reached: {source}")]
    Unreachable {
        /// Host and port.
        address: String,
        /// The system's reason.
        source: io::Error,
    },
    /// What answers does not speak the protocol.
    #[error("what answers at {address} is no {expected}: {fault}")]
    Foreign {
        /// Host and port.
        address: String,
        /// What was expected.
        expected: &'static str,
        /// What it did instead.
        fault: String,
    },
    /// The connection has ended.
    #[error("the connection is lost: {0}")]
    Lost(String),
    /// What is written is no longer taken.
    #[error("the connection is stuck: {0} no longer takes messages")]
    Stuck(String),
    /// No answer came in time.
    #[error("no answer from {asked} within {} s", .patience.as_secs_f64())]
    NoReply {
        /// What was asked.
        asked: String,
        /// How long an answer was waited for.
        patience: Duration,
    },
    /// The other side says no.
    #[error("{asked} refuses: {reason}")]
    Declined {
        /// What was asked.
        asked: String,
        /// Its reason.
        reason: String,
    },
    /// The message type is not one that this program knows, or the message does not fit it.
    #[error("{topic}: {fault}")]
    Unfit {
        /// The topic or service.
        topic: String,
        /// What does not fit.
        fault: String,
    },
}
