//! A recording in its folder, read.

use std::{
    collections::{BTreeMap, BTreeSet},
    path::{Path, PathBuf},
};

use tabletop_core::{JointName, JointState, SimTick, Timeline, TimelinePicture, TimelineStage};
use tabletop_storage::{InnerFile, Storage, is_taken};

use crate::{
    error::RecorderError,
    files::{
        bounds::check_ticks,
        folder::Folder,
        intent::finish_interrupted,
        limits::{MOST_EVENT_BYTES, MOST_SESSION_BYTES},
        log_file::read_whole_lines,
        segment_mark::SegmentMark,
        session::{Session, SessionHeader},
    },
    reading::{
        event::{self, CommaStyle, RecordedEvent},
        rows::{self, JointRow, StateRow},
        segment::{self, HandContents, RecordedFrame, RecordedSegment},
    },
};

/// Makes sure that a folder is a recording of this program.
fn require_session(folder: &Folder) -> Result<(), RecorderError> {
    if is_taken(&folder.session()) {
        return Ok(());
    }
    let found = if !is_taken(folder.path()) {
        "there is no such folder".into()
    } else if is_taken(&folder.text(0)) {
        "it is a recording of the original program, which tells its events alone; `tabletop import` makes one of this program of it".into()
    } else if let Some(inner) = recording_within(folder.path()) {
        let inner = inner.display();
        format!("it is a folder of recordings; name one of them, such as {inner}")
    } else {
        "it is no recording: there is no session.jsonl in it; name the folder of a recording".into()
    };
    Err(RecorderError::NotThere {
        folder: folder.path().to_owned(),
        found,
    })
}

/// The first recording in a folder, by name.
fn recording_within(folder: &Path) -> Option<PathBuf> {
    let entries = Storage::default().entries(folder).ok()?;
    entries
        .into_iter()
        .find(|inner| is_taken(&Folder::existing(inner).session()))
}

/// A recording in its folder, to be read. Lines that a truncated recording lacks are no error.
///
/// ```
/// # use bevy::prelude::*;
/// # use tabletop_core::prelude::*;
/// # use tabletop_recorder::RecorderPlugin;
/// # let folder = std::env::temp_dir().join(format!("tabletop_reading_{}", std::process::id()));
/// # let recorder = RecorderPlugin { folder: folder.clone(), ..default() };
/// # let mut app = App::new();
/// # app.add_plugins((MinimalPlugins, CorePlugin::default(), recorder)).start();
/// # let shape = Shape::Sphere { radius: 0.5, color: Rgb::GRAY };
/// # let ball = ObjectSpec::new("ball", Pose::IDENTITY, 1.0, shape);
/// # let entity = app.world_mut().spawn(ball).id();
/// # app.world_mut().resource_mut::<ObjectIndex>().insert("ball", entity);
/// # app.world_mut().write_command(RecordingCommand::Start);
/// # app.step(60);
/// # app.world_mut().write_command(RecordingCommand::Finish);
/// # app.step(1);
/// use tabletop_recorder::{Occurrence, RecordingReader};
///
/// let recording = RecordingReader::open(&folder)?;
/// assert_eq!(recording.header().ticks_per_second, 60);
/// assert_eq!(recording.first_tick().0, 0);
/// assert_eq!(recording.last_tick().0, 60);
/// for segment in recording.segments()? {
///     for event in &segment.events {
///         if let Occurrence::Move { id, location, .. } = &event.what {
///             println!("frame {}: {id} is at {location}", event.frame);
///         }
///     }
///     for frame in &segment.frames {
///         println!("tick {}: {}", frame.tick.0, frame.picture.path().display());
///     }
/// }
/// let states = recording.states_at(recording.last_tick())?;
/// println!("In the end the ball is at {}.", states["ball"].pose.location);
/// # std::fs::remove_dir_all(folder)?;
/// # Ok::<_, Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct RecordingReader {
    folder: Folder,
    session: Session,
    last_tick: SimTick,
}

impl RecordingReader {
    /// Opens the recording in a folder. If the program that made it was killed while it was undoing something, that is finished first.
    ///
    /// # Errors
    /// The folder has no session log, or one that no recorder has written; or an interrupted change cannot be finished.
    pub fn open(folder: impl AsRef<Path>) -> Result<Self, RecorderError> {
        let folder = Folder::existing(folder.as_ref());
        finish_interrupted(&folder)?;
        require_session(&folder)?;
        let session = Session::read(folder.session())?;
        let end = session.commands.last().filter(|_| session.is_finished());
        let last_tick = match end {
            Some(end) => SimTick(end.tick),
            None => session.last_tick(folder.path())?,
        };
        let header = &session.header;
        let begin = header.begin_tick.unwrap_or(header.start_tick);
        check_ticks(begin, last_tick.0).map_err(|problem| RecorderError::Files {
            folder: folder.path().to_owned(),
            problem,
        })?;
        Ok(Self {
            folder,
            session,
            last_tick,
        })
    }

    /// The recording's folder.
    pub fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// The session log: the commands, the scene at the beginning, the settings.
    pub fn session(&self) -> &Session {
        &self.session
    }

    /// The header: the program that wrote the recording, and the settings.
    pub fn header(&self) -> &SessionHeader {
        &self.session.header
    }

    /// Columns and rows of the pictures of a camera, `head` or a hand camera's name, if it is one of the recording.
    pub fn picture_size(&self, camera: &str) -> Option<[u32; 2]> {
        let head = self.header().camera.filter(|_| camera == "head");
        let hand = self.header().hand_cameras.iter();
        let hand = hand.clone().find(|hand| hand.name == camera);
        head.map(|head| [head.width, head.height])
            .or_else(|| hand.map(|hand| [hand.width, hand.height]))
    }

    /// The first recorded tick.
    pub fn first_tick(&self) -> SimTick {
        SimTick(self.session.header.start_tick)
    }

    /// The last recorded tick, as far as the files go.
    pub fn last_tick(&self) -> SimTick {
        self.last_tick
    }

    /// The tick in which the recording was cut off, if it was: the program was killed, or its disk was full.
    pub fn cut_off_at(&self) -> Option<SimTick> {
        (!self.session.is_finished()).then_some(self.last_tick)
    }

    /// True if a program is still making it.
    pub fn is_being_made(&self) -> bool {
        let session = self.folder.storage().open_to_read(&self.folder.session());
        session.is_ok_and(|session| session.is_locked_by_other())
    }

    /// The segments in their order.
    ///
    /// # Errors
    /// A file cannot be read, or a line of it is none that a recorder writes; it is named.
    pub fn segments(&self) -> Result<Vec<RecordedSegment>, RecorderError> {
        let mut segments = Vec::new();
        let mut hands = HandContents::default();
        for number in 0.. {
            let Some(events) = read_events(&self.folder, number, CommaStyle::Quoted)? else {
                break;
            };
            let act = hands.follow(&events);
            let start = match number.checked_sub(1) {
                None => self.first_tick(),
                // The mark of the last one may be lost with the power.
                Some(mark) => {
                    *(self.session.segments.get(mark as usize)).unwrap_or(&self.last_tick)
                }
            };
            segments.push(RecordedSegment {
                number,
                start,
                act: act.filter(|_| number > 0),
                frames: self.frames(&self.folder, number)?,
                events,
            });
        }
        Ok(segments)
    }

    /// The segments that were undone when the recording was cut off, and could still have been redone, in their order. A recording
    /// that was finished has none.
    ///
    /// # Errors
    /// As for [`segments`](Self::segments).
    pub fn undone(&self) -> Result<Vec<RecordedSegment>, RecorderError> {
        let mut segments = Vec::new();
        let mut hands = HandContents::default();
        let mut next = 0;
        while let Some(events) = read_events(&self.folder, next, CommaStyle::Quoted)? {
            hands.follow(&events);
            next += 1;
        }
        for number in next.. {
            if !is_taken(self.folder.undone_segment(number).path()) {
                break;
            }
            let folder = self.folder.require_undone_segment(number)?;
            let Some(events) = read_events(&folder, number, CommaStyle::Quoted)? else {
                break;
            };
            let log = read_whole_lines(&folder.session(), MOST_SESSION_BYTES)?;
            segments.push(RecordedSegment {
                number,
                start: SegmentMark::find(&log, number).unwrap_or(self.last_tick),
                act: hands.follow(&events),
                frames: self.frames(&folder, number)?,
                events,
            });
        }
        Ok(segments)
    }

    /// The frames of a segment that have pictures.
    fn frames(&self, folder: &Folder, segment: u32) -> Result<Vec<RecordedFrame>, RecorderError> {
        let numbers: BTreeSet<_> = folder
            .pictured_frames(segment)?
            .into_iter()
            .map(|(number, _)| number)
            .collect();
        let frames = numbers.into_iter().map(|number| RecordedFrame {
            number,
            tick: self.tick_of_frame(number),
            picture: folder.picture_file(segment, number),
            hand_pictures: self.hand_pictures(folder, segment, number),
        });
        Ok(frames.filter(|frame| frame.picture.is_taken()).collect())
    }

    /// The pictures of the hand cameras at a frame, by their names.
    fn hand_pictures(
        &self,
        folder: &Folder,
        segment: u32,
        frame: u64,
    ) -> BTreeMap<String, InnerFile> {
        let cameras = self.header().hand_cameras.iter();
        let pictures = cameras.filter_map(|camera| {
            let picture = folder.channel(segment, frame, &camera.name).ok()?;
            Some((camera.name.clone(), picture))
        });
        pictures.filter(|(_, picture)| picture.is_taken()).collect()
    }

    /// The tick that a frame shows the end of.
    fn tick_of_frame(&self, frame: u64) -> SimTick {
        let header = &self.session.header;
        let ticks = frame.saturating_mul(header.ticks_per_frame);
        SimTick(header.start_tick.saturating_add(ticks)).min(self.last_tick)
    }

    /// Every row of the states, in the file's order: for every tick those objects that have moved in it.
    ///
    /// # Errors
    /// The file cannot be read, or a line of it is none that a recorder writes; it is named.
    pub fn states(&self) -> Result<Vec<StateRow>, RecorderError> {
        rows::states(&self.folder.states())
    }

    /// Pose and velocity of every object at the end of a tick, by id. Deleted objects are included with their last
    /// state.
    pub fn states_at(&self, tick: SimTick) -> Result<BTreeMap<String, StateRow>, RecorderError> {
        let rows = self.states()?.into_iter();
        let until = rows.take_while(|row| row.tick <= tick);
        Ok(until.map(|row| (row.id.clone(), row)).collect())
    }

    /// Every row of the joints, in the file's order: for every tick those joints that have moved in it.
    ///
    /// # Errors
    /// The file cannot be read, or a line of it is none that a recorder writes; it is named.
    pub fn joints(&self) -> Result<Vec<JointRow>, RecorderError> {
        rows::joints(&self.folder.joints())
    }

    /// The state of every joint of the robot at the end of a tick, in the order of its [layout](tabletop_core::RobotLayout).
    ///
    /// # Errors
    /// As for [`joints`](Self::joints).
    pub fn joints_at(&self, tick: SimTick) -> Result<Vec<(JointName, JointState)>, RecorderError> {
        let mut joints: Vec<(JointName, JointState)> = Vec::new();
        let rows = self.joints()?.into_iter();
        for row in rows.take_while(|row| row.tick <= tick) {
            match joints.iter_mut().find(|(name, _)| *name == row.joint) {
                Some((_, state)) => *state = row.state,
                None => joints.push((row.joint, row.state)),
            }
        }
        Ok(joints)
    }

    /// The timeline: the events along its time.
    ///
    /// # Errors
    /// As for [`segments`](Self::segments).
    pub fn timeline(&self) -> Result<Timeline, RecorderError> {
        let segments = self.segments()?;
        let colors = segment::colors(&segments);
        let pictures = segments.iter().flat_map(|segment| &segment.frames);
        Ok(Timeline {
            stage: TimelineStage::Open,
            folder: self.folder().to_owned(),
            start: self.first_tick(),
            end: self.last_tick,
            pictures: pictures
                .enumerate()
                .map(|(serial, frame)| TimelinePicture {
                    serial,
                    tick: frame.tick,
                    path: frame.picture.path(),
                })
                .collect(),
            segments: segments
                .iter()
                .map(|segment| segment.on_timeline(&colors))
                .collect(),
            grips: Vec::new(),
        })
    }
}

/// The events of a segment, if there is one of this number.
pub(super) fn read_events(
    folder: &Folder,
    segment: u32,
    commas: CommaStyle,
) -> Result<Option<Vec<RecordedEvent>>, RecorderError> {
    let path = folder.text(segment);
    if !is_taken(&path) {
        return Ok(None);
    }
    let text = read_whole_lines(&path, MOST_EVENT_BYTES)?;
    event::read(&path, &text, commas).map(Some)
}
