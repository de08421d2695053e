//! The pictures of an imported recording: those that were taken, and drawn ones where they are missing.

use std::{
    collections::{BTreeMap, BTreeSet},
    path::{Path, PathBuf},
};

use tabletop_camera::{Camera, DrawnSolid, Rasterizer, Scene};
use tabletop_core::{HeadCamera, Picture, SimTick, Table};
use tabletop_geometry::Pose;
use tabletop_recorder::{RecordedSegment, RecorderError, RecordingWriter, TICKS_PER_FRAME};
use tabletop_storage::{Symlinks, read_regular_file};
use tabletop_task::Demonstration;

use crate::import::motion::Motions;

/// Largest size of a picture's file, in bytes.
const MOST_BYTES: u64 = 64 << 20;

/// The frames with pictures.
#[derive(Clone, Debug, Default)]
pub(super) struct PicturePlan {
    recorded: BTreeMap<u64, PathBuf>,
    drawn: BTreeSet<u64>,
    size: Option<[u32; 2]>,
}

impl PicturePlan {
    /// The pictures that were taken, and those of frames in which something is elsewhere, which are drawn. The texts say which files are
    /// none of them.
    pub(super) fn of(segments: &[RecordedSegment], motions: &Motions) -> (Self, Vec<String>) {
        let mut plan = Self::default();
        let mut remarks = Vec::new();
        for frame in segments.iter().flat_map(|segment| &segment.frames) {
            let size = size_of(&frame.picture);
            let size = size.and_then(|size| match plan.size {
                Some(first) if first != size => Err("it has another size than the first one"),
                Some(_) | None => Ok(size),
            });
            match size {
                Ok(size) => {
                    plan.size = Some(size);
                    plan.recorded.insert(frame.number, frame.picture.clone());
                }
                Err(problem) => remarks.push(format!(
                    "{}: {problem}; the picture is drawn instead",
                    frame.picture.display()
                )),
            }
        }
        let frames = motions.frames().into_iter();
        plan.drawn = frames
            .filter(|frame| !plan.recorded.contains_key(frame))
            .collect();
        (plan, remarks)
    }

    pub(super) fn recorded(&self) -> usize {
        self.recorded.len()
    }

    pub(super) fn drawn(&self) -> usize {
        self.drawn.len()
    }

    /// The camera of the pictures. That of the original program has pixels that are not square.
    pub(super) fn camera(&self) -> HeadCamera {
        let usual = HeadCamera::default();
        match self.size {
            Some([width, height]) => HeadCamera {
                width,
                height,
                square_fov: true,
                ..usual
            },
            None => usual,
        }
    }

    /// Writes the pictures into the segments that begin in these ticks.
    pub(super) fn write(
        &self,
        writer: &RecordingWriter<'_>,
        starts: &[SimTick],
        motions: &Motions,
        shown: &Demonstration,
        table: &Table,
    ) -> Result<(), RecorderError> {
        let segment_of = |frame: u64| {
            let tick = SimTick(frame.saturating_mul(TICKS_PER_FRAME));
            starts.partition_point(|start| *start <= tick).max(1) as u32 - 1
        };
        for (&frame, path) in &self.recorded {
            let png = read_regular_file(path, MOST_BYTES, Symlinks::Refused);
            let png = png.map_err(|source| RecorderError::Read {
                path: path.clone(),
                source,
            })?;
            writer.encoded_picture(segment_of(frame), frame, &png)?;
        }
        let camera = Camera::of_head(&self.camera(), table);
        let solids: Vec<_> = shown
            .objects
            .iter()
            .map(|it| it.spec.shape.drawn())
            .collect();
        let mut rasterizer = Rasterizer::default();
        let mut picture = Picture::default();
        motions.visit(&self.drawn, |frame, poses| {
            let placed = solids.iter().zip(poses).zip(2..);
            let placed =
                placed.filter_map(|((solids, pose), number)| Some((solids, (*pose)?, number)));
            let objects = placed.flat_map(|(solids, pose, number): (_, Pose, u32)| {
                let solids: &Vec<_> = solids;
                solids
                    .iter()
                    .map(move |solid| DrawnSolid::of(pose, solid, number))
            });
            let scene = Scene {
                solids: [DrawnSolid::of_table(table, 1)]
                    .into_iter()
                    .chain(objects)
                    .collect(),
                ..Scene::default()
            };
            rasterizer.draw(&scene, &camera, &mut picture);
            writer.picture(segment_of(frame), frame, &picture)
        })
    }
}

/// The place of width and height in a PNG file, each of four bytes.
const SIZE_AT: std::ops::Range<usize> = 16..24;

const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";

/// Width and height of a picture that can be read whole.
fn size_of(path: &Path) -> Result<[u32; 2], &'static str> {
    let bytes = read_regular_file(path, MOST_BYTES, Symlinks::Refused);
    let bytes = bytes.map_err(|_| "it cannot be read")?;
    let size = bytes.get(SIZE_AT).filter(|_| bytes.starts_with(SIGNATURE));
    let size = size.ok_or("it is no PNG file")?;
    let (sides, _) = size.as_chunks();
    let [width, height] = [sides[0], sides[1]].map(u32::from_be_bytes);
    let camera = HeadCamera {
        width,
        height,
        ..HeadCamera::default()
    };
    if camera.fault().is_some() {
        return Err("it is no picture of a size that a recording may have");
    }
    match tabletop_export::Image::decode(&bytes) {
        Ok(_) => Ok([width, height]),
        Err(_) => Err("it is damaged, or has not 8 bits a colour"),
    }
}
