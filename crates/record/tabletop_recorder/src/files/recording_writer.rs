//! Recordings that are written at once, and not tick by tick.

use std::path::Path;

use tabletop_core::{Picture, RecordingCommand, SimTick};
use tabletop_storage::{Storage, parent_of};

use crate::{
    error::RecorderError,
    files::{
        bounds::check_command,
        event::Event,
        folder::Folder,
        joints,
        json::to_json_line,
        limits::MOST_ROW_BYTES,
        log_file::LogFile,
        new_recording::NewRecording,
        picture::color_png,
        segment_mark::SegmentMark,
        session::{Session, SessionCommand, command_line},
        states::{self, ObjectState},
    },
    reading::rows::StateRow,
    recording::report::{MovedAside, RecordingReport},
};

/// A recording that is being written at once: its segments in their order, and of each the events and pictures. States come in the order of
/// their ticks.
#[derive(Debug)]
pub struct RecordingWriter<'f> {
    folder: &'f Folder,
    session: LogFile,
    states: LogFile,
    text: LogFile,
    segment: u32,
}

/// Writes a recording that ends in this tick: header, scene and earlier commands of the session, and what `fill` writes. Its folder appears
/// whole, and on the disk; an earlier recording there is moved aside.
///
/// # Errors
/// Something else is in the folder; a value is none that a recording may hold; or something cannot be written. Then nothing has changed.
pub fn write_recording(
    path: &Path,
    session: &Session,
    last_tick: SimTick,
    fill: impl FnOnce(&mut RecordingWriter<'_>) -> Result<(), RecorderError>,
) -> Result<RecordingReport, RecorderError> {
    check(session).map_err(|problem| RecorderError::Unfit { problem })?;
    let storage = Storage::default();
    let write = |folder: &Folder| {
        let mut writer = RecordingWriter::begin(folder, session)?;
        fill(&mut writer)?;
        let end = SessionCommand::of_app(last_tick, RecordingCommand::Finish);
        writer.session.append(&command_line(&end)?)?;
        folder.sync()
    };
    let new = NewRecording::of(path, &storage, write, |_, ()| Ok(()))?;
    let synced = storage.sync_folder(parent_of(path));
    synced.map_err(RecorderError::write(path))?;
    Ok(RecordingReport {
        moved_aside: new
            .moved_aside
            .map(|to| MovedAside {
                from: path.to_owned(),
                to,
            })
            .into_iter()
            .collect(),
        ..RecordingReport::default()
    })
}

fn check(session: &Session) -> Result<(), String> {
    session.scene.check()?;
    let mut earlier = session.earlier.iter();
    earlier.try_for_each(|earlier| check_command(&earlier.command))
}

impl<'f> RecordingWriter<'f> {
    fn begin(folder: &'f Folder, session: &Session) -> Result<Self, RecorderError> {
        let storage = folder.storage();
        let mut log = LogFile::create(storage, folder.session())?;
        for line in [to_json_line(&session.header), to_json_line(&session.scene)] {
            let line = line.map_err(|error| RecorderError::write(&folder.session())(error.into()));
            log.append(&line?)?;
        }
        for command in &session.earlier {
            log.append(&command_line(command)?)?;
        }
        let mut states = LogFile::create(storage, folder.states())?;
        states.append_records(&[states::header()])?;
        LogFile::create(storage, folder.joints())?.append_records(&[joints::header()])?;
        folder.create_inner(&folder.pictures(0))?;
        Ok(Self {
            session: log,
            states,
            text: LogFile::create(storage, folder.text(0))?,
            segment: 0,
            folder,
        })
    }

    /// Begins the next segment, in this tick.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn begin_segment(&mut self, start: SimTick) -> Result<(), RecorderError> {
        let segment = self.segment + 1;
        self.session.append(&SegmentMark::line(segment, start)?)?;
        self.folder.create_inner(&self.folder.pictures(segment))?;
        self.text = LogFile::create(self.folder.storage(), self.folder.text(segment))?;
        self.segment = segment;
        Ok(())
    }

    /// Writes events of the present segment, each with its frame.
    ///
    /// # Errors
    /// They cannot be written.
    pub fn events<'e>(
        &mut self,
        events: impl IntoIterator<Item = (u64, Event<'e>)>,
    ) -> Result<(), RecorderError> {
        let lines = events.into_iter().map(|(frame, event)| event.fields(frame));
        self.text.append_records(&lines.collect::<Vec<_>>())
    }

    /// Writes states.
    ///
    /// # Errors
    /// They cannot be written, or there are more than a recording may hold.
    pub fn states(&mut self, rows: &[StateRow]) -> Result<(), RecorderError> {
        let rows = rows.iter().map(|row| {
            let (pose, twist) = (row.pose, row.twist);
            states::row(row.tick, &row.id, ObjectState { pose, twist })
        });
        self.states.append_records(&rows.collect::<Vec<_>>())?;
        match self.states.len() > MOST_ROW_BYTES {
            true => Err(RecorderError::Unfit {
                problem: format!("its states have more than {MOST_ROW_BYTES} bytes"),
            }),
            false => Ok(()),
        }
    }

    /// Writes the picture of a frame of a segment that has begun.
    ///
    /// # Errors
    /// It cannot be encoded or written.
    pub fn picture(
        &self,
        segment: u32,
        frame: u64,
        picture: &Picture,
    ) -> Result<(), RecorderError> {
        let path = self.folder.picture(segment, frame);
        let encoded = color_png(picture);
        let bytes = encoded.map_err(|source| RecorderError::Picture {
            path: path.clone(),
            source,
        })?;
        self.encoded_picture(segment, frame, &bytes)
    }

    /// Writes the picture of a frame of a segment that has begun, which is a PNG file already.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn encoded_picture(
        &self,
        segment: u32,
        frame: u64,
        png: &[u8],
    ) -> Result<(), RecorderError> {
        let path = self.folder.picture(segment, frame);
        let written = self.folder.storage().write_whole(&path, png, false);
        written.map_err(RecorderError::write(&path))
    }
}
