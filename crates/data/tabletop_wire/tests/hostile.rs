//! Servers that are silent, close, lie or talk nonsense: each gets a sentence, in time.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use std::{
    io::{Read as _, Write as _},
    net::{TcpListener, TcpStream},
    thread,
    time::{Duration, Instant},
};

use tabletop_wire::{
    ActionChunk, NumpyArray, PolicyAddress, PolicyClient, PolicyPatience, WireMap, encode,
};
use tungstenite::{Message, WebSocket, accept};

/// For servers that do something, however busy the machine is.
const PATIENT: PolicyPatience = PolicyPatience {
    connecting: Duration::from_secs(60),
    answering: Duration::from_secs(60),
};

/// For servers that do nothing.
const HASTY: PolicyPatience = PolicyPatience {
    connecting: Duration::from_secs(2),
    answering: Duration::from_millis(500),
};

/// A server for one client, which does with its connection what it is told.
fn server(act: impl FnOnce(TcpStream) + Send + 'static) -> PolicyAddress {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = listener.local_addr().unwrap().port();
    thread::spawn(move || act(listener.accept().unwrap().0));
    PolicyAddress {
        host: "127.0.0.1".into(),
        port,
    }
}

/// A server that sends its metadata, takes one observation, and then does what it is told.
fn answering(act: impl FnOnce(&mut WebSocket<TcpStream>) + Send + 'static) -> PolicyAddress {
    server(move |stream| {
        let mut socket = accept(stream).unwrap();
        socket
            .send(Message::binary(encode(&WireMap::new())))
            .unwrap();
        socket.read().unwrap();
        act(&mut socket);
    })
}

/// A server that answers with these actions.
fn acting(actions: NumpyArray) -> PolicyAddress {
    let answer = WireMap::from([("actions".to_owned(), actions.into())]);
    answering(move |socket| socket.send(Message::binary(encode(&answer))).unwrap())
}

/// What comes of asking a server for two actions of three numbers.
fn refusal(address: &PolicyAddress, patience: PolicyPatience) -> String {
    let begin = Instant::now();
    let asked = PolicyClient::connect_within(address, patience);
    let answer = asked.and_then(|mut client| client.ask(&WireMap::new()));
    let refusal = match answer {
        Ok(answer) => ActionChunk::of(&answer, 3, 2).unwrap_err().to_string(),
        Err(error) => error.to_string(),
    };
    assert!(begin.elapsed() < 2 * PATIENT.connecting, "{refusal}");
    refusal
}

fn assert_refused(address: &PolicyAddress, fault: &str) {
    let refusal = refusal(address, PATIENT);
    assert!(refusal.contains(fault), "{refusal}");
}

fn assert_given_up(address: &PolicyAddress, fault: &str) {
    let refusal = refusal(address, HASTY);
    assert!(refusal.contains(fault), "{refusal}");
}

/// Longer than anybody waits here: the test ends before.
fn wait() {
    thread::sleep(Duration::from_secs(600));
}

#[test]
fn nobody_is_there() {
    let address = server(drop);
    drop(TcpStream::connect((address.host.as_str(), address.port)));
    // The listener ends with its only client.
    thread::sleep(Duration::from_millis(100));
    assert_refused(&address, "cannot be reached");
}

#[test]
fn a_server_that_says_nothing_is_given_up() {
    let silent = server(|stream| {
        wait();
        drop(stream);
    });
    assert_given_up(&silent, "has not accepted the connection within 2 s");
    let without_metadata = server(|stream| {
        let socket = accept(stream).unwrap();
        wait();
        drop(socket);
    });
    assert_given_up(&without_metadata, "has not sent its metadata within 2 s");
    assert_given_up(&answering(|_| wait()), "has not answered within 0.5 s");
}

#[test]
fn a_server_that_dribbles_is_given_up() {
    let dribbling = server(|mut stream| {
        let headers = b"Server: slow\r\n".iter().cycle();
        for byte in b"HTTP/1.1 101 Switching Protocols\r\n"
            .iter()
            .chain(headers)
        {
            thread::sleep(Duration::from_millis(200));
            if stream.write_all(&[*byte]).is_err() {
                return;
            }
        }
    });
    assert_given_up(&dribbling, "has not accepted the connection");
    let pinging = answering(|socket| {
        while socket.send(Message::Ping("still here".into())).is_ok() {
            thread::sleep(Duration::from_millis(20));
        }
    });
    assert_given_up(&pinging, "has not answered within 0.5 s");
}

#[test]
fn a_server_of_something_else_is_none() {
    let website = server(|mut stream| {
        let _request = stream.read(&mut [0; 1024]).unwrap();
        stream
            .write_all(b"HTTP/1.1 200 OK\r\nContent-Length: 0\r\n\r\n")
            .unwrap();
    });
    assert_refused(&website, "serves no policy");
    let shell = server(|mut stream| {
        stream.write_all(b"SSH-2.0-OpenSSH_9.2p1\r\n").unwrap();
        wait();
    });
    assert_refused(&shell, "serves no policy");
}

#[test]
fn a_server_that_closes_says_why() {
    assert_refused(&server(drop), "127.0.0.1");
    assert_refused(&answering(|_| {}), "has ended the connection");
    let polite = answering(|socket| {
        socket.close(None).unwrap();
        while socket.read().is_ok() {}
    });
    assert_refused(&polite, "has ended the connection");
}

#[test]
fn a_text_is_a_refusal() {
    let traceback = "Traceback (most recent call last):\n  File \"a.py\"\nKeyError: 'image'\n";
    let refusing = answering(move |socket| {
        socket.send(Message::text(traceback)).unwrap();
        wait();
    });
    let refusal = refusal(&refusing, PATIENT);
    assert!(refusal.ends_with("refuses: KeyError: 'image'"), "{refusal}");
    let long = answering(|socket| socket.send(Message::text("x".repeat(1 << 20))).unwrap());
    assert!(self::refusal(&long, PATIENT).len() < 1000);
}

#[test]
fn nonsense_is_located() {
    let nonsense = answering(|socket| socket.send(Message::binary(&b"\x81\xa1a\xc1"[..])).unwrap());
    assert_refused(&nonsense, "sends nonsense: a: a byte 0xc1");
    let list = answering(|socket| socket.send(Message::binary(&b"\x90"[..])).unwrap());
    assert_refused(&list, "the frame is a list, expected a map");
    let empty = answering(|socket| socket.send(Message::binary(&b""[..])).unwrap());
    assert_refused(&empty, "sends nonsense");
}

#[test]
fn a_huge_frame_is_refused_before_it_is_read() {
    let huge = server(|stream| {
        let mut socket = accept(stream).unwrap();
        // A frame of 2^60 bytes.
        let head = [0x82, 127, 0x10, 0, 0, 0, 0, 0, 0, 0];
        socket.get_mut().write_all(&head).unwrap();
        wait();
    });
    assert_refused(&huge, "Message too long");
}

#[test]
fn actions_of_another_shape_and_no_numbers_are_refused() {
    assert_refused(
        &acting(NumpyArray::of_floats(&[2, 4], &[])),
        "actions: their shape is [2, 4], expected 2 or more rows of 3 numbers",
    );
    assert_refused(
        &acting(NumpyArray::of_floats(&[2, 3], &[f32::INFINITY])),
        "actions: row 1, column 1 is inf",
    );
    let without = answering(|socket| {
        let answer = encode(&WireMap::from([("action".to_owned(), 1.0.into())]));
        socket.send(Message::binary(answer)).unwrap();
    });
    assert_refused(&without, "actions: the answer has none, only [action]");
}

#[test]
fn a_server_that_takes_nothing_is_given_up() {
    let stuck = server(|stream| {
        let mut socket = accept(stream).unwrap();
        socket
            .send(Message::binary(encode(&WireMap::new())))
            .unwrap();
        wait();
    });
    let mut client = PolicyClient::connect_within(&stuck, HASTY).unwrap();
    let picture = NumpyArray::of_bytes(&[40 << 20], Vec::new());
    let observation = WireMap::from([("image".to_owned(), picture.into())]);
    let refusal = client.ask(&observation).unwrap_err().to_string();
    assert!(refusal.contains("within 0.5 s"), "{refusal}");
}
