//! The folder of scripts for MATLAB and Octave: its faults, before an engine reads it.

use std::{
    fs, io,
    path::{Path, PathBuf, absolute},
};

use crate::regular_file::{self, Links};

/// Larger files are no scripts.
const LARGEST_SCRIPT: usize = 16 << 20;

/// The variables of the base workspace that the scripts share with the simulator.
pub(crate) const SHARED: [&str; 3] = ["sensor", "motor", "aux"];

/// The reason why the scripts of a folder cannot be run, or others would run in their place: this pair, or the one of agentBehavior.m.
pub(crate) fn fault(
    folder: &Path,
    pair: Option<&[String; 2]>,
    working_dir: &Path,
) -> Option<String> {
    let shown = folder.display();
    if !folder.exists() {
        return Some(format!("there is no {shown}"));
    }
    if !folder.is_dir() {
        return Some(format!("{shown} is a file; name its folder"));
    }
    let separator = if cfg!(windows) { ';' } else { ':' };
    if folder.to_string_lossy().contains(separator) {
        return Some(format!(
            "{shown} cannot be on Matlab's path, because its name holds '{separator}'; rename it"
        ));
    }
    let is_there = |name: &str| {
        let file = |extension| folder.join(format!("{name}.{extension}"));
        ["m", "p"].map(file).iter().any(|file| file.is_file())
    };
    let names = match pair {
        Some([init, callback]) => vec![init.as_str(), callback],
        None => vec!["agentBehavior"],
    };
    if let Some(name) = names.into_iter().find(|name| !is_there(name)) {
        return Some(format!("there is no {name}.m in {shown}"));
    }
    let working_dir = absolute(working_dir).ok()?;
    let (shadow, script) = files(folder).into_iter().find_map(|script| {
        let shadow = working_dir.join(script.file_name()?);
        let other = shadow.is_file() && shadow.canonicalize().ok() != script.canonicalize().ok();
        other.then_some((shadow, script))
    })?;
    Some(format!(
        "{} would run in place of {}, because the current directory goes first; rename one, or start the program elsewhere",
        shadow.display(),
        script.display()
    ))
}

/// A note for the user about a script that has run.
pub(crate) fn note(script: &Path) -> Option<String> {
    let text = read(script).ok()?;
    let text = String::from_utf8_lossy(&text);
    (is_function(&text) && !reaches_shared(&text)).then(|| {
        format!(
            "{} is a function without \"global sensor motor aux\", so these names are its own variables",
            script.display()
        )
    })
}

/// True if a function declares one of the variables that it shares with the simulator, or acts in the base workspace.
fn reaches_shared(text: &str) -> bool {
    let declared = text
        .lines()
        .filter_map(|line| line.trim().strip_prefix("global "));
    words(text).any(|word| matches!(word, "evalin" | "assignin"))
        || declared.flat_map(words).any(|name| SHARED.contains(&name))
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|letter: char| !letter.is_alphanumeric() && letter != '_')
}

/// True if a script is a function.
pub(crate) fn is_function_file(script: &Path) -> bool {
    read(script).is_ok_and(|text| is_function(&String::from_utf8_lossy(&text)))
}

/// True if a file's first word that is no comment is "function".
fn is_function(text: &str) -> bool {
    let mut in_comment = false;
    for line in text.lines().map(str::trim) {
        match line {
            "%{" | "#{" => in_comment = true,
            "%}" | "#}" => in_comment = false,
            _ if in_comment || line.is_empty() || line.starts_with(['%', '#']) => {}
            _ => {
                return line.split(|letter: char| !letter.is_alphanumeric()).next()
                    == Some("function");
            }
        }
    }
    false
}

/// The encoding of a folder's scripts.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Encoding {
    /// In UTF-8.
    Utf8,
    /// As Windows wrote them, this one at least.
    Windows(PathBuf),
    /// This one as Windows wrote it, others in UTF-8.
    Mixed(PathBuf),
}

impl Encoding {
    /// Reads the scripts and sees.
    pub(crate) fn of(folder: &Path) -> Self {
        let mut foreign = None;
        let mut has_utf8 = false;
        for file in files(folder) {
            let text = read(&file).unwrap_or_default();
            if text.is_ascii() {
                continue;
            }
            match str::from_utf8(&text) {
                Ok(_) => has_utf8 = true,
                Err(_) => drop(foreign.get_or_insert(file)),
            }
        }
        match foreign {
            None => Self::Utf8,
            Some(file) if has_utf8 => Self::Mixed(file),
            Some(file) => Self::Windows(file),
        }
    }

    /// A note for the user.
    pub(crate) fn note(&self) -> Option<String> {
        match self {
            Self::Utf8 => None,
            Self::Windows(file) => Some(format!(
                "{} is not UTF-8; the scripts of this folder are read as Windows-1252",
                file.display()
            )),
            Self::Mixed(file) => Some(format!(
                "{} is not UTF-8, unlike others in its folder; save it as UTF-8",
                file.display()
            )),
        }
    }
}

fn read(script: &Path) -> io::Result<Vec<u8>> {
    regular_file::read(script, LARGEST_SCRIPT, Links::Followed)
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut files: Vec<_> = entries
        .map(|entry| entry.path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "m"))
        .filter(|path| !is_hidden(path))
        .collect();
    files.sort();
    files
}

/// True if a file's name begins with a dot, as those have that macOS leaves beside others.
fn is_hidden(path: &Path) -> bool {
    path.file_name()
        .is_some_and(|name| name.as_encoded_bytes().starts_with(b"."))
}

/// True if a script holds a function of this name.
pub(crate) fn holds_function(script: &Path, name: &str) -> bool {
    let text = read(script).unwrap_or_default();
    let text = String::from_utf8_lossy(&text);
    let mut heads = text
        .lines()
        .filter_map(|line| line.trim().strip_prefix("function"));
    heads.any(|head| words(head).any(|word| word == name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_function_is_distinguished_from_a_script() {
        assert!(is_function("% a\n%{\nx = 1;\n%}\n\n  function f\n"));
        assert!(is_function("function[a]=f"));
        assert!(!is_function("x = 1;\nfunction f"));
        assert!(!is_function("functional = 1;"));
        assert!(!is_function("% only words"));
    }

    #[test]
    #[cfg(unix)]
    fn pipes_and_devices_are_not_read() {
        let folder = std::env::temp_dir().join(format!("tabletop-pipes-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let (pipe, endless) = (folder.join("pipe.m"), folder.join("zero.m"));
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        assert!(made.unwrap().success());
        std::os::unix::fs::symlink("/dev/zero", &endless).unwrap();
        for script in [&pipe, &endless] {
            assert!(
                read(script)
                    .unwrap_err()
                    .to_string()
                    .contains("no regular file")
            );
            assert!(!is_function_file(script) && note(script).is_none());
        }
        assert_eq!(Encoding::of(&folder), Encoding::Utf8);
        fs::remove_dir_all(folder).unwrap();
    }
}
