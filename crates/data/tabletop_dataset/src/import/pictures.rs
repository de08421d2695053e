//! The pictures of an imported recording: those that were taken, and drawn ones where they are missing.

use std::collections::{BTreeMap, BTreeSet};

use tabletop_camera::{Camera, DrawnSolid, Rasterizer, Scene};
use tabletop_core::{HeadCamera, Picture, SimTick, Table};
use tabletop_geometry::Pose;
use tabletop_recorder::{RecordedSegment, RecorderError, RecordingWriter, TICKS_PER_FRAME};
use tabletop_storage::InnerFile;
use tabletop_task::Demonstration;

use crate::import::motion::Motions;

/// The frames with pictures.
#[derive(Clone, Debug, Default)]
pub(super) struct PicturePlan {
    recorded: BTreeMap<u64, InnerFile>,
    drawn: BTreeSet<u64>,
    size: Option<[u32; 2]>,
    /// The camera, if it is known.
    camera: Option<HeadCamera>,
}

impl PicturePlan {
    /// The pictures that were taken, and those of frames in which something is elsewhere, which are drawn. The texts say which files are
    /// none of them.
    pub(super) fn of(
        segments: &[RecordedSegment],
        motions: &Motions,
        camera: Option<HeadCamera>,
    ) -> (Self, Vec<String>) {
        let mut plan = Self {
            camera,
            ..Self::default()
        };
        let mut remarks = Vec::new();
        for frame in segments.iter().flat_map(|segment| &segment.frames) {
            let size = size_of(&frame.picture);
            let size = size.and_then(|size| match plan.size {
                Some(first) if first != size => {
                    Err("it has another size than the first one".to_owned())
                }
                Some(_) | None => Ok(size),
            });
            match size {
                Ok(size) => {
                    plan.size = Some(size);
                    plan.recorded.insert(frame.number, frame.picture.clone());
                }
                Err(problem) => remarks.push(format!(
                    "{}: {problem}; the picture is drawn instead",
                    frame.picture.path().display()
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
        let of_original = || HeadCamera {
            square_fov: self.size.is_some(),
            ..HeadCamera::default()
        };
        let camera = self.camera.unwrap_or_else(of_original);
        let [width, height] = self.size.unwrap_or([camera.width, camera.height]);
        HeadCamera {
            width,
            height,
            ..camera
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
        for (&frame, picture) in &self.recorded {
            let png = picture.read(Picture::MOST_FILE_BYTES);
            let png = png.map_err(|source| RecorderError::Read {
                path: picture.path(),
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

/// Columns and rows of a picture that can be read whole.
fn size_of(file: &InnerFile) -> Result<[u32; 2], String> {
    let bytes = file.read(Picture::MOST_FILE_BYTES);
    let bytes = bytes.map_err(|error| error.to_string())?;
    let picture = Picture::from_png(&bytes).map_err(|fault| fault.to_string())?;
    Ok([picture.width, picture.height])
}
