//! Where results go: found out before any work.

use std::{
    io::Read as _,
    path::{Path, PathBuf},
};

use crate::storage::{Storage, Symlinks, canonical, is_taken, open_regular_file, parent_of};

use super::Failure;

/// Bytes at the beginning of a file that show its kind.
const BEGINNING: u64 = 4096;

/// The kind of a result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ResultKind {
    Page,
    Book,
    Video,
    Animation,
    Picture,
    Policy,
    LossCurve,
    Svg,
    Json,
    Table,
    Program,
    Question,
}

impl ResultKind {
    fn name(self) -> &'static str {
        match self {
            Self::Page => "a page of tabletop's",
            Self::Book => "the documentation",
            Self::Video => "an MP4 video",
            Self::Animation => "a GIF animation",
            Self::Picture => "a PNG picture",
            Self::Policy => "a policy",
            Self::LossCurve => "a plot of a training",
            Self::Svg => "an SVG drawing",
            Self::Json => "a JSON file",
            Self::Table => "a table of final poses",
            Self::Program => "a task program",
            Self::Question => "a table that `teach` asks about",
        }
    }

    /// True of a file that begins so.
    fn begins_with(self, bytes: &[u8]) -> bool {
        let text = String::from_utf8_lossy(bytes);
        let text = text.trim_start();
        match self {
            Self::Page => text.contains(crate::report::GENERATOR),
            Self::Book => text.contains(crate::book::GENERATOR),
            Self::Video => bytes.get(4..8) == Some(b"ftyp"),
            Self::Animation => bytes.starts_with(b"GIF8"),
            Self::Picture => bytes.starts_with(b"\x89PNG"),
            Self::Policy => bytes.get(8) == Some(&b'{'),
            Self::LossCurve => text.starts_with(crate::policy::LOSS_CURVE),
            Self::Svg => text.starts_with("<svg") || text.starts_with("<?xml"),
            Self::Json => text.starts_with(['{', '[']),
            Self::Table => text.starts_with("id,x,y,z,"),
            Self::Program => text.starts_with(super::meaning::HEADING),
            Self::Question => text.contains(super::meaning::ASKED),
        }
    }
}

/// A file that gets a result: in a folder that is there, in no recording or dataset, and nothing else's.
#[derive(Clone, Debug)]
pub(super) struct ResultFile {
    path: PathBuf,
    /// Nothing may be there when it is written.
    is_new: bool,
}

impl ResultFile {
    /// Only a new one.
    pub fn new(path: &Path, kind: ResultKind) -> Result<Self, Failure> {
        let file = Self::replacing(path, kind)?;
        match is_taken(path) && (!path.exists() || path.is_file()) {
            true => Err(Failure::input(format!(
                "{}: it is there already; --replace replaces it",
                path.display()
            ))),
            false => Ok(Self {
                is_new: !is_taken(path),
                ..file
            }),
        }
    }

    /// A new one, or in the place of one of its kind. A pipe or a device is written to.
    pub fn replacing(path: &Path, kind: ResultKind) -> Result<Self, Failure> {
        let wrong = |problem: String| Failure::input(format!("{}: {problem}", path.display()));
        if path.is_dir() {
            return Err(wrong(format!(
                "it is a folder, expected a name for {}",
                kind.name()
            )));
        }
        require_outside(path, &[])?;
        let folder = parent_of(path);
        if !folder.is_dir() {
            let (path, folder) = (path.display(), folder.display());
            return Err(Failure::run(format!(
                "{path}: there is no folder {folder}; make it first"
            )));
        }
        if path.is_file() {
            let mut beginning = Vec::new();
            let read = open_regular_file(path, Symlinks::Followed)
                .and_then(|file| file.take(BEGINNING).read_to_end(&mut beginning));
            read.map_err(|error| Failure::at(path, error))?;
            if !beginning.is_empty() && !kind.begins_with(&beginning) {
                let kind = kind.name();
                return Err(wrong(format!(
                    "something else than {kind} is there, and stays; name another file"
                )));
            }
        }
        let writable = Storage::default().check_replaceable(path);
        writable.map_err(|error| Failure::at(path, error))?;
        Ok(Self {
            path: path.to_owned(),
            is_new: false,
        })
    }

    /// Writes everything, or reports the place that could not be written; a file is then as it was.
    pub fn write(&self, bytes: &[u8]) -> Result<(), Failure> {
        let storage = Storage::default();
        let written = match self.is_new {
            true => storage.write_new(&self.path, bytes),
            false => storage.replace(&self.path, bytes),
        };
        written.map_err(|error| Failure::at(&self.path, error))
    }
}

/// Makes sure that a result goes into no recording or dataset, and not into what is read.
pub(super) fn require_outside(path: &Path, read: &[&Path]) -> Result<(), Failure> {
    let place = canonical(path);
    let mut folders = place.ancestors().skip(1);
    let inside = |kind: &str, folder: &Path| {
        let (path, folder) = (path.display(), folder.display());
        Failure::input(format!(
            "{path}: it would be in the {kind} {folder}; name a place outside of it"
        ))
    };
    if let Some(folder) = folders
        .clone()
        .find(|it| is_taken(&it.join("session.jsonl")))
    {
        return Err(inside("recording", folder));
    }
    let is_dataset = |folder: &&Path| {
        is_taken(&folder.join("meta/info.json")) || is_taken(&folder.join("dataset_info.json"))
    };
    if let Some(folder) = folders.clone().find(is_dataset) {
        return Err(inside("dataset", folder));
    }
    let read: Vec<_> = read.iter().map(|input| canonical(input)).collect();
    match folders.find(|folder| read.iter().any(|input| input == folder)) {
        Some(folder) => Err(inside("folder that is read,", folder)),
        None => Ok(()),
    }
}
