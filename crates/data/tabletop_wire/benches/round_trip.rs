//! How long an observation of DROID's, with two pictures, is on its way to a policy that answers at once, and the answer back: `cargo bench -p tabletop_wire
//! --bench round_trip`. Both ends are on this machine.
#![expect(
    clippy::print_stdout,
    clippy::unwrap_used,
    reason = "it is a benchmark"
)]

use std::{thread, time::Instant};

use tabletop_wire::{ActionChunk, NumpyArray, PolicyClient, PolicyServer, Served, WireMap};

/// How many observations are sent.
const COUNT: usize = 1000;

/// Always wants the same.
struct Always;

impl Served for Always {
    fn metadata(&self) -> WireMap {
        WireMap::new()
    }

    fn answer(&self, _: &WireMap) -> Result<WireMap, String> {
        let actions = NumpyArray::of_floats(&[10, 8], &[0.5; 80]);
        Ok(WireMap::from([("actions".to_owned(), actions.into())]))
    }
}

fn main() {
    let server = PolicyServer::bind("127.0.0.1", 0).unwrap();
    let address = format!("ws://{}", server.address().unwrap());
    thread::spawn(move || server.serve(&Always));
    let mut client = PolicyClient::connect(&address.parse().unwrap()).unwrap();
    let picture = NumpyArray::of_bytes(&[224, 224, 3], (0..=255).cycle().take(150_528).collect());
    let observation = WireMap::from([
        (
            "observation/exterior_image_1_left".to_owned(),
            picture.clone().into(),
        ),
        ("observation/wrist_image_left".to_owned(), picture.into()),
        (
            "observation/joint_position".to_owned(),
            NumpyArray::of_floats(&[7], &[0.1; 7]).into(),
        ),
        (
            "prompt".to_owned(),
            "Put the red block on the blue block.".into(),
        ),
    ]);
    let mut ways: Vec<_> = (0..COUNT)
        .map(|_| {
            let sent = Instant::now();
            let answer = client.ask(&observation).unwrap();
            ActionChunk::of(&answer, 8, 8).unwrap();
            sent.elapsed().as_secs_f64() * 1e3
        })
        .collect();
    ways.sort_by(f64::total_cmp);
    println!(
        "median {:.2} ms, 99 % {:.2} ms, longest {:.2} ms",
        ways[COUNT / 2],
        ways[COUNT * 99 / 100],
        ways[COUNT - 1]
    );
}
