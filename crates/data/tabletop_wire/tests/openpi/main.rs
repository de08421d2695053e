//! Our server with the genuine `openpi-client`, and our bytes with its format.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use std::{
    process::{Command, ExitCode},
    thread,
};

use tabletop_harness::test_with;
use tabletop_wire::{Dtype, NumpyArray, PolicyServer, Served, WireMap, WireValue, decode, encode};

fn main() -> ExitCode {
    tabletop_harness::run()
}

/// Runs a script of this folder with arguments, and returns what it prints.
fn python(script: &str, arguments: &[&str]) -> String {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/openpi/");
    let output = Command::new("python3")
        .arg(format!("{folder}{script}"))
        .args(arguments)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    String::from_utf8(output.stdout).unwrap()
}

/// Answers with the sum of a state's numbers, and with what it was sent.
struct Sum;

impl Served for Sum {
    fn metadata(&self) -> WireMap {
        WireMap::from([("rate".to_owned(), WireValue::Integer(15))])
    }

    fn answer(&self, observation: &WireMap) -> Result<WireMap, String> {
        let state = observation.get("observation/state");
        let state = state.and_then(WireValue::array);
        let state = state.ok_or("\"observation/state\" is missing")?;
        let sum = state.numbers().sum::<f64>() as f32;
        let actions = NumpyArray::of_floats(&[2, 2], &[sum, 1.0, -sum, 0.5]);
        Ok(WireMap::from([
            ("actions".to_owned(), actions.into()),
            ("seen".to_owned(), observation.clone().into()),
        ]))
    }
}

#[test_with(OpenpiClient)]
fn the_genuine_client_gets_the_arrays_that_it_sent() {
    let server = PolicyServer::bind("127.0.0.1", 0).unwrap();
    let port = server.address().unwrap().port().to_string();
    thread::spawn(move || server.serve(&Sum));
    let said = python("client.py", &[&port]);
    assert_eq!(said.trim(), "1000 answers, 1 refusal");
}

#[test_with(OpenpiClient)]
fn the_genuine_format_reads_what_we_write_and_we_what_it_writes() {
    let mut map = WireMap::new();
    for dtype in Dtype::ALL {
        let bytes = (0..6 * dtype.bytes()).map(|byte| byte as u8 % 2);
        let array = NumpyArray::new(dtype, vec![2, 3], bytes.collect()).unwrap();
        map.insert(dtype.name().to_owned(), array.into());
    }
    map.insert("text".into(), "ü".into());
    map.insert("number".into(), 0.1.into());
    map.insert("whole".into(), WireValue::Integer(-70_000));
    map.insert("nothing".into(), WireValue::Nil);
    let hex: String = encode(&map)
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect();
    let back = python("format.py", &[&hex]);
    let digits: Vec<char> = back.trim().chars().collect();
    let (pairs, _) = digits.as_chunks::<2>();
    let bytes = pairs.iter().map(|pair| {
        let [high, low] = pair.map(|digit| digit.to_digit(16).unwrap());
        (high << 4 | low) as u8
    });
    let bytes: Vec<u8> = bytes.collect();
    // A number of NumPy's, which we never write, and an array in the other order.
    map.insert("scalar".into(), WireValue::Number(2.5));
    let swapped = NumpyArray::of_floats(&[2], &[1.0, -3.0]);
    map.insert("swapped".into(), swapped.into());
    assert_eq!(decode(&bytes).unwrap(), WireValue::Map(map));
}
