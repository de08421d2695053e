//! Demonstrations that were watched, as recordings.

use std::{collections::BTreeMap, path::Path};

use tabletop_core::{HeadCamera, SimTick};
use tabletop_recorder::{
    Occurrence, RecordedEvent, RecordedFrame, RecordedSegment, TICKS_PER_FRAME,
};
use tabletop_storage::InnerFile;
use tabletop_task::Demonstration;

use super::{ActSource, Import, Imported};
use crate::error::DatasetError;

/// Writes a demonstration that was understood from pictures as a recording: its objects where they were seen, the acts of a hand that explain their
/// motions, and the pictures of these ticks by their camera. Of pictures that come faster than frames, the last one of each is kept.
///
/// # Errors
/// It has no object, or the recording cannot be written.
pub fn record_watched(
    out: &Path,
    shown: &Demonstration,
    pictures: &[(SimTick, InnerFile)],
    camera: HeadCamera,
) -> Result<Import, DatasetError> {
    if shown.objects.is_empty() {
        return Err(DatasetError::unfit(out, "no object was seen"));
    }
    let numbered = pictures.iter().map(|(tick, picture)| {
        let number = tick.0.div_ceil(TICKS_PER_FRAME);
        (number, picture.clone())
    });
    let frames: BTreeMap<_, _> = numbered.collect();
    let frames = frames.into_iter().map(|(number, picture)| RecordedFrame {
        number,
        tick: SimTick(number * TICKS_PER_FRAME),
        picture,
        hand_pictures: BTreeMap::new(),
    });
    let segment = RecordedSegment {
        number: 0,
        start: SimTick(0),
        act: None,
        events: events(shown),
        frames: frames.collect(),
    };
    let imported = Imported {
        segments: vec![segment],
        shown: shown.clone(),
        setup: None,
        acts: ActSource::Inferred,
        from: "pictures",
        camera: Some(camera),
    };
    imported.write(out, Vec::new())
}

/// Each object as it is there at first, and each of its motions.
fn events(shown: &Demonstration) -> Vec<RecordedEvent> {
    let created = shown.objects.iter().map(|object| Occurrence::Create {
        id: object.spec.id.clone(),
        properties: Vec::new(),
    });
    let mut events: Vec<_> = created
        .map(|what| RecordedEvent { frame: 0, what })
        .collect();
    let mut last = vec![None; shown.objects.len()];
    for frame in 0..=shown.end.0.div_ceil(TICKS_PER_FRAME) {
        for (object, last) in shown.objects.iter().zip(&mut last) {
            let pose = object.track.at(SimTick(frame * TICKS_PER_FRAME));
            if let Some(pose) = pose.filter(|pose| *last != Some(*pose)) {
                *last = Some(pose);
                let what = Occurrence::Move {
                    id: object.spec.id.clone(),
                    location: pose.location,
                    degrees: pose.degrees(),
                };
                events.push(RecordedEvent { frame, what });
            }
        }
    }
    events
}
