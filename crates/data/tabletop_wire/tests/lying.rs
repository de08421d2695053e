//! Two hundred lying servers, each with a lie at a moment that its seed draws: the client gets a sentence, does not wait for ever, and is as good as new.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use std::{
    collections::BTreeMap,
    io::{self, Read as _, Write as _},
    net::{Shutdown, TcpListener, TcpStream},
    sync::atomic::{AtomicU64, Ordering},
    thread,
    time::Duration,
};

use tabletop_wire::{
    ActionChunk, NumpyArray, PolicyAddress, PolicyClient, PolicyPatience, WireMap, WireValue,
    encode,
};
use tungstenite::{Message, WebSocket, accept};

const SERVERS: u64 = 200;
/// Number of servers at a time: most of the time, they or the client wait.
const AT_A_TIME: u64 = 20;
/// Number of questions that the client asks if all answers are good.
const QUESTIONS: u64 = 5;
const COLUMNS: usize = 7;
const HORIZON: usize = 4;

/// For servers that do something, however busy the machine is.
const PATIENT: PolicyPatience = PolicyPatience {
    connecting: Duration::from_secs(30),
    answering: Duration::from_secs(30),
};
/// For servers that do nothing, or too slowly.
const HASTY: PolicyPatience = PolicyPatience {
    connecting: Duration::from_millis(500),
    answering: Duration::from_millis(300),
};

/// What a server does instead of what it should.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Lie {
    // Of answers alone: metadata may be anything.
    OtherShape,
    OtherDtype,
    NoFiniteNumber,
    NoActions,
    // Of any frame.
    ShapeWithoutBytes,
    EndlessShape,
    DeepMaps,
    CountlessEntries,
    List,
    Text,
    NoText,
    ReservedBits,
    MaskedFrame,
    HugeFrame,
    HugeMessage,
    DamagedFrame,
    // At any time, even before there are frames.
    Garbage,
    Silence,
    Drip,
    Pings,
    HalfAFrame,
    Goodbye,
    Reset,
}

impl Lie {
    const ALL: [Self; 23] = [
        Self::OtherShape,
        Self::OtherDtype,
        Self::NoFiniteNumber,
        Self::NoActions,
        Self::ShapeWithoutBytes,
        Self::EndlessShape,
        Self::DeepMaps,
        Self::CountlessEntries,
        Self::List,
        Self::Text,
        Self::NoText,
        Self::ReservedBits,
        Self::MaskedFrame,
        Self::HugeFrame,
        Self::HugeMessage,
        Self::DamagedFrame,
        Self::Garbage,
        Self::Silence,
        Self::Drip,
        Self::Pings,
        Self::HalfAFrame,
        Self::Goodbye,
        Self::Reset,
    ];

    const fn is_slow(self) -> bool {
        matches!(
            self,
            Self::Silence | Self::Drip | Self::Pings | Self::Garbage | Self::HalfAFrame
        )
    }
}

/// When a server begins to lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Moment {
    Handshake,
    Metadata,
    /// In place of the answer of this number.
    Answer(u64),
}

/// SplitMix64.
struct Draws(u64);

impl Draws {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^ (bits >> 31)
    }

    fn below(&mut self, most: u64) -> u64 {
        self.bits() % most
    }
}

/// A lying server.
#[derive(Clone, Copy, Debug)]
struct Liar {
    lie: Lie,
    moment: Moment,
    seed: u64,
}

impl Liar {
    fn of(seed: u64) -> Self {
        let mut draws = Draws(seed);
        // Each lie is there, in as many moments as there are rounds.
        let lie = Lie::ALL[(seed % Lie::ALL.len() as u64) as usize];
        let answer = Moment::Answer(draws.below(QUESTIONS));
        let any = [Moment::Handshake, Moment::Metadata, answer, answer];
        let moment = if lie < Lie::ShapeWithoutBytes {
            answer
        } else if lie < Lie::Garbage {
            any[1 + draws.below(3) as usize]
        } else {
            any[draws.below(4) as usize]
        };
        Self { lie, moment, seed }
    }

    /// Serves one client.
    fn serve(self, mut stream: TcpStream) {
        if self.moment == Moment::Handshake {
            let mut draws = Draws(!self.seed);
            // A part of the greeting comes first, or nothing.
            let greeting = b"HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\n";
            let part = draws.below(greeting.len() as u64) as usize;
            drop(stream.write_all(&greeting[..part]));
            return self.lie_to(&mut stream);
        }
        let Ok(mut socket) = accept(stream) else {
            return;
        };
        if self.moment == Moment::Metadata {
            return self.lie_to(socket.get_mut());
        }
        let metadata = WireMap::from([("name".to_owned(), WireValue::from("liar"))]);
        drop(socket.send(Message::binary(encode(&metadata))));
        for number in 0.. {
            if !matches!(socket.read(), Ok(Message::Binary(_))) {
                return;
            }
            if self.moment == Moment::Answer(number) {
                return self.lie_to(socket.get_mut());
            }
            answer(&mut socket);
        }
    }

    /// Says what is no good, and nothing good after it.
    fn lie_to(self, stream: &mut TcpStream) {
        let mut draws = Draws(self.seed ^ 0xabcd);
        let said = match self.lie {
            Lie::Silence => Vec::new(),
            Lie::Goodbye => frame(0x88, &1000_u16.to_be_bytes()),
            Lie::Reset => return,
            Lie::Garbage => (0..1 + draws.below(4000))
                .map(|_| draws.bits() as u8)
                .collect(),
            Lie::HalfAFrame => {
                let whole = frame(0x82, &good());
                drop(stream.write_all(&whole[..whole.len() / 2]));
                return drop(stream.shutdown(Shutdown::Both));
            }
            Lie::Drip => {
                let whole = frame(0x82, &good());
                return repeat(stream, |number| vec![whole[number % whole.len()]]);
            }
            Lie::Pings => return repeat(stream, |_| frame(0x89, b"still here")),
            Lie::OtherShape => {
                let shapes: [&[usize]; 5] = [&[4, 8], &[3, 7], &[7], &[4, 7, 1], &[0, 7]];
                let shape = shapes[draws.below(5) as usize];
                frame(
                    0x82,
                    &answer_of(NumpyArray::of_floats(shape, &[0.0; 32]).into()),
                )
            }
            Lie::OtherDtype => {
                let number = WireValue::from(1.0);
                let others = [
                    number.clone(),
                    "actions".into(),
                    WireValue::Nil,
                    WireValue::List(vec![number; 28]),
                    array("|O", &[4, 7], 28 * 8),
                    array("<c8", &[4, 7], 28 * 8),
                    array("<f3", &[4, 7], 28 * 3),
                ];
                frame(0x82, &answer_of(others[draws.below(7) as usize].clone()))
            }
            Lie::NoFiniteNumber => {
                let mut numbers = [0.0; COLUMNS * HORIZON];
                let none = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
                numbers[draws.below(28) as usize] = none[draws.below(3) as usize];
                let actions = NumpyArray::of_floats(&[HORIZON, COLUMNS], &numbers);
                frame(0x82, &answer_of(actions.into()))
            }
            Lie::NoActions => frame(0x82, &encode(&WireMap::new())),
            Lie::ShapeWithoutBytes => frame(0x82, &answer_of(array("<f4", &[4, 7], 5))),
            Lie::EndlessShape => frame(0x82, &answer_of(array("<f8", &[1 << 61, 1 << 61], 16))),
            Lie::DeepMaps => frame(0x82, &[0x81, 0xa1, b'a'].repeat(5000)),
            // A map of 2^32 - 1 entries, and a list.
            Lie::CountlessEntries => frame(0x82, &[0xdf, 255, 255, 255, 255, 0xdd, 255, 255, 255]),
            Lie::List => frame(0x82, b"\x93\x01\x02\x03"),
            Lie::Text => frame(
                0x81,
                b"Traceback (most recent call last):\n\x1b[31mKeyError",
            ),
            Lie::NoText => frame(0x81, b"\xff\xfe\x00"),
            Lie::ReservedBits => frame(0xf2, &good()),
            Lie::MaskedFrame => [&[0x82, 0x80 | 4, 1, 2, 3, 4][..], b"abcd"].concat(),
            // A frame of 2^60 bytes.
            Lie::HugeFrame => [&[0x82, 127, 0x10, 0, 0, 0, 0, 0, 0, 0][..], &[0; 100]].concat(),
            Lie::HugeMessage => {
                let megabyte = vec![0; 1 << 20];
                // A message in parts, which never ends.
                let begin = stream.write_all(&frame(0x02, &megabyte));
                let next = frame(0x00, &megabyte);
                let goes_on = |_: &u64| stream.write_all(&next).is_ok();
                return drop(begin.map(|()| (0..200).take_while(goes_on).count()));
            }
            Lie::DamagedFrame => {
                let mut bytes = good();
                for _ in 0..1 + draws.below(4) {
                    let place = 1 + draws.below(bytes.len() as u64 - 1) as usize;
                    bytes[place] = draws.bits() as u8;
                }
                bytes.truncate(1 + draws.below(bytes.len() as u64 - 1) as usize);
                frame(0x82, &bytes)
            }
        };
        drop(stream.write_all(&said));
        hear_out(stream);
    }
}

/// A frame of a server: the first byte, and what is in it.
fn frame(first: u8, bytes: &[u8]) -> Vec<u8> {
    let length = (bytes.len() as u64).to_be_bytes();
    [&[first, 127], &length[..], bytes].concat()
}

/// The bytes of an answer with these actions.
fn answer_of(actions: WireValue) -> Vec<u8> {
    encode(&WireMap::from([("actions".to_owned(), actions)]))
}

/// Those of an answer that is good.
fn good() -> Vec<u8> {
    answer_of(NumpyArray::of_floats(&[HORIZON, COLUMNS], &[0.5; COLUMNS * HORIZON]).into())
}

/// What is to be an array of NumPy's.
fn array(dtype: &str, shape: &[i64], bytes: usize) -> WireValue {
    let shape = shape.iter().map(|side| WireValue::Integer(*side));
    let parts = [
        ("__ndarray__", WireValue::Boolean(true)),
        ("data", WireValue::Bytes(vec![0; bytes])),
        ("dtype", dtype.into()),
        ("shape", WireValue::List(shape.collect())),
    ];
    let parts = parts.map(|(key, value)| (key.to_owned(), value));
    WireMap::from(parts).into()
}

fn answer(socket: &mut WebSocket<TcpStream>) {
    drop(socket.send(Message::binary(good())));
}

/// Says something every few milliseconds until nobody listens.
fn repeat(stream: &mut TcpStream, said: impl Fn(usize) -> Vec<u8>) {
    for number in 0.. {
        if stream.write_all(&said(number)).is_err() {
            return;
        }
        thread::sleep(Duration::from_millis(15));
    }
}

/// Waits until the client goes.
fn hear_out(stream: &mut TcpStream) {
    drop(stream.set_read_timeout(Some(Duration::from_secs(60))));
    drop(io::copy(&mut stream.take(1 << 24), &mut io::sink()));
}

/// Asks a server until it lies; the number of good answers, and the sentence about the lie.
fn told(liar: Liar) -> (u64, String) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = listener.local_addr().unwrap().port();
    let server = thread::spawn(move || liar.serve(listener.accept().unwrap().0));
    let host = "127.0.0.1".into();
    let patience = if liar.lie.is_slow() { HASTY } else { PATIENT };
    let mut answers = 0;
    let lie = ask(&PolicyAddress { host, port }, patience, &mut answers);
    server.join().unwrap();
    (answers, lie)
}

fn ask(address: &PolicyAddress, patience: PolicyPatience, answers: &mut u64) -> String {
    let mut client = match PolicyClient::connect_within(address, patience) {
        Ok(client) => client,
        Err(error) => return error.to_string(),
    };
    let image = NumpyArray::of_bytes(&[64, 64, 3], vec![7; 64 * 64 * 3]);
    let observation = WireMap::from([("image".to_owned(), image.into())]);
    for _ in 0..QUESTIONS {
        let answer = match client.ask(&observation) {
            Ok(answer) => answer,
            Err(error) => return error.to_string(),
        };
        if let Err(fault) = ActionChunk::of(&answer, COLUMNS, HORIZON) {
            return fault.to_string();
        }
        *answers += 1;
    }
    panic!("no lie was found out");
}

#[test]
fn every_lie_is_found_out() {
    let next = AtomicU64::new(0);
    let check = || {
        let mut found = BTreeMap::<Lie, u64>::new();
        loop {
            let seed = next.fetch_add(1, Ordering::Relaxed);
            if seed >= SERVERS {
                return found;
            }
            let liar = Liar::of(seed);
            let (answers, lie) = told(liar);
            // One sentence, of a length that a person reads.
            assert!((10..1000).contains(&lie.len()), "{liar:?}: {lie}");
            assert!(!lie.contains('\n'), "{liar:?}: {lie}");
            let before = match liar.moment {
                Moment::Handshake | Moment::Metadata => 0,
                Moment::Answer(number) => number,
            };
            // A slow machine may make the client impatient earlier.
            let is_late = lie.contains(" within 0.");
            assert!(
                answers == before || is_late && answers < before,
                "{liar:?}: {lie}"
            );
            *found.entry(liar.lie).or_default() += 1;
        }
    };
    let found: Vec<_> = thread::scope(|scope| {
        let threads: Vec<_> = (0..AT_A_TIME).map(|_| scope.spawn(check)).collect();
        threads
            .into_iter()
            .map(|thread| thread.join().unwrap())
            .collect()
    });
    let mut all = BTreeMap::<Lie, u64>::new();
    for (lie, count) in found.into_iter().flatten() {
        *all.entry(lie).or_default() += count;
    }
    assert_eq!(all.len(), Lie::ALL.len());
    assert_eq!(all.values().sum::<u64>(), SERVERS);
}
