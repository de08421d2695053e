//! Recordings of the original program, turned into recordings of this one. They are not simulated again: objects go straight from frame to
//! frame.

mod act_source;
mod motion;
mod objects;
mod pictures;
mod segments;
mod watched;

pub use act_source::ActSource;
pub use watched::record_watched;

use std::path::Path;

use serde_json::json;
use tabletop_core::{Actor, HeadCamera, SceneCommand, SceneSpec, SimTick};
use tabletop_recorder::{
    IMPORTED, OriginalRecording, RecordedSegment, RecorderError, RecordingReport, RecordingWriter,
    Session, SessionCommand, SessionHeader, SessionObject, SessionScene, TICKS_PER_FRAME,
    write_recording,
};
use tabletop_scene::{IdAllocator, assemble};
use tabletop_task::{Demonstration, Furniture};

use crate::{
    error::DatasetError,
    import::{
        motion::Motions,
        objects::{beginning_scene, plausible},
        pictures::PicturePlan,
        segments::{ImportedSegment, event_of, segments_of},
    },
};

/// The result of an import.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Import {
    /// Number of segments.
    pub segments: usize,
    /// Number of the last frame.
    pub last_frame: u64,
    /// Number of objects.
    pub objects: usize,
    /// Number of pictures that the original program took.
    pub recorded_pictures: usize,
    /// Number of pictures that were drawn from the poses.
    pub drawn_pictures: usize,
    /// Where the acts of the hands come from.
    pub acts: ActSource,
    /// What was not understood or is missing, and what it was taken for.
    pub remarks: Vec<String>,
    /// The recording that was made, and the earlier one that was in its way.
    pub report: RecordingReport,
}

/// Turns the recording of the original program in one folder into a recording of this program in another. The setup is the scene that was on
/// the table; it completes what the recording does not tell of the objects.
///
/// # Errors
/// The folder holds no recording of the original program, or one without objects; or the new recording cannot be written.
pub fn import_recording(
    source: &Path,
    out: &Path,
    setup: Option<&SceneSpec>,
) -> Result<Import, DatasetError> {
    let Some(original) = OriginalRecording::read(source)? else {
        return Err(DatasetError::unfit(source, NO_ORIGINAL));
    };
    let mut remarks: Vec<_> = original.remarks.iter().map(ToString::to_string).collect();
    let furniture = setup.map(furniture).unwrap_or_default();
    let mut shown = Demonstration::of_events(&original.segments, TICKS_PER_FRAME, &furniture);
    remarks.extend(plausible(&mut shown, source));
    if shown.objects.is_empty() {
        return Err(DatasetError::unfit(source, "it has no object with a pose"));
    }
    let imported = Imported {
        acts: acts_of(&original),
        segments: original.segments,
        shown,
        setup,
        from: "the original program",
        camera: None,
    };
    imported.write(out, remarks)
}

const NO_ORIGINAL: &str = "it is no recording of the original program: expected files 0.txt, 1.txt, … of events, and no session.jsonl";

fn furniture(setup: &SceneSpec) -> Furniture {
    let assembly = assemble(setup, &mut IdAllocator::default());
    Furniture {
        objects: assembly.objects,
        joints: assembly.joints,
    }
}

/// What is written as a recording whose commands are not known.
struct Imported<'s> {
    segments: Vec<RecordedSegment>,
    shown: Demonstration,
    setup: Option<&'s SceneSpec>,
    acts: ActSource,
    /// Where it comes from, for the header.
    from: &'static str,
    /// The camera of its pictures; `None` for that of the original program.
    camera: Option<HeadCamera>,
}

impl Imported<'_> {
    fn write(&self, out: &Path, mut remarks: Vec<String>) -> Result<Import, DatasetError> {
        let shown = &self.shown;
        let motions = Motions::of(&self.segments, shown);
        let segments = segments_of(&self.segments, shown, self.acts);
        let table = self.setup.map_or(shown.table, |setup| setup.table);
        let (pictures, missing) = PicturePlan::of(&self.segments, &motions, self.camera);
        remarks.extend(missing);
        let session = self.session(&motions, &pictures);
        let last_frame = motions.last_frame();
        let last_tick = SimTick(last_frame * TICKS_PER_FRAME);
        let report = write_recording(out, &session, last_tick, |writer| {
            write_segments(writer, &segments, shown)?;
            motions.write(writer, last_tick)?;
            pictures.write(writer, &starts(&segments), &motions, shown, &table)
        })?;
        Ok(Import {
            segments: segments.len(),
            last_frame,
            objects: shown.objects.len(),
            recorded_pictures: pictures.recorded(),
            drawn_pictures: pictures.drawn(),
            acts: self.acts,
            remarks,
            report,
        })
    }

    /// The session: the scene, set before its first tick. It begins in no tick, since its commands are not known.
    fn session(&self, motions: &Motions, pictures: &PicturePlan) -> Session {
        let shown = &self.shown;
        let mut header = SessionHeader::new(0);
        header.earlier_commands = 1;
        header.camera = Some(pictures.camera());
        header.settings.insert(
            IMPORTED.into(),
            json!({
                "from": self.from,
                "acts": self.acts.name(),
                "pictures": { "recorded": pictures.recorded(), "drawn": pictures.drawn() },
            }),
        );
        let scene = beginning_scene(shown, motions, self.setup);
        let objects = motions.at_beginning(shown);
        let objects = objects.map(|(object, pose)| {
            let mut spec = object.spec.clone();
            spec.pose = pose;
            SessionObject { pose, spec }
        });
        let objects: Vec<_> = objects.collect();
        let is_there = |id: &String| objects.iter().any(|object| object.spec.id == *id);
        let joints = shown.joints.iter();
        let joints = joints.filter(|joint| joint.objects.iter().all(is_there));
        Session {
            scene: SessionScene {
                table: Some(scene.table),
                joints: joints.cloned().collect(),
                objects,
            },
            header,
            earlier: vec![SessionCommand {
                tick: 0,
                actor: Actor::App,
                command: SceneCommand::Set(Box::new(scene)).into(),
                at_once: false,
            }],
            commands: Vec::new(),
            segments: Vec::new(),
        }
    }
}

fn acts_of(original: &OriginalRecording) -> ActSource {
    let names_hand = original.segments.iter().any(|segment| {
        let mut events = segment.events.iter();
        events.any(|event| segments::is_of_hand(&event.what))
    });
    match names_hand {
        true => ActSource::Recorded,
        false => ActSource::Inferred,
    }
}

fn starts(segments: &[ImportedSegment]) -> Vec<SimTick> {
    segments.iter().map(|segment| segment.start).collect()
}

fn write_segments(
    writer: &mut RecordingWriter<'_>,
    segments: &[ImportedSegment],
    shown: &Demonstration,
) -> Result<(), RecorderError> {
    for (number, segment) in segments.iter().enumerate() {
        if number > 0 {
            writer.begin_segment(segment.start)?;
        }
        let events = segment.events.iter();
        writer.events(events.filter_map(|event| Some((event.frame, event_of(event, shown)?))))?;
    }
    Ok(())
}
