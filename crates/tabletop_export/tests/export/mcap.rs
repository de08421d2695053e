//! MCAP files.

use std::{collections::BTreeMap, fs};

use mcap::MessageStream;
use serde_json::Value;
use tabletop_export::{DatasetFormat as _, Mcap};

use crate::demonstration::{episode, fresh};

#[test]
fn every_frame_has_its_messages_at_its_time() {
    let folder = fresh("mcap");
    let mut files = Mcap::open(folder.clone()).unwrap();
    files.write(Mcap::prepare(episode()).unwrap()).unwrap();
    files.finish().unwrap();
    let bytes = fs::read(folder.join("episode-000000.mcap")).unwrap();
    let mut topics = BTreeMap::<String, Vec<(u64, Value)>>::new();
    for message in MessageStream::new(&bytes).unwrap() {
        let message = message.unwrap();
        let content = serde_json::from_slice(&message.data).unwrap();
        let topic = topics.entry(message.channel.topic.clone()).or_default();
        topic.push((message.log_time, content));
    }
    let episode = episode();
    for topic in ["/camera/head", "/tf", "/state", "/action"] {
        assert_eq!(topics[topic].len(), episode.len(), "{topic}");
    }
    let (time, transforms) = &topics["/tf"][1];
    assert_eq!(*time, episode.ticks[1].0 * 1_000_000_000 / 60);
    let red = &transforms["transforms"][0];
    assert_eq!(red["child_frame_id"], "Red");
    let x = red["translation"]["x"].as_f64().unwrap();
    assert!((x - 0.2).abs() < 1e-3, "in metres: {x}");
    let entities = topics["/scene"][0].1["entities"].as_array().unwrap();
    assert_eq!(entities.len(), 2);
    assert_eq!(
        entities[0]["cubes"][0]["size"]["x"].as_f64().unwrap() as f32,
        0.1
    );
    assert_eq!(topics["/log"][0].1["message"], "pick up the red block");
}
