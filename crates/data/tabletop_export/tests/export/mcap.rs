//! MCAP files.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
};

use mcap::MessageStream;
use tabletop_export::{DatasetFormat as _, Mcap};

use crate::{
    alone,
    demonstration::{episode, fresh},
};

/// The fields of a Protocol Buffers message: the bytes of each, by its number.
#[derive(Clone, Debug, Default)]
struct Message(BTreeMap<u32, Vec<Vec<u8>>>);

impl Message {
    fn read(mut bytes: &[u8]) -> Self {
        let mut message = Self::default();
        while !bytes.is_empty() {
            let tag = varint(&mut bytes);
            let content = match tag & 7 {
                0 => varint(&mut bytes).to_le_bytes().to_vec(),
                1 => take(&mut bytes, 8),
                2 => {
                    let length = varint(&mut bytes) as usize;
                    take(&mut bytes, length)
                }
                5 => take(&mut bytes, 4),
                way => panic!("there is no way {way} of writing a field"),
            };
            let fields = message.0.entry((tag >> 3) as u32).or_default();
            fields.push(content);
        }
        message
    }

    fn all(&self, number: u32) -> Vec<Self> {
        let fields = self.0.get(&number).into_iter().flatten();
        fields.map(|bytes| Self::read(bytes)).collect()
    }

    fn message(&self, number: u32) -> Self {
        self.all(number).remove(0)
    }

    fn text(&self, number: u32) -> &str {
        std::str::from_utf8(&self.0[&number][0]).unwrap()
    }

    fn texts(&self, number: u32) -> Vec<&str> {
        let fields = self.0.get(&number).into_iter().flatten();
        fields.map(|it| std::str::from_utf8(it).unwrap()).collect()
    }

    fn double(&self, number: u32) -> f64 {
        f64::from_le_bytes(self.0[&number][0].as_slice().try_into().unwrap())
    }

    fn float(&self, number: u32) -> f32 {
        f32::from_le_bytes(self.0[&number][0].as_slice().try_into().unwrap())
    }

    fn whole(&self, number: u32) -> u64 {
        u64::from_le_bytes(self.0[&number][0].as_slice().try_into().unwrap())
    }
}

fn take(bytes: &mut &[u8], count: usize) -> Vec<u8> {
    let (taken, rest) = bytes.split_at(count);
    *bytes = rest;
    taken.to_vec()
}

fn varint(bytes: &mut &[u8]) -> u64 {
    let mut number = 0;
    for shift in (0..64).step_by(7) {
        let byte = take(bytes, 1)[0];
        number |= u64::from(byte & 0x7f) << shift;
        if byte < 0x80 {
            break;
        }
    }
    number
}

fn exported(folder: &str) -> Vec<u8> {
    let folder = fresh(folder);
    let mut files = Mcap::open(folder.clone(), &alone()).unwrap();
    files.write(Mcap::prepare(episode()).unwrap()).unwrap();
    files.finish().unwrap();
    fs::read(folder.join("episode-000000.mcap")).unwrap()
}

#[test]
fn every_frame_has_its_messages_at_its_time() {
    let bytes = exported("mcap");
    let mut topics = BTreeMap::<String, Vec<(u64, Message)>>::new();
    for message in MessageStream::new(&bytes).unwrap() {
        let message = message.unwrap();
        assert_eq!(message.channel.message_encoding, "protobuf");
        let topic = topics.entry(message.channel.topic.clone()).or_default();
        topic.push((message.log_time, Message::read(&message.data)));
    }
    let episode = episode();
    for topic in ["/camera/head", "/tf", "/state", "/action"] {
        assert_eq!(topics[topic].len(), episode.len(), "{topic}");
    }
    let (time, transforms) = &topics["/tf"][1];
    assert_eq!(*time, episode.ticks[1].0 * 1_000_000_000 / 60);
    let red = transforms.message(1);
    let stamp = red.message(1);
    assert_eq!(stamp.whole(1) * 1_000_000_000 + stamp.whole(2), *time);
    assert_eq!((red.text(2), red.text(3)), ("table", "Red"));
    let x = red.message(4).double(1);
    assert!((x - 0.2).abs() < 1e-3, "in metres: {x}");
    let picture = &topics["/camera/head"][1].1;
    assert_eq!((picture.text(3), picture.text(4)), ("png", "head"));
    assert_eq!(picture.0[&2][0], episode.cameras[0].images[1].png);
    let entities = topics["/scene"][0].1.all(2);
    assert_eq!(entities.len(), 2);
    let cube = entities[0].message(8);
    assert_eq!(cube.message(2).double(1) as f32, 0.1);
    assert_eq!(topics["/log"][0].1.text(3), "pick up the red block");
    let state: Vec<_> = episode.state.frames().nth(1).unwrap().to_vec();
    let said = &topics["/state"][1].1;
    assert_eq!(said.0.len(), state.len());
    for (number, value) in (1..).zip(state) {
        assert_eq!(said.float(number), value);
    }
}

#[test]
fn every_topic_has_a_schema_that_says_all_of_its_messages() {
    let bytes = exported("mcap_schemas");
    let mut names = BTreeSet::new();
    for message in MessageStream::new(&bytes).unwrap() {
        let channel = message.unwrap().channel;
        let schema = channel.schema.as_ref().unwrap();
        assert_eq!(schema.encoding, "protobuf");
        names.insert(schema.name.clone());
        let (mut files, mut types) = (BTreeSet::new(), BTreeSet::new());
        for file in Message::read(&schema.data).all(1) {
            assert_eq!(file.text(12), "proto3");
            for needed in file.texts(3) {
                assert!(
                    files.contains(needed),
                    "{needed} comes before what needs it"
                );
            }
            files.insert(file.text(1).to_owned());
            let package = file.text(2);
            let content = file.message(4);
            let name = format!(".{package}.{}", content.text(1));
            let enums = content.all(4);
            types.extend(enums.iter().map(|it| format!("{name}.{}", it.text(1))));
            types.insert(name);
            for field in content.all(2) {
                for named in field.texts(6) {
                    assert!(types.contains(named), "{named}");
                }
            }
        }
        assert!(types.contains(&format!(".{}", schema.name)), "{types:?}");
    }
    let expected = [
        "foxglove.CompressedImage",
        "foxglove.FrameTransforms",
        "foxglove.Log",
        "foxglove.SceneUpdate",
        "tabletop.Action",
        "tabletop.State",
    ];
    assert_eq!(names.into_iter().collect::<Vec<_>>(), expected);
}
