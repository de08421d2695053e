//! rosbridge, protocol 2: JSON over a WebSocket. The same for ROS 1, ROS 2 and simulators.

mod bare_numbers;
mod fragments;

use std::{
    collections::{BTreeSet, VecDeque},
    io::{self, Read, Write},
    net::TcpStream,
    time::Duration,
};

use bare_numbers::read_json;
use fragments::Fragments;
use serde_json::{Value as Json, json};
use tungstenite::{
    Error, HandshakeError, Message, WebSocket, client::client_with_config,
    protocol::WebSocketConfig,
};

use crate::{
    address::authority,
    clock::WallClock,
    connection::{connect_within, is_timeout},
    transport::{Listener, Received, ServiceCall, TopicType, Transport, TransportError},
};

/// How long a connection may take, and its handshake.
const PATIENCE: Duration = Duration::from_secs(2);

/// How long a message may wait to be written before the connection counts as stuck.
const WRITE_PATIENCE: Duration = Duration::from_millis(50);

/// The most bytes of a message: a picture of 1280x800 in base64 has 5.5 MB.
const MOST_BYTES: usize = 8 << 20;

/// The shortest wait for bytes: a system's clock knows no shorter ones.
const SHORTEST_WAIT: Duration = Duration::from_millis(1);

/// The most messages that are kept while an answer is waited for.
const MOST_WAITING: usize = 1000;

/// A connection to a rosbridge server.
pub struct Rosbridge {
    socket: WebSocket<DeadlineStream>,
    address: String,
    clock: WallClock,
    fragments: Fragments,
    advertised: BTreeSet<String>,
    /// Messages that came while an answer was waited for.
    waiting: VecDeque<Received>,
    calls: u64,
    nonsense: u64,
}

/// What a server has sent.
enum Incoming {
    Message(Received),
    Answer(Json),
    Other,
}

impl Rosbridge {
    /// Connects to a server.
    ///
    /// # Errors
    /// There is none.
    pub fn connect(host: &str, port: u16, clock: WallClock) -> Result<Self, TransportError> {
        let address = authority(host, port);
        let stream = connect_within(host, port, PATIENCE)?;
        let unreachable = |source| TransportError::Unreachable {
            address: address.clone(),
            source,
        };
        stream
            .set_write_timeout(Some(WRITE_PATIENCE))
            .map_err(unreachable)?;
        let config = WebSocketConfig::default()
            .max_message_size(Some(MOST_BYTES))
            .max_frame_size(Some(MOST_BYTES))
            .max_write_buffer_size(MOST_BYTES);
        let stream = DeadlineStream {
            stream,
            clock,
            deadline: clock.now() + PATIENCE,
        };
        let url = format!("ws://{address}/");
        let (socket, _) =
            client_with_config(url, stream, Some(config)).map_err(|error| match error {
                HandshakeError::Interrupted(_) => TransportError::NoReply {
                    asked: address.clone(),
                    patience: PATIENCE,
                },
                HandshakeError::Failure(error) => TransportError::Foreign {
                    address: address.clone(),
                    expected: "rosbridge server",
                    fault: error.to_string(),
                },
            })?;
        Ok(Self {
            socket,
            address,
            clock,
            fragments: Fragments::default(),
            advertised: BTreeSet::new(),
            waiting: VecDeque::new(),
            calls: 0,
            nonsense: 0,
        })
    }

    /// Asks for the messages of a topic, no more often than once in a time. Pictures are asked for on a connection of their own, since a server sends
    /// everything of a connection in turn.
    ///
    /// # Errors
    /// As [`Listener::subscribe`].
    pub fn subscribe_at_most_every(
        &mut self,
        topic: &TopicType,
        period: Duration,
    ) -> Result<(), TransportError> {
        self.send(&json!({
            "op": "subscribe",
            "topic": topic.topic,
            "type": topic.message,
            "queue_length": 1,
            "throttle_rate": u64::try_from(period.as_millis()).unwrap_or(u64::MAX),
        }))
    }

    fn send(&mut self, message: &Json) -> Result<(), TransportError> {
        let sent = self.socket.send(Message::text(message.to_string()));
        sent.map_err(|error| match is_stuck(&error) {
            true => TransportError::Stuck(self.address.clone()),
            false => lost(&error),
        })
    }

    /// The next thing that the server sends until the deadline.
    fn read(&mut self, deadline: Duration) -> Result<Option<Incoming>, TransportError> {
        self.socket.get_mut().deadline = deadline;
        match self.socket.read() {
            Ok(Message::Text(text)) => Ok(Some(self.understand(text.as_str()))),
            Ok(Message::Close(_)) => Err(TransportError::Lost("the server has closed it".into())),
            Ok(Message::Ping(_) | Message::Pong(_)) => Ok(Some(Incoming::Other)),
            Ok(Message::Binary(_) | Message::Frame(_)) => {
                self.nonsense += 1;
                Ok(Some(Incoming::Other))
            }
            Err(Error::Io(error)) if is_timeout(&error) => Ok(None),
            Err(error) => Err(lost(&error)),
        }
    }

    fn understand(&mut self, text: &str) -> Incoming {
        let understood = match read_json(text) {
            Some(json) if operation(&json) == Some("fragment") => match self.fragments.add(&json) {
                Ok(Some(whole)) => read_json(&whole).and_then(|json| self.sort(json)),
                Ok(None) => Some(Incoming::Other),
                Err(()) => None,
            },
            Some(json) => self.sort(json),
            None => None,
        };
        understood.unwrap_or_else(|| {
            self.nonsense += 1;
            Incoming::Other
        })
    }

    /// What a whole message is; none if that makes no sense.
    fn sort(&self, mut json: Json) -> Option<Incoming> {
        match operation(&json)? {
            "publish" => {
                let message = json.get_mut("msg")?.take();
                Some(Incoming::Message(Received {
                    topic: json.get("topic")?.as_str()?.to_owned(),
                    message,
                    at: self.clock.now(),
                }))
            }
            "service_response" => Some(Incoming::Answer(json)),
            "status" => Some(Incoming::Other),
            _ => None,
        }
    }
}

fn operation(json: &Json) -> Option<&str> {
    json.get("op")?.as_str()
}

/// A stream of which nothing is read after a deadline, even if bytes come one by one.
#[derive(Debug)]
struct DeadlineStream {
    stream: TcpStream,
    clock: WallClock,
    deadline: Duration,
}

impl Read for DeadlineStream {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let wait = self.clock.until(self.deadline);
        if wait.is_zero() {
            return Err(io::ErrorKind::WouldBlock.into());
        }
        self.stream
            .set_read_timeout(Some(wait.max(SHORTEST_WAIT)))?;
        self.stream.read(bytes)
    }
}

impl Write for DeadlineStream {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.stream.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.stream.flush()
    }
}

impl Listener for Rosbridge {
    fn subscribe(&mut self, topic: &TopicType) -> Result<(), TransportError> {
        self.subscribe_at_most_every(topic, Duration::ZERO)
    }

    fn parameter(
        &mut self,
        name: &str,
        patience: Duration,
    ) -> Result<Option<Json>, TransportError> {
        let call = ServiceCall {
            service: "/rosapi/get_param".into(),
            service_type: "rosapi/GetParam".into(),
            request: json!({"name": name}),
        };
        let answer = self.call(&call, patience)?;
        let value = answer
            .get("value")
            .and_then(Json::as_str)
            .unwrap_or_default();
        let value = serde_json::from_str(value).unwrap_or(Json::Null);
        Ok((!value.is_null()).then_some(value))
    }

    fn type_of(
        &mut self,
        topic: &str,
        patience: Duration,
    ) -> Result<Option<String>, TransportError> {
        let call = ServiceCall {
            service: "/rosapi/topic_type".into(),
            service_type: "rosapi/TopicType".into(),
            request: json!({"topic": topic}),
        };
        let answer = self.call(&call, patience)?;
        let name = answer.get("type").and_then(Json::as_str);
        let name = name.ok_or_else(|| TransportError::Declined {
            asked: call.service,
            reason: answer.to_string(),
        })?;
        Ok((!name.is_empty()).then(|| name.to_owned()))
    }

    fn poll(&mut self, deadline: Duration) -> Result<Option<Received>, TransportError> {
        if let Some(received) = self.waiting.pop_front() {
            return Ok(Some(received));
        }
        loop {
            match self.read(deadline)? {
                Some(Incoming::Message(received)) => return Ok(Some(received)),
                Some(Incoming::Answer(_) | Incoming::Other) => {}
                None if self.clock.until(deadline).is_zero() => return Ok(None),
                None => {}
            }
        }
    }

    fn nonsense(&self) -> u64 {
        self.nonsense
    }
}

impl Transport for Rosbridge {
    fn advertise(&mut self, topic: &TopicType, latched: bool) -> Result<(), TransportError> {
        self.send(&json!({
            "op": "advertise",
            "topic": topic.topic,
            "type": topic.message,
            "latch": latched,
            "queue_size": 1,
        }))?;
        self.advertised.insert(topic.topic.clone());
        Ok(())
    }

    fn publish(&mut self, topic: &str, message: &Json) -> Result<(), TransportError> {
        if !self.advertised.contains(topic) {
            return Err(TransportError::Unfit {
                topic: topic.to_owned(),
                fault: "it was not advertised".into(),
            });
        }
        self.send(&json!({"op": "publish", "topic": topic, "msg": message}))
    }

    /// A server does not say.
    fn listeners(&self, _: &str) -> Option<usize> {
        None
    }

    fn call(&mut self, call: &ServiceCall, patience: Duration) -> Result<Json, TransportError> {
        self.calls += 1;
        let id = format!("call:{}", self.calls);
        self.send(&json!({
            "op": "call_service",
            "id": id,
            "service": call.service,
            "type": call.service_type,
            "args": call.request,
        }))?;
        let deadline = self.clock.now() + patience;
        while !self.clock.until(deadline).is_zero() {
            match self.read(deadline)? {
                Some(Incoming::Message(received)) => {
                    self.waiting.push_back(received);
                    if self.waiting.len() > MOST_WAITING {
                        self.waiting.pop_front();
                    }
                }
                Some(Incoming::Answer(answer))
                    if answer.get("id").and_then(Json::as_str) == Some(&id) =>
                {
                    let values = answer.get("values").cloned().unwrap_or(Json::Null);
                    return match answer.get("result").and_then(Json::as_bool) {
                        Some(false) => Err(TransportError::Declined {
                            asked: call.service.clone(),
                            reason: values
                                .as_str()
                                .map_or_else(|| values.to_string(), str::to_owned),
                        }),
                        Some(true) | None => Ok(values),
                    };
                }
                Some(Incoming::Answer(_) | Incoming::Other) | None => {}
            }
        }
        Err(TransportError::NoReply {
            asked: call.service.clone(),
            patience,
        })
    }
}

impl Drop for Rosbridge {
    /// Says goodbye, as far as that is still heard.
    fn drop(&mut self) {
        drop(self.socket.close(None));
        drop(self.socket.flush());
    }
}

fn is_stuck(error: &Error) -> bool {
    matches!(error, Error::WriteBufferFull(_))
        || matches!(error, Error::Io(error) if is_timeout(error))
}

fn lost(error: &Error) -> TransportError {
    TransportError::Lost(error.to_string())
}
