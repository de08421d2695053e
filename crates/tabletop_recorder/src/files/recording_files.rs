//! The files of a running recording, of which undo takes the end away and redo brings it back.

use crate::{
    error::RecorderError,
    files::{
        folder::{Folder, create_folder},
        joints,
        log_file::LogFile,
        session::{SessionHeader, SessionScene, session_line},
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
}

/// How long the files of a recording were.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lengths {
    pub(crate) segment: u32,
    pub(crate) text: u64,
    pub(crate) session: u64,
    pub(crate) states: u64,
    pub(crate) joints: u64,
}

impl RecordingFiles {
    /// Makes the files of a recording that begins, in a new folder.
    pub(crate) fn create(
        folder: Folder,
        header: &SessionHeader,
        scene: &SessionScene,
        earlier_commands: &[u8],
    ) -> Result<Self, RecorderError> {
        let mut session = LogFile::create(folder.session())?;
        session.lock();
        for line in [session_line(header), session_line(scene)] {
            let line =
                line.map_err(|error| RecorderError::write(&folder.session())(error.into()))?;
            session.append(&line)?;
        }
        session.append(earlier_commands)?;
        let mut states = LogFile::create(folder.states())?;
        states.append_records(&[states::header()])?;
        let mut joints = LogFile::create(folder.joints())?;
        joints.append_records(&[joints::header()])?;
        create_folder(&folder.pictures(0))?;
        let text = LogFile::create(folder.text(0))?;
        Ok(Self {
            folder,
            session,
            states,
            joints,
            text,
            segment: 0,
        })
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
        let segment = self.segment + 1;
        create_folder(&self.folder.pictures(segment))?;
        self.text = LogFile::create(self.folder.text(segment))?;
        self.segment = segment;
        Ok(())
    }

    /// Puts away the present segment, before which the files had these lengths. The session log goes on with these lines.
    pub(crate) fn put_away(&mut self, before: Lengths, then: &[u8]) -> Result<(), RecorderError> {
        let away = self.folder.undone_segment(self.segment);
        create_folder(away.path())?;
        self.session.cut_to_file(before.session, away.session())?;
        self.states.cut_to_file(before.states, away.states())?;
        self.joints.cut_to_file(before.joints, away.joints())?;
        self.folder.move_segment(self.segment, &away)?;
        self.session.append(then)?;
        self.resume(before)
    }

    /// Brings back the segment that was put away last, before which the files had these lengths, in the place of everything since,
    /// of which this was the first frame.
    pub(crate) fn bring_back(
        &mut self,
        before: Lengths,
        first_frame: u64,
        end: Lengths,
    ) -> Result<(), RecorderError> {
        let away = self.folder.undone_segment(end.segment);
        self.folder.remove_pictures(before.segment, first_frame)?;
        self.text.cut(before.text)?;
        self.session.cut(before.session)?;
        self.session.append_file(&away.session())?;
        self.states.cut(before.states)?;
        self.states.append_file(&away.states())?;
        self.joints.cut(before.joints)?;
        self.joints.append_file(&away.joints())?;
        away.move_segment(end.segment, &self.folder)?;
        away.remove()?;
        self.resume(end)
    }

    fn resume(&mut self, at: Lengths) -> Result<(), RecorderError> {
        self.text = LogFile::reopen(self.folder.text(at.segment), at.text)?;
        self.segment = at.segment;
        Ok(())
    }

    /// Removes for good what was put away.
    pub(crate) fn drop_undone(&self) -> Result<(), RecorderError> {
        self.folder.undone().remove()
    }
}
