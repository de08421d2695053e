//! MP4 files with one AV1 track.

use mp4_atom::{
    Av01, Av1c, Co64, Dinf, Dref, Encode as _, FourCC, Ftyp, Hdlr, Mdhd, Mdia, Minf, Moov, Mvhd,
    Stbl, Stsc, StscEntry, Stsd, Stss, Stsz, StszSamples, Stts, SttsEntry, Tkhd, Trak, Url, Visual,
    Vmhd,
};

use crate::{
    error::FilmError,
    video::{VideoPacket, VideoTrack},
};

/// Units of time a frame: rates of frames that are not whole numbers of milliseconds keep exact times when files are joined.
pub(crate) const UNITS_PER_FRAME: u32 = 1000;

/// The parts of an MP4 file with one AV1 track, in their order. Frame `k` is shown at `k / fps` seconds exactly: there is no edit list.
#[derive(Clone, Debug)]
pub struct Mp4Writer {
    track: VideoTrack,
    coding: VideoCoding,
    /// Number of bytes so far.
    length: u64,
    sizes: Vec<u32>,
    /// Numbers of the frames that can be decoded by themselves, from 1.
    keys: Vec<u32>,
    chunks: Vec<Chunk>,
}

/// How the frames of a file are encoded, as players must know it before the first one. Only frames of one coding go into one file.
#[derive(Clone, Debug, PartialEq)]
pub struct VideoCoding(pub(crate) Stsd);

impl VideoCoding {
    /// That of [`VideoEncoder`](crate::VideoEncoder).
    ///
    /// # Errors
    /// A side is too long.
    pub fn of(track: &VideoTrack) -> Result<Self, FilmError> {
        track.description().map(Self)
    }
}

/// Frames that stand together.
#[derive(Clone, Copy, Debug)]
struct Chunk {
    offset: u64,
    frames: u32,
}

impl Mp4Writer {
    /// A file for such a track, and its first bytes.
    ///
    /// # Errors
    /// None that is known.
    pub fn begin(track: VideoTrack, coding: VideoCoding) -> Result<(Self, Vec<u8>), FilmError> {
        let brands = [b"isom", b"iso6", b"av01", b"mp41"];
        let kind = Ftyp {
            major_brand: b"isom".into(),
            minor_version: 512,
            compatible_brands: brands.map(FourCC::from).to_vec(),
        };
        let mut bytes = Vec::new();
        kind.encode(&mut bytes).map_err(failed)?;
        let writer = Self {
            track,
            coding,
            length: bytes.len() as u64,
            sizes: Vec::new(),
            keys: Vec::new(),
            chunks: Vec::new(),
        };
        Ok((writer, bytes))
    }

    /// Number of frames so far.
    pub fn frames(&self) -> usize {
        self.sizes.len()
    }

    /// Number of bytes so far.
    pub const fn bytes(&self) -> u64 {
        self.length
    }

    /// The next bytes: these frames.
    ///
    /// # Errors
    /// The frames have more than 4 GiB.
    pub fn add(&mut self, packets: &[VideoPacket]) -> Result<Vec<u8>, FilmError> {
        let size: usize = packets.iter().map(|packet| packet.bytes.len()).sum();
        let size = u32::try_from(size + 8).map_err(failed)?;
        let mut bytes = size.to_be_bytes().to_vec();
        bytes.extend(b"mdat");
        self.chunks.push(Chunk {
            offset: self.length + 8,
            frames: packets.len() as u32,
        });
        for packet in packets {
            bytes.extend(&packet.bytes);
            self.sizes.push(packet.bytes.len() as u32);
            if packet.is_key {
                self.keys.push(self.sizes.len() as u32);
            }
        }
        self.length += bytes.len() as u64;
        Ok(bytes)
    }

    /// The last bytes: the table of all frames.
    ///
    /// # Errors
    /// The track has more frames than the format can count.
    pub fn end(&self) -> Result<Vec<u8>, FilmError> {
        let VideoTrack { width, height, fps } = self.track;
        let timescale = fps * UNITS_PER_FRAME;
        let duration = self.sizes.len() as u64 * u64::from(UNITS_PER_FRAME);
        let [width, height] = [side(width)?, side(height)?];
        let table = Stbl {
            stsd: self.coding.0.clone(),
            stts: Stts {
                entries: vec![SttsEntry {
                    sample_count: self.sizes.len() as u32,
                    sample_delta: UNITS_PER_FRAME,
                }],
            },
            stss: Some(Stss {
                entries: self.keys.clone(),
            }),
            stsc: Stsc {
                entries: self.runs(),
            },
            stsz: Stsz {
                samples: StszSamples::Different {
                    sizes: self.sizes.clone(),
                },
            },
            co64: Some(Co64 {
                entries: self.chunks.iter().map(|chunk| chunk.offset).collect(),
            }),
            ..Default::default()
        };
        let track = Trak {
            tkhd: Tkhd {
                track_id: 1,
                duration,
                enabled: true,
                in_movie: true,
                width: width.into(),
                height: height.into(),
                ..Default::default()
            },
            mdia: Mdia {
                mdhd: Mdhd {
                    timescale,
                    duration,
                    language: "und".into(),
                    ..Default::default()
                },
                hdlr: Hdlr {
                    handler: b"vide".into(),
                    name: "tabletop".into(),
                },
                minf: Minf {
                    vmhd: Some(Vmhd::default()),
                    dinf: Dinf {
                        dref: Dref {
                            entries: vec![Url::default().into()],
                        },
                    },
                    stbl: table,
                    ..Default::default()
                },
            },
            ..Default::default()
        };
        let movie = Moov {
            mvhd: Mvhd {
                timescale,
                duration,
                next_track_id: 2,
                rate: 1.into(),
                ..Default::default()
            },
            trak: vec![track],
            ..Default::default()
        };
        let mut bytes = Vec::new();
        movie.encode(&mut bytes).map_err(failed)?;
        Ok(bytes)
    }

    /// Where the number of frames a chunk changes.
    fn runs(&self) -> Vec<StscEntry> {
        let mut runs: Vec<StscEntry> = Vec::new();
        for (number, chunk) in (1..).zip(&self.chunks) {
            if runs
                .last()
                .is_none_or(|run| run.samples_per_chunk != chunk.frames)
            {
                runs.push(StscEntry {
                    first_chunk: number,
                    samples_per_chunk: chunk.frames,
                    sample_description_index: 1,
                });
            }
        }
        runs
    }
}

impl VideoTrack {
    /// How the frames of a file are encoded.
    ///
    /// # Errors
    /// A side is too long.
    fn description(&self) -> Result<Stsd, FilmError> {
        let video = Av01 {
            visual: Visual {
                data_reference_index: 1,
                width: side(self.width)?,
                height: side(self.height)?,
                ..Default::default()
            },
            av1c: self.configuration(),
            ..Default::default()
        };
        Ok(Stsd {
            codecs: vec![video.into()],
        })
    }

    /// What a player must know before the first frame: profile 0 (8 bits, 4:2:0), any level.
    fn configuration(&self) -> Av1c {
        Av1c {
            seq_profile: 0,
            seq_level_idx_0: 31,
            chroma_subsampling_x: true,
            chroma_subsampling_y: true,
            ..Default::default()
        }
    }
}

fn side(side: u32) -> Result<u16, FilmError> {
    u16::try_from(side).map_err(failed)
}

fn failed(error: impl ToString) -> FilmError {
    FilmError::Failed(error.to_string())
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use mp4_atom::{Any, ReadFrom as _};

    use super::*;

    #[test]
    fn frames_are_where_the_table_says_and_at_exact_times() {
        let track = VideoTrack {
            width: 200,
            height: 150,
            fps: 4,
        };
        let packet = |first: u8, length: usize, is_key| VideoPacket {
            bytes: vec![first; length],
            is_key,
        };
        let (mut file, mut bytes) =
            Mp4Writer::begin(track, VideoCoding::of(&track).unwrap()).unwrap();
        bytes.extend(
            file.add(&[packet(1, 30, true), packet(2, 5, false)])
                .unwrap(),
        );
        bytes.extend(
            file.add(&[packet(3, 20, true), packet(4, 6, false)])
                .unwrap(),
        );
        bytes.extend(file.add(&[packet(5, 9, true)]).unwrap());
        assert_eq!((file.bytes(), file.frames()), (bytes.len() as u64, 5));
        bytes.extend(file.end().unwrap());

        let mut movie = None;
        let mut reader = Cursor::new(&bytes);
        while (reader.position() as usize) < bytes.len() {
            if let Any::Moov(found) = Any::read_from(&mut reader).unwrap() {
                movie = Some(found);
            }
        }
        let media = &movie.unwrap().trak[0].mdia;
        let table = &media.minf.stbl;
        assert_eq!((media.mdhd.timescale, media.mdhd.duration), (4000, 5000));
        assert_eq!(table.stts.entries[0].sample_delta, 1000);
        assert_eq!(table.stss.as_ref().unwrap().entries, [1, 3, 5]);
        let chunks = &table.co64.as_ref().unwrap().entries;
        let first: Vec<_> = chunks
            .iter()
            .map(|offset| bytes[*offset as usize])
            .collect();
        assert_eq!(first, [1, 3, 5]);
        let runs: Vec<_> = table
            .stsc
            .entries
            .iter()
            .map(|run| (run.first_chunk, run.samples_per_chunk))
            .collect();
        assert_eq!(runs, [(1, 2), (3, 1)]);
    }
}
