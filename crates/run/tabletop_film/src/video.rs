//! AV1, one frame after the other.

use rav1e::prelude::*;

use crate::{canvas::Canvas, error::FilmError};

/// The size and rate of a video.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VideoTrack {
    /// Columns, from 16 to 65535.
    pub width: u32,
    /// Rows, from 16 to 65535.
    pub height: u32,
    /// Frames a second.
    pub fps: u32,
}

/// An encoded frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VideoPacket {
    /// Its bytes.
    pub bytes: Vec<u8>,
    /// True if it can be decoded by itself.
    pub is_key: bool,
}

/// Encodes frames as AV1 (8 bits, 4:2:0, BT.709), in their order. The same frames give the same bytes.
#[derive(Debug)]
pub struct VideoEncoder {
    track: VideoTrack,
    context: Context<u8>,
}

/// The quality of 255 steps, 0 the best: at 60, letters of a caption and edges stay sharp.
const QUANTIZER: usize = 60;
/// The encoder's speed, from 0 to 10: the fastest with blocks of 8 pixels, which flat pictures with sharp edges need. At 10 they have twice the bytes.
const SPEED: u8 = 8;
/// Pixels of a tile: tiles are encoded at the same time.
const TILE_PIXELS: usize = 320 * 240;
/// An empty unit that only separates frames in a stream, which files do not hold.
const TEMPORAL_DELIMITER: [u8; 2] = [0x12, 0x00];

impl VideoEncoder {
    /// An encoder, of whose frames every so many at least can be decoded by itself.
    ///
    /// # Errors
    /// [`FilmError::Size`].
    pub fn new(track: VideoTrack, keys: u32) -> Result<Self, FilmError> {
        let [width, height] = [track.width as usize, track.height as usize];
        let sides = 16..=65535;
        if !sides.contains(&width) || !sides.contains(&height) {
            return Err(FilmError::Size {
                format: "an MP4 video",
                width: track.width,
                height: track.height,
                expected: "expected sides of 16 to 65535 pixels",
            });
        }
        let color = ColorDescription {
            color_primaries: ColorPrimaries::BT709,
            transfer_characteristics: TransferCharacteristics::BT709,
            matrix_coefficients: MatrixCoefficients::BT709,
        };
        let settings = EncoderConfig {
            width,
            height,
            time_base: Rational::new(1, u64::from(track.fps)),
            color_description: Some(color),
            pixel_range: PixelRange::Limited,
            min_key_frame_interval: 0,
            max_key_frame_interval: u64::from(keys),
            low_latency: true,
            quantizer: QUANTIZER,
            tiles: (width * height).div_ceil(TILE_PIXELS).min(16),
            ..EncoderConfig::with_speed_preset(SPEED)
        };
        let context = Config::new().with_encoder_config(settings).new_context();
        let context = context.map_err(|error| FilmError::Failed(error.to_string()))?;
        Ok(Self { track, context })
    }

    /// Takes the next frame, and returns those that are ready.
    ///
    /// # Errors
    /// The frame has another size.
    pub fn push(&mut self, frame: &Canvas) -> Result<Vec<VideoPacket>, FilmError> {
        if [frame.width, frame.height] != [self.track.width, self.track.height] {
            return Err(FilmError::Size {
                format: "this video",
                width: frame.width,
                height: frame.height,
                expected: "all of its frames have one size",
            });
        }
        let mut planes = self.context.new_frame();
        let [luma, blue, red] = planes_of(frame);
        let columns = frame.width as usize;
        planes.planes[0].copy_from_raw_u8(&luma, columns, 1);
        planes.planes[1].copy_from_raw_u8(&blue, columns.div_ceil(2), 1);
        planes.planes[2].copy_from_raw_u8(&red, columns.div_ceil(2), 1);
        self.context.send_frame(planes).map_err(failed)?;
        self.ready()
    }

    /// Ends the video, and returns the last frames.
    ///
    /// # Errors
    /// The encoder fails.
    pub fn finish(mut self) -> Result<Vec<VideoPacket>, FilmError> {
        self.context.flush();
        self.ready()
    }

    fn ready(&mut self) -> Result<Vec<VideoPacket>, FilmError> {
        let mut ready = Vec::new();
        loop {
            match self.context.receive_packet() {
                Ok(packet) => {
                    let bytes = packet.data;
                    let bytes = bytes.strip_prefix(&TEMPORAL_DELIMITER).unwrap_or(&bytes);
                    ready.push(VideoPacket {
                        bytes: bytes.to_vec(),
                        is_key: packet.frame_type == FrameType::KEY,
                    });
                }
                Err(EncoderStatus::Encoded) => {}
                Err(EncoderStatus::NeedMoreData | EncoderStatus::LimitReached) => return Ok(ready),
                Err(
                    status @ (EncoderStatus::EnoughData
                    | EncoderStatus::Failure
                    | EncoderStatus::NotReady),
                ) => return Err(failed(status)),
            }
        }
    }
}

fn failed(status: EncoderStatus) -> FilmError {
    FilmError::Failed(status.to_string())
}

/// Luma, and blue and red difference at half the resolution, in the limited range of BT.709.
fn planes_of(frame: &Canvas) -> [Vec<u8>; 3] {
    let (pixels, _) = frame.rgb.as_chunks::<3>();
    let luma = pixels.iter().map(|pixel| {
        let [red, green, blue] = pixel.map(f32::from);
        (16.0 + 0.182_586 * red + 0.614_231 * green + 0.062_007 * blue).round() as u8
    });
    let [width, height] = [frame.width as usize, frame.height as usize];
    let mut differences = [Vec::new(), Vec::new()];
    for row in (0..height).step_by(2) {
        for column in (0..width).step_by(2) {
            let rows = row..(row + 2).min(height);
            let columns = column..(column + 2).min(width);
            let count = (rows.len() * columns.len()) as f32;
            let mut sum = [0.0; 3];
            for row in rows {
                for pixel in &pixels[row * width..][columns.clone()] {
                    for (sum, value) in sum.iter_mut().zip(pixel) {
                        *sum += f32::from(*value);
                    }
                }
            }
            let [red, green, blue] = sum.map(|sum| sum / count);
            let values = [
                128.0 - 0.100_644 * red - 0.338_572 * green + 0.439_216 * blue,
                128.0 + 0.439_216 * red - 0.398_942 * green - 0.040_274 * blue,
            ];
            for (plane, value) in differences.iter_mut().zip(values) {
                plane.push(value.round() as u8);
            }
        }
    }
    let [blue, red] = differences;
    [luma.collect(), blue, red]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn encoded(keys: u32, frames: u8) -> Vec<VideoPacket> {
        let track = VideoTrack {
            width: 33,
            height: 17,
            fps: 4,
        };
        let mut encoder = VideoEncoder::new(track, keys).unwrap();
        let mut packets = Vec::new();
        for frame in 0..frames {
            let picture = Canvas::new(33, 17, [frame * 20, 100, 200]);
            packets.extend(encoder.push(&picture).unwrap());
        }
        packets.extend(encoder.finish().unwrap());
        packets
    }

    #[test]
    fn each_frame_is_a_packet_and_the_same_in_every_run() {
        let packets = encoded(2, 6);
        let keys: Vec<_> = packets.iter().map(|packet| packet.is_key).collect();
        assert_eq!(keys, [true, false, true, false, true, false]);
        // A sequence header comes first.
        assert_eq!(packets[0].bytes[0], 0x0a);
        assert_eq!(packets, encoded(2, 6));
        assert_eq!(packets[..2], encoded(2, 2));
    }

    #[test]
    fn colours_are_those_of_bt_709() {
        let [luma, blue, red] = planes_of(&Canvas::new(3, 3, [255; 3]));
        assert_eq!(
            (luma, blue, red),
            (vec![235; 9], vec![128; 4], vec![128; 4])
        );
        let [luma, blue, red] = planes_of(&Canvas::new(2, 2, [255, 0, 0]));
        assert_eq!((luma[0], blue[0], red[0]), (63, 102, 240));
    }

    #[test]
    fn pictures_of_other_sizes_are_refused() {
        let track = VideoTrack {
            width: 8,
            height: 150,
            fps: 4,
        };
        let error = VideoEncoder::new(track, 2).unwrap_err().to_string();
        assert!(error.contains("8x150"), "{error}");
        let track = VideoTrack { width: 16, ..track };
        let mut encoder = VideoEncoder::new(track, 2).unwrap();
        assert!(encoder.push(&Canvas::new(16, 16, [0; 3])).is_err());
    }
}
