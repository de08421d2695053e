//! The file by which an engine that polls learns of requests, and this program of answers.

use std::{
    fs::{self, File, OpenOptions},
    io::{Read as _, Seek as _, SeekFrom, Write as _},
    path::{Path, PathBuf},
};

use crate::error::EngineError;

/// The request to an engine.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Op {
    /// End.
    End,
    /// Say who you are.
    Hello,
    /// Run the init script.
    Init,
    /// Run the callback script.
    Step,
}

impl Op {
    /// Its name in lines.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::End => "end",
            Self::Hello => "hello",
            Self::Init => "init",
            Self::Step => "step",
        }
    }
}

/// The files by which this program and a polling engine exchange requests and their ends.
#[derive(Debug)]
pub(crate) struct TriggerFile {
    path: PathBuf,
    trigger: File,
    done: File,
    words: [u32; 4],
}

impl TriggerFile {
    /// Makes the files, with nothing to do.
    pub(crate) fn create(folder: &Path) -> Result<Self, EngineError> {
        let path = folder.join("trigger.bin");
        let fault = |error| EngineError::file(&path, &error);
        let done = folder.join("done.bin");
        fs::write(&done, [0; 8]).map_err(fault)?;
        let done = File::open(done).map_err(fault)?;
        let mut options = OpenOptions::new();
        let trigger = options
            .write(true)
            .create(true)
            .truncate(true)
            .open(&path)
            .map_err(fault)?;
        Ok(Self {
            trigger,
            done,
            words: [0; 4],
            path,
        })
    }

    /// Asks for something.
    pub(crate) fn request(&mut self, seq: u32, op: Op, draw: bool) -> Result<(), EngineError> {
        let op = match op {
            Op::End => 0,
            Op::Hello => 1,
            Op::Init => 2,
            Op::Step => 3,
        };
        let [.., beat] = self.words;
        self.words = [seq, op, u32::from(draw), beat.wrapping_add(1)];
        self.write()
    }

    /// Shows that this program is alive.
    pub(crate) fn beat(&mut self) {
        let [.., beat] = &mut self.words;
        *beat = beat.wrapping_add(1);
        // If the file is gone, the next request reports it.
        drop(self.write());
    }

    /// Writes the file in place. A reader that sees half of it sees that the sum is wrong.
    fn write(&mut self) -> Result<(), EngineError> {
        let sum = self
            .words
            .iter()
            .fold(0u32, |sum, word| sum.wrapping_add(*word));
        let bytes: Vec<_> = self
            .words
            .iter()
            .chain([&sum])
            .flat_map(|word| word.to_le_bytes())
            .collect();
        self.trigger
            .seek(SeekFrom::Start(0))
            .and_then(|_| self.trigger.write_all(&bytes))
            .map_err(|error| EngineError::file(&self.path, &error))
    }

    /// True if the engine has done a request.
    pub(crate) fn is_done(&mut self, seq: u32) -> bool {
        let mut words = [0; 8];
        let read = self
            .done
            .seek(SeekFrom::Start(0))
            .and_then(|_| self.done.read_exact(&mut words));
        let [a, b, c, d, e, f, g, h] = words;
        read.is_ok() && [[a, b, c, d], [e, f, g, h]].map(u32::from_le_bytes) == [seq, seq]
    }
}
