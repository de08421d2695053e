//! Episodes as `tf.train.Example` messages (Protocol Buffers) in TFRecord frames.

use tabletop_training::{TrainingEpisode, gray_png};

use crate::protobuf::wire::{field, varint};

/// An episode as a record: its length, a checksum of that, the message, and a checksum of it.
pub(super) fn record_of(episode: &TrainingEpisode) -> Vec<u8> {
    let message = example_of(episode).finish();
    let length = (message.len() as u64).to_le_bytes();
    let mut record = length.to_vec();
    record.extend(masked(crc32c::crc32c(&length)).to_le_bytes());
    record.extend(&message);
    record.extend(masked(crc32c::crc32c(&message)).to_le_bytes());
    record
}

/// A checksum as TFRecord files have it, so that checksums of checksums differ.
pub(super) const fn masked(sum: u32) -> u32 {
    sum.rotate_right(15).wrapping_add(0xa282_ead8)
}

fn example_of(episode: &TrainingEpisode) -> RldsExample {
    let frames = episode.len();
    let flag = |is_set: &dyn Fn(usize) -> bool| {
        (0..frames).map(|frame| u64::from(is_set(frame))).collect()
    };
    let is_last = |frame: usize| frame + 1 == frames;
    let mut example = RldsExample::default();
    example.texts(
        "episode_metadata/file_path",
        [episode.folder.to_string_lossy().as_bytes()],
    );
    example.floats("episode_metadata/fps", [episode.fps as f32]);
    example.floats(
        "steps/observation/state",
        episode.whole_state().values.iter().copied(),
    );
    example.floats("steps/action", episode.action.values.iter().copied());
    example.numbers("steps/is_first", flag(&|frame| frame == 0));
    example.numbers("steps/is_last", flag(&is_last));
    example.numbers("steps/is_terminal", flag(&is_last));
    example.floats(
        "steps/reward",
        (0..frames).map(|frame| f32::from(u8::from(is_last(frame)))),
    );
    example.floats("steps/discount", std::iter::repeat_n(1.0, frames));
    let task = episode.task.as_bytes();
    example.texts(
        "steps/language_instruction",
        std::iter::repeat_n(task, frames),
    );
    let part = |frame: usize| episode.subtasks.iter().rfind(|part| part.frame <= frame);
    let parts = (0..frames).map(|frame| part(frame).map_or("", |part| &part.sentence).as_bytes());
    example.texts("steps/language_subtask", parts);
    for camera in &episode.cameras {
        let name = format!("steps/observation/{}", camera.name);
        let pictures = camera.images.iter().map(|image| image.png.as_slice());
        example.texts(&format!("{name}_image"), pictures);
        if !camera.depths.is_empty() {
            let depths = camera
                .depths
                .iter()
                .flat_map(|depths| depths.iter().copied());
            example.floats(&format!("{name}_depth"), depths);
        }
        if let Some(image) = camera.images.first().filter(|_| !camera.ids.is_empty()) {
            let files = camera
                .ids
                .iter()
                .map(|ids| gray_png(image.width, image.height, ids));
            let files: Vec<_> = files.collect();
            example.texts(&format!("{name}_ids"), files.iter().map(Vec::as_slice));
        }
    }
    example
}

/// A message of named lists.
#[derive(Default)]
struct RldsExample {
    /// The entries of its map.
    features: Vec<u8>,
}

impl RldsExample {
    fn texts<'t>(&mut self, name: &str, texts: impl IntoIterator<Item = &'t [u8]>) {
        let mut list = Vec::new();
        for text in texts {
            field(&mut list, 1, text);
        }
        self.add(name, 1, &list);
    }

    fn floats(&mut self, name: &str, values: impl IntoIterator<Item = f32>) {
        let values: Vec<u8> = values.into_iter().flat_map(f32::to_le_bytes).collect();
        let mut list = Vec::new();
        field(&mut list, 1, &values);
        self.add(name, 2, &list);
    }

    fn numbers(&mut self, name: &str, values: Vec<u64>) {
        let mut packed = Vec::new();
        values
            .into_iter()
            .for_each(|value| varint(&mut packed, value));
        let mut list = Vec::new();
        field(&mut list, 1, &packed);
        self.add(name, 3, &list);
    }

    /// Adds a list of the kind that a field of `Feature` stands for.
    fn add(&mut self, name: &str, kind: u32, list: &[u8]) {
        let mut feature = Vec::new();
        field(&mut feature, kind, list);
        let mut entry = Vec::new();
        field(&mut entry, 1, name.as_bytes());
        field(&mut entry, 2, &feature);
        field(&mut self.features, 1, &entry);
    }

    fn finish(&self) -> Vec<u8> {
        let mut message = Vec::new();
        field(&mut message, 1, &self.features);
        message
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_and_checksums_are_those_of_tensorflow() {
        let mut example = RldsExample::default();
        example.numbers("a", vec![1, 300]);
        example.floats("b", [1.5]);
        example.texts("c", [b"hi".as_slice()]);
        let expected: Vec<u8> = [
            b"\x0a\x2a".as_slice(),
            b"\x0a\x0c\x0a\x01a\x12\x07\x1a\x05\x0a\x03\x01\xac\x02",
            b"\x0a\x0d\x0a\x01b\x12\x08\x12\x06\x0a\x04\x00\x00\xc0\x3f",
            b"\x0a\x0b\x0a\x01c\x12\x06\x0a\x04\x0a\x02hi",
        ]
        .concat();
        assert_eq!(example.finish(), expected);
        // RFC 3720, B.4: 32 bytes of zeroes.
        assert_eq!(crc32c::crc32c(&[0; 32]), 0x8a91_36aa);
        assert_eq!(masked(0x8a91_36aa), 0x0fd7_fffa);
    }
}
