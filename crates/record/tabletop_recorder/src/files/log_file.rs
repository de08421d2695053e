//! Files that only ever end with a whole line.

use std::{
    io,
    path::{Path, PathBuf},
};

use tabletop_storage::{Storage, StoredFile};

use crate::error::RecorderError;

/// A file that grows by whole lines. An appended line is with the operating system when the call returns, so it outlives
/// the program; a line that cannot be appended whole is not in the file.
#[derive(Debug)]
pub(crate) struct LogFile {
    path: PathBuf,
    file: StoredFile,
    len: u64,
}

impl LogFile {
    pub(crate) fn create(storage: &Storage, path: PathBuf) -> Result<Self, RecorderError> {
        let file = storage
            .create(&path)
            .map_err(RecorderError::create(&path))?;
        Ok(Self { path, file, len: 0 })
    }

    /// Opens a file of which the first `len` bytes are kept.
    pub(crate) fn reopen(
        storage: &Storage,
        path: PathBuf,
        len: u64,
    ) -> Result<Self, RecorderError> {
        let file = storage.open(&path).map_err(RecorderError::write(&path))?;
        let mut log = Self { path, file, len };
        log.cut(len)?;
        Ok(log)
    }

    /// Lets other programs know that it is being written, as long as this is there.
    pub(crate) fn lock(&self) {
        // Nobody else can have it: who starts a recording keeps the others off the folder.
        let _is_free = self.file.try_lock();
    }

    /// True if the file is still at its path.
    pub(crate) fn is_in_place(&self) -> Result<bool, RecorderError> {
        let found = self.file.is_at(&self.path);
        found.map_err(RecorderError::read(&self.path))
    }

    pub(crate) fn len(&self) -> u64 {
        self.len
    }

    /// Appends lines, each with its line end.
    pub(crate) fn append(&mut self, lines: &[u8]) -> Result<(), RecorderError> {
        if lines.is_empty() {
            return Ok(());
        }
        if let Err(error) = self.file.append(lines) {
            // Should that fail, too, the first error says why.
            let _cut = self.file.cut(self.len);
            return Err(RecorderError::write(&self.path)(error));
        }
        self.len += lines.len() as u64;
        Ok(())
    }

    /// Appends records as comma-separated values, quoted where they need it.
    pub(crate) fn append_records(&mut self, records: &[Vec<String>]) -> Result<(), RecorderError> {
        if records.is_empty() {
            return Ok(());
        }
        let lines = csv_lines(records).map_err(RecorderError::write(&self.path))?;
        self.append(&lines)
    }

    /// Keeps the first `len` bytes.
    pub(crate) fn cut(&mut self, len: u64) -> Result<(), RecorderError> {
        self.file
            .cut(len)
            .map_err(RecorderError::write(&self.path))?;
        self.len = len;
        Ok(())
    }

    /// The bytes after the first `len`.
    pub(crate) fn read_from(&mut self, len: u64) -> Result<Vec<u8>, RecorderError> {
        let rest = self.file.read_from(len, u64::MAX);
        rest.map_err(RecorderError::read(&self.path))
    }

    /// Makes the appended bytes outlive a loss of power.
    pub(crate) fn sync(&self) -> Result<(), RecorderError> {
        self.file.sync().map_err(RecorderError::write(&self.path))
    }
}

fn csv_lines(records: &[Vec<String>]) -> io::Result<Vec<u8>> {
    let mut lines = csv::WriterBuilder::new()
        .flexible(true)
        .from_writer(Vec::new());
    for record in records {
        lines.write_record(record)?;
    }
    lines.into_inner().map_err(csv::IntoInnerError::into_error)
}

/// The content of a recording's file up to its last line end: a kill in the middle of a write may leave half a line.
pub fn whole_lines(bytes: &[u8]) -> &[u8] {
    let end = bytes.iter().rposition(|&byte| byte == b'\n');
    end.and_then(|end| bytes.get(..=end)).unwrap_or_default()
}

/// The text of a file, which is refused if it has more bytes than this, up to its last line end.
pub(crate) fn read_whole_lines(path: &Path, most_bytes: u64) -> Result<String, RecorderError> {
    let read = Storage::default().read(path, most_bytes);
    let mut bytes = read.map_err(RecorderError::read(path))?;
    bytes.truncate(whole_lines(&bytes).len());
    String::from_utf8(bytes).map_err(|error| {
        RecorderError::read(path)(io::Error::new(
            io::ErrorKind::InvalidData,
            error.utf8_error(),
        ))
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn only_values_that_need_it_are_quoted() {
        let record = [
            "0",
            "create",
            "a b#1",
            "1,5",
            "say \"hi\"",
            "two\nlines",
            "",
        ];
        let lines = csv_lines(&[record.map(str::to_owned).to_vec()]).unwrap();
        assert_eq!(
            String::from_utf8(lines).unwrap(),
            "0,create,a b#1,\"1,5\",\"say \"\"hi\"\"\",\"two\nlines\",\n"
        );
    }

    proptest! {
        #[test]
        fn any_values_come_back(records in prop::collection::vec(prop::collection::vec(any::<String>(), 2..6), 1..5)) {
            let lines = csv_lines(&records).unwrap();
            let mut reader = csv::ReaderBuilder::new()
                .has_headers(false)
                .flexible(true)
                .from_reader(&lines[..]);
            let read: Vec<Vec<String>> = reader
                .records()
                .map(|record| record.unwrap().iter().map(str::to_owned).collect())
                .collect();
            prop_assert_eq!(read, records);
        }
    }
}
