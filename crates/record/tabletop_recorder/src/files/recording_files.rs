//! The files of a running recording, of which undo takes the end away and redo brings it back.

use std::path::Path;

use tabletop_storage::is_taken;

use crate::{
    error::RecorderError,
    files::{
        destination::Destination,
        durability::Durability,
        folder::Folder,
        intent::{Intent, Lengths, finish_interrupted},
        joints,
        json::to_json_line,
        log_file::LogFile,
        new_recording::NewRecording,
        session::{SessionHeader, SessionScene},
        states,
    },
};

/// The files of a running recording.
#[derive(Debug)]
pub(crate) struct RecordingFiles {
    pub(crate) folder: Folder,
    pub(crate) session: LogFile,
    pub(crate) states: LogFile,
    pub(crate) joints: LogFile,
    /// The events of the present segment.
    pub(crate) text: LogFile,
    /// The number of the present segment.
    pub(crate) segment: u32,
    pub(crate) durability: Durability,
}

impl RecordingFiles {
    /// Makes the files of a recording that begins, in a new folder, which is there with all of them or not at all.
    pub(crate) fn create(
        destination: &Destination,
        header: &SessionHeader,
        scene: &SessionScene,
        earlier_commands: &[u8],
    ) -> Result<NewRecording<Self>, RecorderError> {
        let fill = |folder: &Folder| fill(folder, header, scene, earlier_commands);
        let Destination {
            folder: path,
            storage,
            durability,
            ..
        } = destination;
        let new = NewRecording::of(path, storage, fill, |folder, lengths| {
            Self::open(folder, *durability, lengths)
        })?;
        if *durability == Durability::EveryTick {
            new.opened.folder.sync_name()?;
        }
        Ok(new)
    }

    fn open(
        folder: Folder,
        durability: Durability,
        lengths: Lengths,
    ) -> Result<Self, RecorderError> {
        let storage = folder.storage();
        let session = LogFile::reopen(storage, folder.session(), lengths.session)?;
        session.lock();
        Ok(Self {
            session,
            states: LogFile::reopen(storage, folder.states(), lengths.states)?,
            joints: LogFile::reopen(storage, folder.joints(), lengths.joints)?,
            text: LogFile::reopen(storage, folder.text(0), lengths.text)?,
            segment: 0,
            durability,
            folder,
        })
    }

    /// Makes sure that the folder is still in its place: otherwise lines would be written elsewhere.
    pub(crate) fn require_in_place(&self) -> Result<(), RecorderError> {
        match self.session.is_in_place()? {
            true => Ok(()),
            false => Err(RecorderError::Displaced {
                folder: self.folder.path().to_owned(),
            }),
        }
    }

    pub(crate) fn lengths(&self) -> Lengths {
        Lengths {
            segment: self.segment,
            text: self.text.len(),
            session: self.session.len(),
            states: self.states.len(),
            joints: self.joints.len(),
        }
    }

    pub(crate) fn begin_segment(&mut self) -> Result<(), RecorderError> {
        self.require_in_place()?;
        let segment = self.segment + 1;
        self.folder.create_inner(&self.folder.pictures(segment))?;
        self.text = LogFile::create(self.folder.storage(), self.folder.text(segment))?;
        self.segment = segment;
        Ok(())
    }

    /// Puts away the present segment, before which the files had these lengths. The session log goes on with these lines.
    pub(crate) fn put_away(&mut self, before: Lengths, then: &[u8]) -> Result<(), RecorderError> {
        self.require_in_place()?;
        let away = self.folder.undone_segment(self.segment);
        self.folder.create_inner(away.path())?;
        for (log, len, end) in [
            (&mut self.session, before.session, away.session()),
            (&mut self.states, before.states, away.states()),
            (&mut self.joints, before.joints, away.joints()),
        ] {
            let mut kept = LogFile::create(away.storage(), end)?;
            kept.append(&log.read_from(len)?)?;
        }
        let intent = Intent::PutAway {
            segment: self.segment,
            before,
            then: String::from_utf8_lossy(then).into_owned(),
        };
        intent.declare(&self.folder)?;
        intent.fulfil(&self.folder)?;
        self.resume(Lengths {
            session: before.session + then.len() as u64,
            ..before
        })
    }

    /// Brings back the segment that was put away last, before which the files had these lengths, in the place of everything since,
    /// of which this was the first frame.
    pub(crate) fn bring_back(
        &mut self,
        before: Lengths,
        first_frame: u64,
        end: Lengths,
    ) -> Result<(), RecorderError> {
        self.require_in_place()?;
        let segment = end.segment;
        let intent = Intent::BringBack {
            segment,
            before,
            first_frame,
        };
        intent.declare(&self.folder)?;
        intent.fulfil(&self.folder)?;
        self.folder.undone_segment(segment).remove()?;
        self.resume(end)
    }

    /// Goes on where the files have these lengths.
    fn resume(&mut self, at: Lengths) -> Result<(), RecorderError> {
        self.session.cut(at.session)?;
        self.states.cut(at.states)?;
        self.joints.cut(at.joints)?;
        let text = self.folder.text(at.segment);
        self.text = LogFile::reopen(self.folder.storage(), text, at.text)?;
        self.segment = at.segment;
        Ok(())
    }

    /// Removes the files of undone segments for good.
    pub(crate) fn drop_undone(&self) -> Result<(), RecorderError> {
        let dropped = self.folder.dropped();
        dropped.remove()?;
        let undone = self.folder.undone();
        if is_taken(undone.path()) {
            let renamed = self.folder.storage().rename(undone.path(), dropped.path());
            renamed.map_err(RecorderError::write(undone.path()))?;
            dropped.remove()?;
        }
        Ok(())
    }

    /// Writes a picture of the present segment, which under its name is never incomplete.
    pub(crate) fn write_picture(
        &self,
        path: &Path,
        encoded: Result<Vec<u8>, png::EncodingError>,
    ) -> Result<(), RecorderError> {
        let bytes = encoded.map_err(|source| RecorderError::Picture {
            path: path.to_owned(),
            source,
        })?;
        let sync = self.durability == Durability::EveryTick;
        let written = self.folder.storage().write_whole(path, &bytes, sync);
        written.map_err(RecorderError::write(path))
    }

    /// Makes the files of a tick outlive a loss of power, if they are to.
    pub(crate) fn end_tick(&self) -> Result<(), RecorderError> {
        match self.durability {
            Durability::EveryTick => [&self.session, &self.states, &self.joints, &self.text]
                .into_iter()
                .try_for_each(LogFile::sync),
            Durability::None | Durability::AtFinish => Ok(()),
        }
    }

    /// Begins the end of the recording: until [`finish`](Self::finish) has succeeded, everything written is taken back.
    pub(crate) fn begin_end(&self, first_frame: u64, line: &[u8]) -> Result<Intent, RecorderError> {
        self.require_in_place()?;
        let before = self.lengths();
        let intent = Intent::Finish {
            before,
            session: before.session + line.len() as u64,
            first_frame,
        };
        intent.declare(&self.folder)?;
        Ok(intent)
    }

    /// Ends the recording with this line of the session log.
    pub(crate) fn finish(&mut self, line: &[u8], intent: &Intent) -> Result<(), RecorderError> {
        self.sync_all()?;
        self.session.append(line)?;
        self.sync_session()?;
        intent.forget(&self.folder)
    }

    fn sync_all(&self) -> Result<(), RecorderError> {
        match self.durability {
            Durability::None => Ok(()),
            Durability::AtFinish => {
                self.folder.sync()?;
                self.folder.sync_name()
            }
            Durability::EveryTick => self.folder.sync(),
        }
    }

    fn sync_session(&self) -> Result<(), RecorderError> {
        match self.durability {
            Durability::None => Ok(()),
            Durability::AtFinish | Durability::EveryTick => self.session.sync(),
        }
    }

    /// Closes the files of a recording that could not go on, and finishes its interrupted change.
    pub(crate) fn abandon(self) {
        let folder = self.folder.clone();
        drop(self);
        // It is done when the recording is read, then.
        let _ = finish_interrupted(&folder);
    }
}

/// Writes the files of a recording that begins.
fn fill(
    folder: &Folder,
    header: &SessionHeader,
    scene: &SessionScene,
    earlier_commands: &[u8],
) -> Result<Lengths, RecorderError> {
    let storage = folder.storage();
    let mut session = LogFile::create(storage, folder.session())?;
    for line in [to_json_line(header), to_json_line(scene)] {
        let line = line.map_err(|error| RecorderError::write(&folder.session())(error.into()))?;
        session.append(&line)?;
    }
    session.append(earlier_commands)?;
    let mut states = LogFile::create(storage, folder.states())?;
    states.append_records(&[states::header()])?;
    let mut joints = LogFile::create(storage, folder.joints())?;
    joints.append_records(&[joints::header()])?;
    folder.create_inner(&folder.pictures(0))?;
    LogFile::create(storage, folder.text(0))?;
    Ok(Lengths {
        session: session.len(),
        states: states.len(),
        joints: joints.len(),
        ..Lengths::default()
    })
}
