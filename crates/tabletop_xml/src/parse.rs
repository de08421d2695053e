//! Task files as scenes.

use std::{
    fs::File,
    io::{self, Read as _},
    path::{Path, PathBuf},
};

use tabletop_core::SceneSpec;

use crate::{
    document::build,
    document::decode::decode,
    elements,
    fault::{Fault, Faults, Place},
};

/// The most bytes that a task file can have: 16 MiB.
pub const MAX_FILE_BYTES: usize = 16 << 20;

/// What a task file says, and what is wrong with it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ParsedTask {
    /// The table and what stands on it, without the elements that have a fault.
    pub scene: SceneSpec,
    /// The faults, in the order of the file.
    pub faults: Vec<Fault>,
}

/// Why a task file cannot be read at all.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The operating system does not give it, because it is not there for instance.
    #[error("{path}: it cannot be read: {source}, expected a task file", path = path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// It is a folder, a device or a pipe.
    #[error("{path}: it is not a file, expected a task file", path = path.display())]
    NotAFile {
        /// The path.
        path: PathBuf,
    },
    /// It has more than [`MAX_FILE_BYTES`].
    #[error("{path}: it is too large, expected at most {MAX_FILE_BYTES} bytes", path = path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
    },
}

/// Reads the content of a task file (report section 6.2). It never fails: what has a fault is skipped, and there is
/// always a table. `file` only names the file in the faults.
///
/// ```
/// use std::path::Path;
///
/// let text = br#"<tabletop xmlns="http://synapse.cs.umd.edu/tabletop-xml">
///   <block location="(0,0,0.5)"/>
///   <sphere location="(2,0,0.5)" radius="large"/>
/// </tabletop>"#;
/// let task = tabletop_xml::parse(Path::new("task.xml"), text);
/// assert_eq!(task.scene.items.len(), 1);
/// assert_eq!(
///     task.faults[0].to_string(),
///     "task.xml:3:32: sphere, radius: `large` is not a number, expected a number from 0.001 to 1000"
/// );
/// ```
pub fn parse(file: &Path, text: &[u8]) -> ParsedTask {
    let mut faults = Faults::default();
    if text.len() > MAX_FILE_BYTES {
        let expected = format_args!("at most {MAX_FILE_BYTES} bytes");
        faults.report(Place::outside(0), "the file is too large", expected);
        return ParsedTask {
            scene: SceneSpec::default(),
            faults: faults.locate(file, ""),
        };
    }
    let decoded = decode(text);
    let scene = match build::read(&decoded, &mut faults) {
        Some(root) => elements::scene(&root, &mut faults),
        None => SceneSpec::default(),
    };
    ParsedTask {
        scene,
        faults: faults.locate(file, decoded.text),
    }
}

/// Whether a file is meant to be loaded, whatever is wrong with it: its root is `<tabletop>`, and it holds more than the templates that
/// the later program had (`<def>`), which only other files use.
///
/// ```
/// assert!(tabletop_xml::is_task(b"<tabletop><cube/></tabletop>"));
/// assert!(!tabletop_xml::is_task(b"<tabletop><def name='lid'/></tabletop>"));
/// assert!(!tabletop_xml::is_task(b"<robot/>"));
/// ```
pub fn is_task(text: &[u8]) -> bool {
    let root = build::read(&decode(text), &mut Faults::default());
    root.is_some_and(|root| {
        let is_of_templates = |name| matches!(name, "def" | "include");
        let has_more = root
            .children
            .iter()
            .any(|child| !is_of_templates(child.name));
        root.name == "tabletop" && (root.children.is_empty() || has_more)
    })
}

/// Reads a task file from the disk.
///
/// # Errors
///
/// There is no such file, it is not a file, it cannot be read, or it is larger than [`MAX_FILE_BYTES`].
pub fn read_task(path: &Path) -> Result<ParsedTask, ReadError> {
    let failed = |source| ReadError::Io {
        path: path.to_path_buf(),
        source,
    };
    let metadata = path.metadata().map_err(failed)?;
    if !metadata.is_file() {
        return Err(ReadError::NotAFile {
            path: path.to_path_buf(),
        });
    }
    let mut text = Vec::new();
    File::open(path)
        .and_then(|file| file.take(MAX_FILE_BYTES as u64 + 1).read_to_end(&mut text))
        .map_err(failed)?;
    if text.len() > MAX_FILE_BYTES {
        return Err(ReadError::TooLarge {
            path: path.to_path_buf(),
        });
    }
    Ok(parse(path, &text))
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn a_file_that_cannot_be_read_is_one_clear_error() {
        let folder = std::env::temp_dir().join(format!("tabletop_xml_{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let message = |path: &Path| read_task(path).unwrap_err().to_string();

        let missing = folder.join("missing.xml");
        assert!(
            message(&missing).starts_with(&format!("{}: it cannot be read: ", missing.display()))
        );
        assert!(message(&folder).contains("it is not a file"));
        let large = folder.join("large.xml");
        File::create(&large).unwrap().set_len(20 << 20).unwrap();
        assert!(message(&large).ends_with("it is too large, expected at most 16777216 bytes"));

        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn a_text_that_is_too_large_is_one_fault() {
        let task = parse(Path::new("f"), &vec![b' '; MAX_FILE_BYTES + 1]);
        assert_eq!(task.faults.len(), 1);
        assert_eq!(task.scene, SceneSpec::default());
    }
}
