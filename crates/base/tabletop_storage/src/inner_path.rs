//! Paths that do not leave their folder, whoever has named them.

use std::{
    fmt,
    path::{Component, Path, PathBuf},
};

/// A path in a folder: names, one below the other. It is neither absolute nor does it lead up, so it leads nowhere else, whoever has named it.
///
/// ```
/// use std::path::Path;
/// use tabletop_storage::InnerPath;
///
/// let video = InnerPath::new("videos/head/0.mp4")?;
/// assert_eq!(video.below(Path::new("set")), Path::new("set/videos/head/0.mp4"));
/// for stray in ["/etc/passwd", "../set", "videos/../..", ".", ""] {
///     assert!(InnerPath::new(stray).is_err());
/// }
/// # Ok::<_, tabletop_storage::StrayPath>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct InnerPath(PathBuf);

/// A path that is no [`InnerPath`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StrayPath(PathBuf);

impl fmt::Display for StrayPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?} is no name of a file in this folder", self.0)
    }
}

impl std::error::Error for StrayPath {}

impl InnerPath {
    /// The path of these names, with slashes between them.
    ///
    /// # Errors
    /// It is empty, absolute, or leads up.
    pub fn new(path: impl AsRef<Path>) -> Result<Self, StrayPath> {
        let path = path.as_ref();
        let mut names = path.components().peekable();
        let is_inner = names.peek().is_some()
            && names.all(|name| matches!(name, Component::Normal(_)))
            && !path.as_os_str().as_encoded_bytes().contains(&0);
        match is_inner {
            true => Ok(Self(path.to_owned())),
            false => Err(StrayPath(path.to_owned())),
        }
    }

    /// The path of one name.
    ///
    /// # Errors
    /// It is none, as a text with a slash.
    pub fn name(name: impl AsRef<Path>) -> Result<Self, StrayPath> {
        let path = Self::new(name)?;
        match path.0.components().count() {
            1 if path.0.as_os_str() == path.0.file_name().unwrap_or_default() => Ok(path),
            _ => Err(StrayPath(path.0)),
        }
    }

    /// The path that the program itself names.
    pub fn fixed(path: &'static str) -> Self {
        debug_assert!(Self::new(path).is_ok(), "{path} is in its folder");
        Self(path.into())
    }

    /// A name with a number in it, between texts of the program.
    pub fn numbered(before: &'static str, number: impl Into<u64>, after: &'static str) -> Self {
        Self::padded(before, 0, number, after)
    }

    /// A name with a number of at least so many digits in it, between texts of the program.
    pub fn padded(
        before: &'static str,
        digits: usize,
        number: impl Into<u64>,
        after: &'static str,
    ) -> Self {
        Self(format!("{before}{:0digits$}{after}", number.into()).into())
    }

    /// The path of another one in the folder of this path.
    #[must_use]
    pub fn then(&self, inner: &Self) -> Self {
        Self(inner.below(&self.0))
    }

    /// The path with all names in front of it.
    #[must_use]
    pub fn below(&self, folder: &Path) -> PathBuf {
        folder.join(&self.0)
    }

    /// The folder that holds it, if that is not the one that it begins in.
    pub fn folder(&self) -> Option<Self> {
        let folder = self.0.parent().filter(|folder| *folder != Path::new(""));
        folder.map(|folder| Self(folder.to_owned()))
    }

    /// The names alone.
    pub fn as_path(&self) -> &Path {
        &self.0
    }

    /// The names, from the outermost on.
    pub(crate) fn names(&self) -> impl Iterator<Item = &Path> {
        self.0.iter().map(Path::new)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_path_leaves_its_folder() {
        for path in ["a", "a/b", "a//b", ".a", "..a", "a..", "a b/c"] {
            assert!(InnerPath::new(path).is_ok(), "{path}");
        }
        for path in [
            "", ".", "..", "/", "/a", "a/..", "../a", "a/../b", "./a", "a\0",
        ] {
            assert!(InnerPath::new(path).is_err(), "{path:?}");
        }
    }

    #[test]
    fn a_name_is_no_path() {
        for name in ["a", ".a", "a b", "..a"] {
            assert!(InnerPath::name(name).is_ok(), "{name}");
        }
        for path in ["a/b", "a/", "", "..", "/a"] {
            assert!(InnerPath::name(path).is_err(), "{path:?}");
        }
    }

    #[test]
    fn numbers_are_names() {
        let inner =
            InnerPath::numbered("", 3_u32, "").then(&InnerPath::numbered("f", 7_u64, ".png"));
        assert_eq!(inner.below(Path::new("demo")), Path::new("demo/3/f7.png"));
        let padded = InnerPath::padded("file-", 3, 12_u32, ".mp4");
        assert_eq!(padded.as_path(), Path::new("file-012.mp4"));
    }
}
