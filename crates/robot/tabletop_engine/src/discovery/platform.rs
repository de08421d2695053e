//! The usual folders of programs on each platform.

use std::path::{Path, PathBuf};

use crate::kind::EngineKind;

/// A platform with habits of its own about where programs are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Platform {
    /// Linux and other Unix systems.
    Linux,
    /// macOS.
    MacOs,
    /// Windows.
    Windows,
}

impl Platform {
    /// The one that this program was built for.
    pub(crate) fn here() -> Self {
        if cfg!(windows) {
            Self::Windows
        } else if cfg!(target_os = "macos") {
            Self::MacOs
        } else {
            Self::Linux
        }
    }
}

impl EngineKind {
    /// The names of its program.
    pub(crate) fn programs(self, platform: Platform) -> &'static [&'static str] {
        match (self, platform) {
            (Self::Matlab, Platform::Windows) => &["matlab.exe"],
            (Self::Matlab, _) => &["matlab"],
            (Self::Octave, Platform::Windows) => &["octave-cli.exe"],
            (Self::Octave, _) => &["octave-cli", "octave"],
            (Self::Python, Platform::Windows) => &["python3.exe", "python.exe"],
            (Self::Python, _) => &["python3"],
            (Self::Driver, _) => &[],
        }
    }

    /// Folders beside PATH, each with at most one part that is a pattern: everything up to "*" and after it must fit.
    pub(crate) fn usual_places(self, platform: Platform) -> &'static [&'static str] {
        match (self, platform) {
            (Self::Matlab, Platform::Linux) => &[
                "usr/local/MATLAB/R20*/bin",
                "opt/MATLAB/R20*/bin",
                "opt/matlab/R20*/bin",
            ],
            (Self::Matlab, Platform::MacOs) => &["Applications/MATLAB_R20*/bin"],
            (Self::Matlab, Platform::Windows) => &["Program Files/MATLAB/R20*/bin"],
            (Self::Octave, Platform::Linux) => &["usr/bin", "usr/local/bin", "snap/bin"],
            (Self::Octave, Platform::MacOs) => &[
                "opt/homebrew/bin",
                "usr/local/bin",
                "opt/local/bin",
                "Applications/Octave*/Contents/Resources/usr/bin",
            ],
            (Self::Octave, Platform::Windows) => &[
                "Program Files/GNU Octave/Octave-*/mingw64/bin",
                "Octave/Octave-*/mingw64/bin",
            ],
            (Self::Python, Platform::MacOs) => &["opt/homebrew/bin", "usr/local/bin", "usr/bin"],
            (Self::Python, Platform::Linux) => &["usr/bin", "usr/local/bin"],
            (Self::Python, Platform::Windows) | (Self::Driver, _) => &[],
        }
    }
}

/// The folders that fit a pattern, the one with the highest version first.
pub(crate) fn matching(root: &Path, place: &str) -> Vec<PathBuf> {
    let Some((before, after)) = place.split_once('*') else {
        return vec![root.join(place)];
    };
    let (parent, prefix) = before.rsplit_once('/').unwrap_or(("", before));
    let (suffix, rest) = after.split_once('/').unwrap_or((after, ""));
    let entries = root.join(parent).read_dir().into_iter().flatten().flatten();
    let mut names: Vec<_> = entries
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .filter(|name| name.starts_with(prefix) && name.ends_with(suffix))
        .collect();
    names.sort_by_cached_key(|name| std::cmp::Reverse(version(name)));
    names
        .iter()
        .map(|name| root.join(parent).join(name).join(rest))
        .collect()
}

/// The numbers and letters of a name, so that 10 comes after 9 and R2023b after R2023a.
fn version(name: &str) -> Vec<(u64, String)> {
    let mut parts = Vec::new();
    for letter in name.chars() {
        match (letter.to_digit(10), parts.last_mut()) {
            (Some(digit), Some((number, text))) if String::is_empty(text) => {
                *number = u64::saturating_add(u64::saturating_mul(*number, 10), digit.into());
            }
            (Some(digit), _) => parts.push((u64::from(digit), String::new())),
            (None, Some((0, text))) if !text.is_empty() => text.push(letter),
            (None, _) => parts.push((0, letter.to_string())),
        }
    }
    parts
}

pub(crate) fn is_program(path: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        path.metadata()
            .is_ok_and(|data| data.is_file() && data.permissions().mode() & 0o111 != 0)
    }
    #[cfg(not(unix))]
    path.is_file()
}
