//! Regular files that a stranger may have made or named.

use std::{
    fs::File,
    io::{self, Read as _},
    path::Path,
};

/// The bytes of a regular file. A pipe or a device is refused: it could wait for ever or never end.
///
/// # Errors
/// It is something else, has more than `most` bytes, or cannot be read.
pub fn read_regular_file(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    if !path.metadata()?.is_file() {
        return Err(io::Error::other("it is not a file"));
    }
    let mut bytes = Vec::new();
    File::open(path)?
        .take(most.saturating_add(1))
        .read_to_end(&mut bytes)?;
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
pub fn read_regular_text(path: &Path, most: u64) -> io::Result<String> {
    let bytes = read_regular_file(path, most)?;
    String::from_utf8(bytes).map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error))
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn only_files_of_a_bounded_size_are_read() {
        let path = std::env::temp_dir().join(format!("tabletop_regular_{}", std::process::id()));
        fs::write(&path, "four").unwrap();
        assert_eq!(read_regular_text(&path, 4).unwrap(), "four");
        let error = read_regular_text(&path, 3).unwrap_err().to_string();
        assert_eq!(error, "it has more than 3 bytes");
        fs::write(&path, b"\xff").unwrap();
        assert!(read_regular_text(&path, 3).is_err());
        fs::remove_file(&path).unwrap();
        assert!(read_regular_file(&std::env::temp_dir(), 3).is_err());
        if cfg!(unix) {
            let error = read_regular_file(Path::new("/dev/zero"), 3).unwrap_err();
            assert_eq!(error.to_string(), "it is not a file");
        }
    }
}
