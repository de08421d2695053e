//! MP4 files with AV1 at equal intervals, as [`Mp4Writer`](crate::Mp4Writer) and LeRobot's tools make them, read back: their frames are copied, not
//! decoded.

use std::{
    io::{Read, Seek, SeekFrom},
    ops::Range,
};

use mp4_atom::{
    Atom, Av1c, Co64, Codec, Elst, Mdhd, Stco, Stsc, Stsd, Stss, Stsz, StszSamples, Stts, Tkhd,
};

use crate::{
    error::FilmError,
    mp4::VideoCoding,
    video::{VideoPacket, VideoTrack},
};

/// Largest size of the table of all frames, in bytes.
const MOST_TABLE_BYTES: u64 = 64 << 20;

/// An MP4 file with one AV1 track whose frames are at equal intervals.
#[derive(Debug)]
pub struct Mp4Reader<F> {
    file: F,
    track: VideoTrack,
    coding: VideoCoding,
    frames: Vec<StoredFrame>,
}

/// A frame in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct StoredFrame {
    offset: u64,
    size: u32,
    is_key: bool,
}

impl<F: Read + Seek> Mp4Reader<F> {
    /// Reads the table of all frames.
    ///
    /// # Errors
    /// The file cannot be read, or holds anything else than AV1 of 8 bits, 4:2:0, at equal intervals.
    pub fn open(mut file: F) -> Result<Self, FilmError> {
        let length = file.seek(SeekFrom::End(0))?;
        let movie = movie_in(&mut file, length)?;
        let tables = Tables::of(&movie).map_err(foreign)?;
        let coding = VideoCoding(tables.coding.clone());
        let (track, frames) = tables.read().map_err(foreign)?;
        let ends_inside = |frame: &StoredFrame| {
            let end = frame.offset.checked_add(frame.size.into());
            end.is_some_and(|end| end <= length)
        };
        let bytes: u64 = frames.iter().map(|frame| u64::from(frame.size)).sum();
        match frames.iter().all(ends_inside) && bytes <= length {
            true => Ok(Self {
                file,
                track,
                coding,
                frames,
            }),
            false => Err(foreign("its table names frames that it does not hold")),
        }
    }

    /// Its size and rate.
    pub const fn track(&self) -> VideoTrack {
        self.track
    }

    /// How its frames are encoded.
    pub const fn coding(&self) -> &VideoCoding {
        &self.coding
    }

    /// Number of its frames.
    pub const fn frames(&self) -> usize {
        self.frames.len()
    }

    /// True if a frame can be decoded by itself.
    pub fn is_key(&self, frame: usize) -> bool {
        self.frames.get(frame).is_some_and(|frame| frame.is_key)
    }

    /// These frames.
    ///
    /// # Errors
    /// There are no such frames, or the file cannot be read.
    pub fn packets(&mut self, frames: Range<usize>) -> Result<Vec<VideoPacket>, FilmError> {
        let frames = self.frames.get(frames);
        let frames = frames.ok_or_else(|| foreign("it ends before"))?;
        let packets = frames.iter().map(|frame| {
            self.file.seek(SeekFrom::Start(frame.offset))?;
            let mut bytes = vec![0; frame.size as usize];
            self.file.read_exact(&mut bytes)?;
            Ok(VideoPacket {
                bytes,
                is_key: frame.is_key,
            })
        });
        Ok(packets.collect::<Result<_, std::io::Error>>()?)
    }
}

fn foreign(problem: impl ToString) -> FilmError {
    FilmError::Foreign(problem.to_string())
}

/// The bytes of the atom with the table of all frames.
fn movie_in(file: &mut (impl Read + Seek), length: u64) -> Result<Vec<u8>, FilmError> {
    let mut at = 0;
    while length - at >= 8 {
        let mut header = [0; 8];
        file.seek(SeekFrom::Start(at))?;
        file.read_exact(&mut header)?;
        let [a, b, c, d, kind @ ..] = header;
        let size = u64::from(u32::from_be_bytes([a, b, c, d]));
        if size < 8 || size > length - at {
            break;
        }
        if &kind == b"moov" {
            if size > MOST_TABLE_BYTES {
                return Err(foreign(format!(
                    "its table has more than {MOST_TABLE_BYTES} bytes"
                )));
            }
            let mut body = vec![0; size as usize - 8];
            file.read_exact(&mut body)?;
            return Ok(body);
        }
        at += size;
    }
    Err(foreign("it has no table of its frames, or was cut off"))
}

/// The body of the first atom of a kind among these bytes.
fn child<'b>(mut bytes: &'b [u8], kind: &[u8; 4]) -> Option<&'b [u8]> {
    while let Some((header, rest)) = bytes.split_first_chunk::<8>() {
        let [a, b, c, d, found @ ..] = *header;
        let size = u32::from_be_bytes([a, b, c, d]) as usize;
        let (body, next) = rest.split_at_checked(size.checked_sub(8)?)?;
        if &found == kind {
            return Some(body);
        }
        bytes = next;
    }
    None
}

/// The tables of a track.
struct Tables {
    size: [u32; 2],
    timescale: u32,
    times: Stts,
    sizes: Stsz,
    runs: Stsc,
    chunks: Vec<u64>,
    /// The frames that can be decoded by themselves, from 1; if it does not say, all can.
    keys: Option<Stss>,
    coding: Stsd,
}

impl Tables {
    /// Those of the only track of a movie.
    fn of(movie: &[u8]) -> Result<Self, String> {
        let inner = |bytes, kind: [u8; 4]| {
            child(bytes, &kind).ok_or_else(|| format!("it has no {}", kind.escape_ascii()))
        };
        let track = inner(movie, *b"trak")?;
        let media = inner(track, *b"mdia")?;
        let table = inner(inner(media, *b"minf")?, *b"stbl")?;
        let header: Tkhd = leaf(track)?;
        let size = [header.width, header.height].map(|side| u32::from(side.integer()));
        let coding: Stsd = leaf(table)?;
        match coding.codecs.as_slice() {
            [Codec::Av01(video)]
                if [video.visual.width, video.visual.height].map(u32::from) == size
                    && is_plain(&video.av1c) => {}
            _ => return Err("its pictures are not AV1 of 8 bits, 4:2:0".into()),
        }
        if child(track, b"edts").is_some_and(|edits| !shows_all(edits)) {
            return Err("it shows other frames than it holds".into());
        }
        let chunks = match child(table, b"co64") {
            Some(_) => leaf::<Co64>(table)?.entries,
            None => {
                let offsets = leaf::<Stco>(table)?.entries;
                offsets.into_iter().map(u64::from).collect()
            }
        };
        let keys = child(table, b"stss").map(|_| leaf(table)).transpose()?;
        Ok(Self {
            size,
            timescale: leaf::<Mdhd>(media)?.timescale,
            times: leaf(table)?,
            sizes: leaf(table)?,
            runs: leaf(table)?,
            chunks,
            keys,
            coding,
        })
    }

    /// The track, and its frames in their order.
    fn read(self) -> Result<(VideoTrack, Vec<StoredFrame>), String> {
        let StszSamples::Different { sizes } = self.sizes.samples else {
            return Err("its frames have no sizes of their own".into());
        };
        let interval = match self.times.entries.as_slice() {
            [all] if all.sample_count as usize == sizes.len() => Some(all.sample_delta),
            [] if sizes.is_empty() => Some(self.timescale),
            _ => None,
        };
        let interval = interval
            .filter(|it| *it > 0 && self.timescale > 0 && self.timescale.is_multiple_of(*it));
        let interval = interval.ok_or("its frames are not at equal intervals")?;
        let mut frames = Vec::with_capacity(sizes.len());
        let mut runs = self.runs.entries.iter().peekable();
        let mut in_chunk = 0;
        for (number, start) in (1..).zip(self.chunks) {
            if let Some(run) = runs.next_if(|run| run.first_chunk == number) {
                in_chunk = run.samples_per_chunk as usize;
            }
            let mut offset: u64 = start;
            for &size in sizes.iter().skip(frames.len()).take(in_chunk) {
                frames.push(StoredFrame {
                    offset,
                    size,
                    is_key: self.keys.is_none(),
                });
                offset = offset.saturating_add(size.into());
            }
        }
        if frames.len() != sizes.len() {
            return Err("its table does not say where all frames are".into());
        }
        for key in self.keys.map_or(Vec::new(), |keys| keys.entries) {
            let place = (key as usize).checked_sub(1);
            if let Some(frame) = place.and_then(|place| frames.get_mut(place)) {
                frame.is_key = true;
            }
        }
        let [width, height] = self.size;
        let track = VideoTrack {
            width,
            height,
            fps: self.timescale / interval,
        };
        Ok((track, frames))
    }
}

/// True if pictures are as those of this program: 8 bits, with colours at half the resolution.
const fn is_plain(coding: &Av1c) -> bool {
    let is_halved = coding.chroma_subsampling_x && coding.chroma_subsampling_y;
    coding.seq_profile == 0 && !coding.high_bitdepth && !coding.monochrome && is_halved
}

/// True if these edits show all frames from the first one on.
fn shows_all(edits: &[u8]) -> bool {
    let edits = leaf::<Elst>(edits).map(|edits| edits.entries);
    edits.is_ok_and(|edits| matches!(&edits[..], [all] if all.media_time == Some(0)))
}

/// The first atom of its kind among these bytes.
fn leaf<A: Atom>(bytes: &[u8]) -> Result<A, String> {
    let kind: [u8; 4] = A::KIND.into();
    let body = child(bytes, &kind);
    let mut body = body.ok_or_else(|| format!("it has no {}", kind.escape_ascii()))?;
    A::decode_body(&mut body).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;
    use crate::mp4::Mp4Writer;

    const TRACK: VideoTrack = VideoTrack {
        width: 200,
        height: 150,
        fps: 4,
    };

    fn packets() -> Vec<VideoPacket> {
        let packet = |first: u8, length: usize, is_key| VideoPacket {
            bytes: vec![first; length],
            is_key,
        };
        vec![
            packet(1, 30, true),
            packet(2, 5, false),
            packet(3, 20, true),
            packet(4, 6, false),
            packet(5, 9, true),
        ]
    }

    fn written() -> Vec<u8> {
        let packets = packets();
        let (mut file, mut bytes) =
            Mp4Writer::begin(TRACK, VideoCoding::of(&TRACK).unwrap()).unwrap();
        for chunk in [0..2, 2..4, 4..5] {
            bytes.extend(file.add(&packets[chunk]).unwrap());
        }
        bytes.extend(file.end().unwrap());
        bytes
    }

    #[test]
    fn frames_read_back_to_the_byte() {
        let mut file = Mp4Reader::open(Cursor::new(written())).unwrap();
        assert_eq!((file.track(), file.frames()), (TRACK, 5));
        assert_eq!(file.packets(0..5).unwrap(), packets());
        assert_eq!(file.packets(2..4).unwrap(), packets()[2..4]);
        assert!(file.is_key(2) && !file.is_key(3) && !file.is_key(9));
        assert!(file.packets(4..6).is_err());
    }

    #[test]
    fn damaged_files_are_refused_or_read_but_never_panic() {
        let whole = written();
        for length in 0..whole.len() {
            assert!(
                Mp4Reader::open(Cursor::new(&whole[..length])).is_err(),
                "{length}"
            );
        }
        for place in 0..whole.len() {
            for value in [0, 1, 0x7f, 0xff] {
                let mut bytes = whole.clone();
                bytes[place] = value;
                if let Ok(mut file) = Mp4Reader::open(Cursor::new(bytes)) {
                    let _damaged = file.packets(0..file.frames());
                }
            }
        }
    }
}
