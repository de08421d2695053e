//! Regular files that a stranger may have made or named.

use std::{
    fs::File,
    io::{self, Read as _},
    path::Path,
};

/// What is in the place of a stranger's file.
pub(crate) const NO_FILE: &str = "it is no file but a link, a folder or a device";

/// The treatment of a link at the end of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symlinks {
    /// It may lead to the file: the user named it, or its folder.
    Followed,
    /// A link is no file: a stranger named it, and could have it lead anywhere.
    Refused,
}

/// Makes sure that a path is that of a regular file. A pipe or a device could wait for ever or never end.
///
/// # Errors
/// It is something else, or it is not there.
pub fn require_regular_file(path: &Path, links: Symlinks) -> io::Result<()> {
    let (found, fault) = match links {
        Symlinks::Followed => (path.metadata(), "it is not a file"),
        Symlinks::Refused => (path.symlink_metadata(), NO_FILE),
    };
    match found?.is_file() {
        true => Ok(()),
        false => Err(io::Error::other(fault)),
    }
}

/// Opens a regular file to read it.
///
/// # Errors
/// As [`require_regular_file`], and if it cannot be opened.
pub fn open_regular_file(path: &Path, links: Symlinks) -> io::Result<File> {
    require_regular_file(path, links)?;
    File::open(path)
}

/// The bytes of a regular file.
///
/// # Errors
/// As [`open_regular_file`], and if it has more than `most` bytes or cannot be read.
pub fn read_regular_file(path: &Path, most: u64, links: Symlinks) -> io::Result<Vec<u8>> {
    read_bounded(open_regular_file(path, links)?, most)
}

/// The bytes of a file, which is refused if it has more than `most` bytes.
pub(crate) fn read_bounded(file: File, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    file.take(most.saturating_add(1)).read_to_end(&mut bytes)?;
    match bytes.len() as u64 > most {
        true => Err(io::Error::new(
            io::ErrorKind::FileTooLarge,
            format!("it has more than {most} bytes"),
        )),
        false => Ok(bytes),
    }
}

/// The text of a regular file.
///
/// # Errors
/// As [`read_regular_file`], and if it is not UTF-8.
pub fn read_regular_text(path: &Path, most: u64, links: Symlinks) -> io::Result<String> {
    let bytes = read_regular_file(path, most, links)?;
    String::from_utf8(bytes).map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error))
}

#[cfg(test)]
mod tests {
    use std::{env::temp_dir, fs, process};

    use super::*;

    #[test]
    fn only_files_of_a_bounded_size_are_read() {
        let path = temp_dir().join(format!("tabletop_regular_{}", process::id()));
        fs::write(&path, "four").unwrap();
        for links in [Symlinks::Followed, Symlinks::Refused] {
            assert_eq!(read_regular_text(&path, 4, links).unwrap(), "four");
            let error = read_regular_text(&path, 3, links).unwrap_err().to_string();
            assert_eq!(error, "it has more than 3 bytes");
            assert!(read_regular_file(&temp_dir(), 3, links).is_err());
        }
        fs::write(&path, b"\xff").unwrap();
        assert!(read_regular_text(&path, 3, Symlinks::Followed).is_err());
        fs::remove_file(&path).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn devices_are_refused_and_links_where_a_stranger_made_them() {
        let [file, link] = ["file", "link"]
            .map(|name| temp_dir().join(format!("tabletop_linked_{name}_{}", process::id())));
        fs::write(&file, "four").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        let linked = read_regular_text(&link, 4, Symlinks::Followed);
        let refused = read_regular_text(&link, 4, Symlinks::Refused).unwrap_err();
        fs::remove_file(&file).unwrap();
        fs::remove_file(&link).unwrap();
        assert_eq!(linked.unwrap(), "four");
        assert!(refused.to_string().contains("a link"), "{refused}");
        for links in [Symlinks::Followed, Symlinks::Refused] {
            assert!(read_regular_file(Path::new("/dev/zero"), 3, links).is_err());
        }
    }
}
