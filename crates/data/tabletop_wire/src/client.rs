//! The client: asks a served policy for actions.

use std::time::{Duration, Instant};

use tungstenite::{
    Bytes, Error, HandshakeError, Message, WebSocket,
    client::client_with_config,
    protocol::{CloseFrame, WebSocketConfig},
};

use crate::{
    address::PolicyAddress,
    decode::decode,
    encode::encode,
    error::WireError,
    format_error::{FormatError, shortened},
    stream::{MOST_BYTES, PatientStream, is_timeout},
    value::{WireMap, WireValue},
};

/// How long a server is waited for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PolicyPatience {
    /// Until it is connected and has sent its metadata.
    pub connecting: Duration,
    /// Until it has answered. The first answer of a network that is compiled for it may take a minute.
    pub answering: Duration,
}

impl Default for PolicyPatience {
    fn default() -> Self {
        Self {
            connecting: Duration::from_secs(10),
            answering: Duration::from_secs(120),
        }
    }
}

/// A connection to a served policy.
#[derive(Debug)]
pub struct PolicyClient {
    socket: WebSocket<PatientStream>,
    address: PolicyAddress,
    patience: PolicyPatience,
    metadata: WireMap,
}

impl PolicyClient {
    /// Connects to a server, with the usual patience.
    ///
    /// # Errors
    /// As [`connect_within`](Self::connect_within).
    pub fn connect(address: &PolicyAddress) -> Result<Self, WireError> {
        Self::connect_within(address, PolicyPatience::default())
    }

    /// Connects to a server, and takes its metadata.
    ///
    /// # Errors
    /// There is none, it speaks another protocol, or it does not come to that in time.
    pub fn connect_within(
        address: &PolicyAddress,
        patience: PolicyPatience,
    ) -> Result<Self, WireError> {
        let deadline = Instant::now() + patience.connecting;
        let stream = PatientStream::connect(&address.host, address.port, deadline);
        let stream = stream.map_err(|source| WireError::Unreachable {
            address: address.clone(),
            source,
        })?;
        let config = WebSocketConfig::default()
            .max_message_size(Some(MOST_BYTES))
            .max_frame_size(Some(MOST_BYTES));
        let url = format!("{address}/");
        let shaken = client_with_config(url, stream, Some(config));
        let (socket, _) = shaken.map_err(|error| match error {
            HandshakeError::Interrupted(_) => WireError::Silent {
                address: address.clone(),
                deed: "accepted the connection",
                patience: patience.connecting,
            },
            HandshakeError::Failure(error) => WireError::Foreign {
                address: address.clone(),
                fault: error.to_string(),
            },
        })?;
        let mut client = Self {
            socket,
            address: address.clone(),
            patience,
            metadata: WireMap::new(),
        };
        client.metadata = client.frame("sent its metadata", patience.connecting)?;
        Ok(client)
    }

    /// What the server says of itself.
    pub const fn metadata(&self) -> &WireMap {
        &self.metadata
    }

    /// The server's address.
    pub const fn address(&self) -> &PolicyAddress {
        &self.address
    }

    /// The answer to an observation. After an error, the connection is of no more use.
    ///
    /// # Errors
    /// The server refuses the observation, says nonsense, or nothing in time.
    pub fn ask(&mut self, observation: &WireMap) -> Result<WireMap, WireError> {
        let patience = self.patience.answering;
        self.socket.get_mut().deadline = Some(Instant::now() + patience);
        let frame = Message::binary(encode(observation));
        if let Err(error) = self.socket.send(frame) {
            return Err(self.error("taken the observation", patience, error));
        }
        self.frame("answered", patience)
    }

    /// The next frame, within the time that is left.
    fn frame(&mut self, deed: &'static str, patience: Duration) -> Result<WireMap, WireError> {
        loop {
            match self.socket.read() {
                Ok(Message::Binary(bytes)) => return self.map_of(&bytes),
                Ok(Message::Text(text)) => {
                    let mut lines = text.lines().map(str::trim);
                    let last = lines.rfind(|line| !line.is_empty());
                    return Err(WireError::Refused {
                        address: self.address.clone(),
                        reason: shortened(last.unwrap_or("it does not say why")),
                    });
                }
                Ok(Message::Close(frame)) => return Err(self.closed(frame.as_ref())),
                Ok(Message::Ping(_) | Message::Pong(_) | Message::Frame(_)) => {}
                Err(error) => return Err(self.error(deed, patience, error)),
            }
        }
    }

    fn map_of(&self, bytes: &Bytes) -> Result<WireMap, WireError> {
        let map = decode(bytes).and_then(|value| match value {
            WireValue::Map(map) => Ok(map),
            WireValue::Nil
            | WireValue::Boolean(_)
            | WireValue::Integer(_)
            | WireValue::Number(_)
            | WireValue::Text(_)
            | WireValue::Bytes(_)
            | WireValue::List(_)
            | WireValue::Array(_) => {
                let fault = format!("the frame is {}, expected a map", value.kind());
                Err(FormatError::at("", fault))
            }
        });
        map.map_err(|fault| WireError::Nonsense {
            address: self.address.clone(),
            fault,
        })
    }

    fn closed(&self, frame: Option<&CloseFrame>) -> WireError {
        let reason = match frame {
            Some(frame) => format!("{} {}", frame.code, frame.reason),
            None => "it does not say why".into(),
        };
        WireError::Closed {
            address: self.address.clone(),
            reason: shortened(reason.trim()),
        }
    }

    fn error(&self, deed: &'static str, patience: Duration, error: Error) -> WireError {
        let address = self.address.clone();
        match error {
            Error::Io(error) if is_timeout(&error) => WireError::Silent {
                address,
                deed,
                patience,
            },
            Error::Capacity(error) => WireError::Nonsense {
                address,
                fault: FormatError::at("", error.to_string()),
            },
            Error::ConnectionClosed
            | Error::AlreadyClosed
            | Error::Io(_)
            | Error::Tls(_)
            | Error::Protocol(_)
            | Error::WriteBufferFull(_)
            | Error::Utf8(_)
            | Error::AttackAttempt
            | Error::Url(_)
            | Error::Http(_)
            | Error::HttpFormat(_) => WireError::Closed {
                address,
                reason: error.to_string(),
            },
        }
    }
}

impl Drop for PolicyClient {
    /// Says goodbye, as far as that is still heard.
    fn drop(&mut self) {
        self.socket.get_mut().deadline = Some(Instant::now() + Duration::from_millis(50));
        drop(self.socket.close(None));
        drop(self.socket.flush());
    }
}
