//! Recordings of the original program: events and pictures, and no session log.

use std::{
    collections::BTreeSet,
    fmt,
    path::{Path, PathBuf},
};

use tabletop_core::SimTick;
use tabletop_storage::{Storage, is_taken};

use crate::{
    error::RecorderError,
    files::{
        bounds::{MOST_TICKS, check_location},
        folder::Folder,
        frame::TICKS_PER_FRAME,
        limits::{MOST_EVENT_BYTES, MOST_ORIGINAL_OBJECTS},
    },
    reading::{
        event::{CommaStyle, Occurrence, RecordedEvent, read_lines},
        object_change::ObjectChange,
        recording_reader::read_events,
        segment::{HandContents, RecordedFrame, RecordedSegment},
    },
};

/// The segments of a recording of the original program, or of any that consists of events alone; none if the folder holds another one. Frames
/// count quarters of a second; an act is between the frame before and the one that shows it.
///
/// # Errors
/// A file cannot be read, or a line of it is no event; it is named.
pub fn read_original(
    folder: impl AsRef<Path>,
) -> Result<Option<Vec<RecordedSegment>>, RecorderError> {
    let folder = Folder::existing(folder.as_ref());
    if is_taken(&folder.session()) || !is_taken(&folder.text(0)) {
        return Ok(None);
    }
    let mut segments = Vec::new();
    let mut hands = HandContents::default();
    for number in 0.. {
        let Some(events) = read_events(&folder, number, CommaStyle::Escaped)? else {
            break;
        };
        segments.push(segment(number, events, &mut hands));
    }
    Ok(Some(segments))
}

/// A recording of the original program, or of any that consists of events and pictures, as far as it can be understood.
#[derive(Clone, Debug, Default)]
pub struct OriginalRecording {
    /// Its segments, with their pictures.
    pub segments: Vec<RecordedSegment>,
    /// What was not understood, and what became of it.
    pub remarks: Vec<LineRemark>,
}

/// What is strange about a line of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LineRemark {
    /// The file.
    pub path: PathBuf,
    /// Number of the line, from 1.
    pub line: u64,
    /// What is strange about it, and what it was taken for.
    pub text: String,
}

impl fmt::Display for LineRemark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { path, line, text } = self;
        write!(f, "{}:{line}: {text}", path.display())
    }
}

impl OriginalRecording {
    /// Reads the recording in a folder; none if the folder has no file of events, or holds another recording. Lines that make no sense are
    /// left out, and remarked on.
    ///
    /// # Errors
    /// A file cannot be read, or all of them are too large.
    pub fn read(folder: impl AsRef<Path>) -> Result<Option<Self>, RecorderError> {
        let folder = Folder::existing(folder.as_ref());
        let texts = texts_in(&folder)?;
        if is_taken(&folder.session()) || texts.is_empty() {
            return Ok(None);
        }
        let mut course = OriginalCourse::default();
        let mut hands = HandContents::default();
        let mut segments = Vec::new();
        let mut bytes_left = MOST_EVENT_BYTES;
        for number in texts {
            let path = folder.text(number);
            let bytes = folder.storage().read(&path, bytes_left);
            let bytes = bytes.map_err(RecorderError::read(&path))?;
            bytes_left -= bytes.len() as u64;
            let text = String::from_utf8_lossy(&bytes);
            let events = course.follow(&path, &text);
            let pictures = folder.pictured_frames(number)?.into_iter();
            let frames: BTreeSet<_> = pictures.map(|(frame, _)| frame).collect();
            let is_soon = |frame: &u64| frame.saturating_mul(TICKS_PER_FRAME) <= MOST_TICKS;
            let frames = frames.into_iter().filter(is_soon);
            let frames = frames.map(|frame| RecordedFrame {
                number: frame,
                tick: SimTick(frame.saturating_mul(TICKS_PER_FRAME)),
                picture: folder.picture_file(number, frame),
                hand_pictures: [].into(),
            });
            segments.push(RecordedSegment {
                frames: frames.filter(|frame| frame.picture.is_taken()).collect(),
                ..segment(segments.len() as u32, events, &mut hands)
            });
        }
        Ok(Some(Self {
            segments,
            remarks: course.remarks,
        }))
    }
}

fn segment(number: u32, events: Vec<RecordedEvent>, hands: &mut HandContents) -> RecordedSegment {
    let act = hands.follow(&events);
    let before = events.first().map_or(0, |event| event.frame).checked_sub(1);
    let start = before.map_or(0, |frame| frame.saturating_mul(TICKS_PER_FRAME) + 1);
    RecordedSegment {
        number,
        start: SimTick(start),
        act,
        frames: Vec::new(),
        events,
    }
}

/// The numbers of the files of events in a folder, in order.
fn texts_in(folder: &Folder) -> Result<BTreeSet<u32>, RecorderError> {
    let path = folder.path();
    let entries = Storage::default().entries(path);
    let entries = entries.map_err(RecorderError::read(path))?.into_iter();
    let number = |entry: PathBuf| {
        let name = entry.file_name()?.to_str()?;
        let number: u32 = name.strip_suffix(".txt")?.parse().ok()?;
        (folder.text(number).file_name() == entry.file_name()).then_some(number)
    };
    Ok(entries.filter_map(number).collect())
}

/// The progress through the events of a recording.
#[derive(Debug, Default)]
struct OriginalCourse {
    /// Ids of the objects that are there.
    there: BTreeSet<String>,
    frame: u64,
    remarks: Vec<LineRemark>,
}

impl OriginalCourse {
    /// Follows a file. Returns those of its events that make sense.
    fn follow(&mut self, path: &Path, text: &str) -> Vec<RecordedEvent> {
        let mut events = Vec::new();
        for (line, event) in read_lines(text, CommaStyle::Escaped) {
            let mut remark = |text: String| {
                let path = path.to_owned();
                self.remarks.push(LineRemark { path, line, text });
            };
            let mut event = match event.and_then(|event| {
                check(&event, &self.there)?;
                Ok(event)
            }) {
                Ok(event) => event,
                Err(problem) => {
                    remark(format!("{problem}; the line is left out"));
                    continue;
                }
            };
            if event.frame < self.frame {
                let (is, last) = (event.frame, self.frame);
                remark(format!(
                    "frame {is} comes after frame {last}; it is taken for that one"
                ));
                event.frame = last;
            }
            self.frame = event.frame;
            match event.what.object_change() {
                Some(ObjectChange::Create { id, .. }) => {
                    self.there.insert(id.to_owned());
                }
                Some(ObjectChange::Move { id, .. }) if !self.there.contains(id) => {
                    remark(format!(
                        "{id} was not created before; it is there from here on"
                    ));
                    self.there.insert(id.to_owned());
                    let (id, properties) = (id.to_owned(), Vec::new());
                    events.push(RecordedEvent {
                        frame: event.frame,
                        what: Occurrence::Create { id, properties },
                    });
                }
                Some(ObjectChange::Delete { id }) => {
                    self.there.remove(id);
                }
                Some(ObjectChange::Move { .. }) | None => {}
            }
            events.push(event);
        }
        events
    }
}

/// Says what about an event makes no sense where these objects are.
fn check(event: &RecordedEvent, there: &BTreeSet<String>) -> Result<(), String> {
    let ticks = event.frame.saturating_mul(TICKS_PER_FRAME);
    if ticks > MOST_TICKS {
        return Err(format!("frame {} is after more than 30 days", event.frame));
    }
    if let Occurrence::Create { id, .. } | Occurrence::Move { id, .. } = &event.what
        && there.len() >= MOST_ORIGINAL_OBJECTS
        && !there.contains(id)
    {
        return Err(format!("there are {MOST_ORIGINAL_OBJECTS} objects already"));
    }
    match &event.what {
        Occurrence::Move {
            location, degrees, ..
        } => {
            check_location(*location)?;
            match degrees.is_finite() {
                true => Ok(()),
                false => Err("an angle is no number".into()),
            }
        }
        Occurrence::Delete { id } | Occurrence::Grasp { id, .. } | Occurrence::Grip { id, .. }
            if !there.contains(id) =>
        {
            Err(format!("there is no {id}"))
        }
        Occurrence::Create { .. }
        | Occurrence::Delete { .. }
        | Occurrence::Grasp { .. }
        | Occurrence::Release { .. }
        | Occurrence::Destroy { .. }
        | Occurrence::Grip { .. }
        | Occurrence::LetGo { .. }
        | Occurrence::InitializeControl { .. }
        | Occurrence::ChangeControlState { .. }
        | Occurrence::Trigger { .. }
        | Occurrence::PointTo { .. }
        | Occurrence::Fasten { .. }
        | Occurrence::Loosen { .. }
        | Occurrence::Cut { .. } => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_without_sense_are_left_out_and_told_with_their_places() {
        let text = "0,create,a,shape,block\n\
            0, move, a, 0, 0, 1, 0, 0, 0\n\
            what is this\n\
            4,move,b,1,0,1,0,0,0\n\
            5,move,a,NaN,0,1,0,0,0\n\
            6,grasp,LeftHand,c\n\
            2,move,a,0,0,2,0,0,0\n\
            99999999999,move,a,0,0,2,0,0,0";
        let mut course = OriginalCourse::default();
        let events = course.follow(Path::new("0.txt"), text);
        let frames: Vec<_> = events.iter().map(|event| event.frame).collect();
        assert_eq!(frames, [0, 0, 4, 4, 4]);
        let remarks: Vec<_> = course.remarks.iter().map(ToString::to_string).collect();
        for (line, remark) in [
            (3, "expected a frame"),
            (4, "b was not created before"),
            (5, "is not from -1000000 to 1000000"),
            (6, "there is no c; the line is left out"),
            (7, "frame 2 comes after frame 4"),
            (8, "30 days"),
        ] {
            let place = format!("0.txt:{line}: ");
            let found = remarks.iter().find(|said| said.starts_with(&place));
            assert!(
                found.is_some_and(|said| said.contains(remark)),
                "{remarks:#?}"
            );
        }
        assert_eq!(remarks.len(), 6);
    }
}
