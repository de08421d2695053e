//! Exchanges with served policies in files: what was asked and what was answered, so that a run can be repeated without the server.

use std::{
    collections::{BTreeMap, VecDeque},
    fs::File,
    io::{self, BufReader, Read},
    path::{Path, PathBuf},
    sync::{Mutex, PoisonError},
};

use tabletop_storage::{Storage, StoredFile, Symlinks, open_regular_file};

use crate::{
    decode::decode,
    encode::encode,
    error::WireError,
    stream::MOST_BYTES,
    value::{WireMap, WireValue},
};

/// The first bytes of such a file. Frames follow, each after its length, a whole number of four bytes, the lowest first: the server's metadata, and then
/// observations and answers in turn.
const BEGINNING: &[u8] = b"tabletop exchanges 1\n";
/// Bytes of a frame's length.
const LENGTH: usize = 4;

/// A file that exchanges are written into.
#[derive(Debug)]
pub struct ExchangeFile {
    path: PathBuf,
    file: StoredFile,
}

impl ExchangeFile {
    /// A new file, for exchanges with a server that says this of itself.
    ///
    /// # Errors
    /// Something is there, or it cannot be written.
    pub fn create(path: &Path, metadata: &WireMap) -> Result<Self, WireError> {
        let begin = || {
            let mut file = Storage::default().create(path)?;
            file.append(&[BEGINNING, &record(metadata)].concat())?;
            Ok(file)
        };
        let path = path.to_owned();
        match begin() {
            Ok(file) => Ok(Self { path, file }),
            Err(source) => Err(WireError::File { path, source }),
        }
    }

    /// Writes an exchange.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn note(&mut self, observation: &WireMap, answer: &WireMap) -> Result<(), WireError> {
        let both = [record(observation), record(answer)].concat();
        let path = self.path.clone();
        let noted = self.file.append(&both);
        noted.map_err(|source| WireError::File { path, source })
    }
}

/// A frame after its length.
fn record(map: &WireMap) -> Vec<u8> {
    let frame = encode(map);
    // A frame that was sent or received is not longer than `MOST_BYTES`.
    [&(frame.len() as u32).to_le_bytes()[..], &frame].concat()
}

/// The length and the hash of an observation, which tell it from others.
type ObservationKey = (usize, u64);

/// The answers of a served policy that were recorded.
#[derive(Debug)]
pub struct RecordedExchanges {
    path: PathBuf,
    metadata: WireMap,
    answers: Mutex<BTreeMap<ObservationKey, VecDeque<WireMap>>>,
}

impl RecordedExchanges {
    /// True of a file that begins as one with exchanges.
    pub fn are_in(path: &Path) -> bool {
        let mut first = [0; BEGINNING.len()];
        let read = open_regular_file(path, Symlinks::Followed)
            .and_then(|mut file| file.read_exact(&mut first));
        read.is_ok() && first == BEGINNING
    }

    /// Reads a file. An exchange at its end that is not whole, which a killed run may have left, is left out.
    ///
    /// # Errors
    /// It cannot be read, or makes no sense.
    pub fn read(path: &Path) -> Result<Self, WireError> {
        let failure = |source| WireError::File {
            path: path.to_owned(),
            source,
        };
        let file = open_regular_file(path, Symlinks::Followed).map_err(failure)?;
        let mut file = BufReader::new(file);
        let mut first = [0; BEGINNING.len()];
        let is_one = file.read_exact(&mut first).is_ok() && first == BEGINNING;
        let nonsense = |fault: &str| failure(io::Error::new(io::ErrorKind::InvalidData, fault));
        if !is_one {
            return Err(nonsense("it holds no exchanges with a policy"));
        }
        let map = |frame: &[u8]| match decode(frame) {
            Ok(WireValue::Map(map)) => Ok(map),
            Ok(other) => Err(nonsense(&format!("a frame is {}", other.kind()))),
            Err(fault) => Err(nonsense(&fault.to_string())),
        };
        let metadata = next_frame(&mut file).map_err(failure)?;
        let metadata = metadata.ok_or_else(|| nonsense("it ends before the metadata"))?;
        let metadata = map(&metadata)?;
        let mut answers = BTreeMap::<_, VecDeque<_>>::new();
        while let Some(observation) = next_frame(&mut file).map_err(failure)?
            && let Some(answer) = next_frame(&mut file).map_err(failure)?
        {
            let answers = answers.entry(key_of(&observation)).or_default();
            answers.push_back(map(&answer)?);
        }
        Ok(Self {
            path: path.to_owned(),
            metadata,
            answers: Mutex::new(answers),
        })
    }

    /// What the server said of itself.
    pub const fn metadata(&self) -> &WireMap {
        &self.metadata
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The answer to an observation: of several to the same one the next, and the last for ever.
    ///
    /// # Errors
    /// That was never asked.
    pub fn answer(&self, observation: &WireMap) -> Result<WireMap, WireError> {
        let mut answers = self.answers.lock().unwrap_or_else(PoisonError::into_inner);
        let own = answers.get_mut(&key_of(&encode(observation)));
        let next = own.and_then(|own| match own.len() {
            0 | 1 => own.front().cloned(),
            _ => own.pop_front(),
        });
        next.ok_or_else(|| WireError::Unrecorded {
            path: self.path.clone(),
        })
    }
}

/// The next frame; `None` at the end, or if it is not whole.
fn next_frame(file: &mut BufReader<File>) -> io::Result<Option<Vec<u8>>> {
    let mut length = [0; LENGTH];
    if !is_filled(file, &mut length)? {
        return Ok(None);
    }
    let length = u32::from_le_bytes(length) as usize;
    if length > MOST_BYTES {
        let fault = format!("a frame of {length} bytes, expected at most {MOST_BYTES}");
        return Err(io::Error::new(io::ErrorKind::InvalidData, fault));
    }
    let mut frame = vec![0; length];
    Ok(is_filled(file, &mut frame)?.then_some(frame))
}

/// Fills a buffer; false if the file ends before.
fn is_filled(file: &mut BufReader<File>, bytes: &mut [u8]) -> io::Result<bool> {
    match file.read_exact(bytes) {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => Ok(false),
        Err(error) => Err(error),
    }
}

/// The length and the FNV-1a hash of a frame.
fn key_of(frame: &[u8]) -> ObservationKey {
    let hash = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x100_0000_01b3);
    (frame.len(), frame.iter().fold(0xcbf2_9ce4_8422_2325, hash))
}

#[cfg(test)]
mod tests {
    use std::fs;

    use tabletop_storage::TemporaryFolder;

    use super::*;
    use crate::array::NumpyArray;

    fn map(key: &str, number: u8) -> WireMap {
        let array = NumpyArray::of_bytes(&[2], vec![number; 2]);
        WireMap::from([(key.to_owned(), array.into())])
    }

    #[test]
    fn what_was_asked_is_answered_again() {
        let folder = TemporaryFolder::new("exchanges").unwrap();
        let path = folder.path().join("a.wire");
        let name = WireMap::from([("name".to_owned(), "a".into())]);
        let mut file = ExchangeFile::create(&path, &name).unwrap();
        for (asked, answered) in [(1, 10), (2, 20), (1, 11)] {
            file.note(&map("image", asked), &map("actions", answered))
                .unwrap();
        }
        ExchangeFile::create(&path, &name).unwrap_err();
        assert!(RecordedExchanges::are_in(&path));
        let recorded = RecordedExchanges::read(&path).unwrap();
        assert_eq!(recorded.metadata(), &name);
        for (asked, answered) in [(1, 10), (1, 11), (1, 11), (2, 20), (2, 20)] {
            let answer = recorded.answer(&map("image", asked)).unwrap();
            assert_eq!(answer, map("actions", answered));
        }
        let refusal = recorded.answer(&map("image", 3)).unwrap_err().to_string();
        assert!(
            refusal.ends_with("the policy was never asked this, so the run is another one"),
            "{refusal}"
        );

        // Cut anywhere, it is shorter or refused.
        let bytes = fs::read(&path).unwrap();
        for length in 0..bytes.len() {
            fs::write(&path, &bytes[..length]).unwrap();
            if let Ok(recorded) = RecordedExchanges::read(&path) {
                assert_eq!(recorded.metadata(), &name);
            }
        }
        // Changed anywhere, it does no harm.
        for place in 0..bytes.len() {
            let mut changed = bytes.clone();
            changed[place] ^= 0xff;
            fs::write(&path, &changed).unwrap();
            drop(RecordedExchanges::read(&path));
        }
    }
}
