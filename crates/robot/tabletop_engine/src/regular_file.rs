//! Files that others may have replaced: opened without waiting, and only if they are files.

use std::{
    fs::{File, OpenOptions},
    io::{self, Read as _},
    path::Path,
};

/// The treatment of a link at the end of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Links {
    /// It may.
    Followed,
    /// A link is no file.
    Refused,
}

/// Reads a regular file of at most `limit` bytes.
///
/// # Errors
/// It is something else (a pipe, a device, a folder), is larger, or cannot be read.
pub(crate) fn read(path: &Path, limit: usize, links: Links) -> io::Result<Vec<u8>> {
    let file = open(path, OpenOptions::new().read(true), links)?;
    let mut bytes = Vec::new();
    // It may grow while it is read.
    file.take(limit as u64 + 1).read_to_end(&mut bytes)?;
    match bytes.len() <= limit {
        true => Ok(bytes),
        false => Err(io::Error::new(
            io::ErrorKind::FileTooLarge,
            "it is too long",
        )),
    }
}

/// Opens a regular file without waiting for anybody at its other end.
///
/// # Errors
/// It is something else, or cannot be opened.
pub(crate) fn open(path: &Path, options: &mut OpenOptions, links: Links) -> io::Result<File> {
    never_wait(options, links);
    let file = options.open(path).map_err(|error| match is_link(path) {
        true if links == Links::Refused => io::Error::new(error.kind(), "it is a link"),
        _ => error,
    })?;
    match file.metadata()?.is_file() {
        true => Ok(file),
        false => Err(io::Error::other("it is no regular file")),
    }
}

fn is_link(path: &Path) -> bool {
    path.symlink_metadata().is_ok_and(|data| data.is_symlink())
}

#[cfg(unix)]
fn never_wait(options: &mut OpenOptions, links: Links) {
    use nix::libc::{O_NOCTTY, O_NOFOLLOW, O_NONBLOCK};
    use std::os::unix::fs::OpenOptionsExt as _;
    let no_follow = match links {
        Links::Followed => 0,
        Links::Refused => O_NOFOLLOW,
    };
    options.custom_flags(O_NONBLOCK | O_NOCTTY | no_follow);
}

/// Windows has no pipes among its files.
#[cfg(not(unix))]
fn never_wait(_options: &mut OpenOptions, _links: Links) {}
