//! Our client and our server.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use std::{
    io::{Read as _, Write as _},
    net::TcpStream,
    thread,
};

use tabletop_wire::{
    NumpyArray, PolicyAddress, PolicyClient, PolicyServer, Served, WireMap, WireValue,
};
use tungstenite::{Message, client::client};

/// Answers with what it gets, or refuses if there is no `image`.
struct Echo;

impl Served for Echo {
    fn metadata(&self) -> WireMap {
        WireMap::from([("name".to_owned(), "echo".into())])
    }

    fn answer(&self, observation: &WireMap) -> Result<WireMap, String> {
        match observation.get("image") {
            Some(image) => Ok(WireMap::from([("actions".to_owned(), image.clone())])),
            None => Err("\"image\" is missing".into()),
        }
    }
}

fn echo() -> PolicyAddress {
    let server = PolicyServer::bind("127.0.0.1", 0).unwrap();
    let port = server.address().unwrap().port();
    thread::spawn(move || server.serve(&Echo));
    PolicyAddress {
        host: "127.0.0.1".into(),
        port,
    }
}

#[test]
fn a_thousand_frames_come_back_as_they_were() {
    let mut client = PolicyClient::connect(&echo()).unwrap();
    assert_eq!(client.metadata().get("name"), Some(&"echo".into()));
    for number in 0..1000_u32 {
        let bytes = number.to_le_bytes().repeat(900);
        let image = WireValue::from(NumpyArray::of_bytes(&[30, 40, 3], bytes));
        let observation = WireMap::from([("image".to_owned(), image.clone())]);
        let answer = client.ask(&observation).unwrap();
        assert_eq!(answer.get("actions"), Some(&image));
        let timing = answer.get("server_timing").and_then(WireValue::map);
        assert!(timing.unwrap().contains_key("infer_ms"));
    }
}

#[test]
fn clients_do_not_wait_for_each_other() {
    let address = echo();
    let idle = PolicyClient::connect(&address).unwrap();
    let image = WireValue::from(NumpyArray::of_bytes(&[1], vec![7]));
    let observation = WireMap::from([("image".to_owned(), image)]);
    let mut other = PolicyClient::connect(&address).unwrap();
    other.ask(&observation).unwrap();
    drop(idle);
}

#[test]
fn a_wrong_observation_ends_its_connection_alone() {
    let address = echo();
    let mut client = PolicyClient::connect(&address).unwrap();
    let refusal = client.ask(&WireMap::new()).unwrap_err().to_string();
    assert_eq!(refusal, format!("{address} refuses: \"image\" is missing"));
    client.ask(&WireMap::new()).unwrap_err();
    PolicyClient::connect(&address).unwrap();
}

#[test]
fn a_client_that_talks_nonsense_is_told_so() {
    let address = echo();
    let told = |message: Message| {
        let stream = TcpStream::connect((address.host.as_str(), address.port)).unwrap();
        let (mut socket, _) = client(format!("{address}/"), stream).unwrap();
        assert!(socket.read().unwrap().is_binary());
        socket.send(message).unwrap();
        socket.read().unwrap().into_text().unwrap().to_string()
    };
    assert_eq!(
        told(Message::text("hello")),
        "an observation is a binary frame, not a text"
    );
    assert_eq!(
        told(Message::binary(&b"\x90"[..])),
        "an observation is a map, not a list"
    );
    assert_eq!(
        told(Message::binary(&b"\x81\xa1a\xc1"[..])),
        "the observation is damaged: a: a byte 0xc1, which begins no value of openpi's"
    );
}

#[test]
fn it_says_that_it_is_well() {
    let address = echo();
    let ask = |request: &[u8]| {
        let mut stream = TcpStream::connect((address.host.as_str(), address.port)).unwrap();
        stream.write_all(request).unwrap();
        let mut answer = String::new();
        drop(stream.read_to_string(&mut answer));
        answer
    };
    let answer = ask(b"GET /healthz HTTP/1.1\r\nHost: a\r\n\r\n");
    assert!(answer.starts_with("HTTP/1.1 200 OK"), "{answer}");
    assert!(answer.ends_with("\r\n\r\nOK\n"), "{answer}");
    ask(b"GET / HTTP/1.1\r\nHost: a\r\n\r\n");
    ask(b"\x00\x01");
    PolicyClient::connect(&address).unwrap();
}
