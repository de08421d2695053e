//! The server: lets others ask a policy of ours.

use std::{
    io::{self, Read as _, Write as _},
    net::{SocketAddr, TcpListener, TcpStream},
    sync::atomic::{AtomicUsize, Ordering},
    thread,
    time::{Duration, Instant},
};

use tungstenite::{
    Error, Message, WebSocket, accept_with_config,
    protocol::{CloseFrame, WebSocketConfig, frame::coding::CloseCode},
};

use crate::{
    decode::decode,
    encode::encode,
    stream::{MOST_BYTES, PatientStream},
    value::{WireMap, WireValue},
};

/// A policy that can be served. Several clients may ask at a time.
pub trait Served: Sync {
    /// What it says of itself: `observation` (key → shape and dtype), `action`, `rate` and `horizon`.
    fn metadata(&self) -> WireMap;

    /// The answer to an observation, with `actions`.
    ///
    /// # Errors
    /// What is wrong with the observation, by its key. The client is told, and the connection ends.
    fn answer(&self, observation: &WireMap) -> Result<WireMap, String>;
}

/// Most clients at a time; others are turned away.
const MOST_CLIENTS: usize = 64;
/// How long a client may take to greet, and to take an answer.
const PATIENCE: Duration = Duration::from_secs(10);
/// How long the server rests after the system has refused a connection.
const REST: Duration = Duration::from_millis(50);
/// How often in a row the system refuses connections until the server gives up.
const MOST_REFUSALS: u32 = 100;
/// The request that asks whether the server is well.
const HEALTH: &[u8] = b"GET /healthz ";
/// The answer to it.
const OK: &[u8] = b"HTTP/1.1 200 OK\r\nContent-Type: text/plain\r\nContent-Length: 3\r\nConnection: close\r\n\r\nOK\n";

/// A server of policies.
#[derive(Debug)]
pub struct PolicyServer(TcpListener);

impl PolicyServer {
    /// A server at this host, such as `127.0.0.1`, and this port; 0 for a free one.
    ///
    /// # Errors
    /// The system refuses, for example because the port is taken.
    pub fn bind(host: &str, port: u16) -> io::Result<Self> {
        TcpListener::bind((host, port)).map(Self)
    }

    /// Where it listens.
    ///
    /// # Errors
    /// The system does not say.
    pub fn address(&self) -> io::Result<SocketAddr> {
        self.0.local_addr()
    }

    /// Serves a policy until the program ends, or until the system lets nobody connect any more, for the reason that is returned. What a client does wrong ends its
    /// connection alone.
    pub fn serve(&self, served: &impl Served) -> io::Error {
        let clients = AtomicUsize::new(0);
        let clients = &clients;
        thread::scope(|scope| {
            let mut refusals = 0;
            loop {
                let stream = match self.0.accept() {
                    Ok((stream, _)) => stream,
                    Err(error) if refusals >= MOST_REFUSALS => return error,
                    Err(_) => {
                        refusals += 1;
                        thread::sleep(REST);
                        continue;
                    }
                };
                refusals = 0;
                if clients.fetch_add(1, Ordering::Relaxed) >= MOST_CLIENTS {
                    clients.fetch_sub(1, Ordering::Relaxed);
                    continue;
                }
                let client = move || {
                    // A client that breaks the connection has nothing more to be told.
                    drop(attend(stream, served));
                    clients.fetch_sub(1, Ordering::Relaxed);
                };
                let thread = thread::Builder::new().spawn_scoped(scope, client);
                if thread.is_err() {
                    clients.fetch_sub(1, Ordering::Relaxed);
                }
            }
        })
    }
}

/// Serves a client until it goes.
fn attend(mut stream: TcpStream, served: &impl Served) -> Result<(), Error> {
    let deadline = Instant::now() + PATIENCE;
    if asks_for_health(&stream, deadline)? {
        // The request is read, so that the answer is not lost with it.
        stream.set_read_timeout(Some(REST))?;
        let _unimportant = stream.read(&mut [0; 4096])?;
        stream.set_write_timeout(Some(PATIENCE))?;
        stream.write_all(OK)?;
        return Ok(());
    }
    let config = WebSocketConfig::default()
        .max_message_size(Some(MOST_BYTES))
        .max_frame_size(Some(MOST_BYTES));
    let stream = PatientStream::new(stream, deadline)?;
    let shaken = accept_with_config(stream, Some(config));
    let Ok(mut socket) = shaken else {
        return Err(Error::ConnectionClosed);
    };
    send(&mut socket, Message::binary(encode(&served.metadata())))?;
    loop {
        // A client may think for as long as it likes.
        socket.get_mut().deadline = None;
        let answer = match socket.read()? {
            Message::Binary(bytes) => timed_answer(served, &bytes),
            Message::Text(_) => Err("an observation is a binary frame, not a text".into()),
            Message::Close(_) => return socket.flush(),
            Message::Ping(_) | Message::Pong(_) | Message::Frame(_) => continue,
        };
        match answer {
            Ok(answer) => send(&mut socket, Message::binary(encode(&answer)))?,
            Err(fault) => {
                send(&mut socket, Message::text(fault))?;
                let reason = CloseFrame {
                    code: CloseCode::Error,
                    reason: "The previous frame says why.".into(),
                };
                socket.close(Some(reason))?;
                return socket.flush();
            }
        }
    }
}

fn send(socket: &mut WebSocket<PatientStream>, message: Message) -> Result<(), Error> {
    socket.get_mut().deadline = Some(Instant::now() + PATIENCE);
    socket.send(message)
}

/// The answer to a frame, with the milliseconds that it took.
fn timed_answer(served: &impl Served, frame: &[u8]) -> Result<WireMap, String> {
    let observation = match decode(frame) {
        Ok(WireValue::Map(observation)) => observation,
        Ok(other) => return Err(format!("an observation is a map, not {}", other.kind())),
        Err(fault) => return Err(format!("the observation is damaged: {fault}")),
    };
    let start = Instant::now();
    let mut answer = served.answer(&observation)?;
    let milliseconds = start.elapsed().as_secs_f64() * 1e3;
    let timing = WireMap::from([("infer_ms".to_owned(), milliseconds.into())]);
    answer.insert("server_timing".into(), timing.into());
    Ok(answer)
}

/// True if the first line of a client's request asks for the server's health. Nothing is read.
fn asks_for_health(stream: &TcpStream, deadline: Instant) -> io::Result<bool> {
    let mut first = [0; HEALTH.len()];
    loop {
        let wait = deadline.saturating_duration_since(Instant::now());
        if wait.is_zero() {
            return Err(io::ErrorKind::TimedOut.into());
        }
        stream.set_read_timeout(Some(wait))?;
        let count = stream.peek(&mut first)?;
        if count == 0 {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        if count == HEALTH.len() || !HEALTH.starts_with(&first[..count]) {
            return Ok(first == HEALTH);
        }
        thread::sleep(Duration::from_millis(1));
    }
}
