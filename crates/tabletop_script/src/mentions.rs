//! What scripts talk about: some of what can be sensed costs time, and most scripts do not ask for it.

use std::{
    fs,
    path::{Path, PathBuf},
};

/// Larger files are data.
const LARGEST_SCRIPT: u64 = 1 << 20;

/// Whether one of the scripts around an agent (a folder of `agentBehavior.m`, or a Python file) contains one of these words.
pub(crate) fn mention(agent: &Path, words: &[&str]) -> bool {
    let beside = agent.parent().filter(|folder| *folder != Path::new(""));
    match agent.is_dir() {
        true => scripts_in(agent, "m").any(|script| contains(&script, words)),
        false => scripts_in(beside.unwrap_or(Path::new(".")), "py")
            .any(|script| contains(&script, words)),
    }
}

/// The scripts in a folder, and in those below it that Matlab looks into by itself: of classes, packages and private functions.
fn scripts_in(folder: &Path, extension: &str) -> Box<dyn Iterator<Item = PathBuf>> {
    let extension = extension.to_owned();
    let entries = folder.read_dir().into_iter().flatten().flatten();
    Box::new(
        entries.flat_map(move |entry| -> Box<dyn Iterator<Item = PathBuf>> {
            let path = entry.path();
            let name = entry.file_name();
            let name = name.to_string_lossy();
            let is_ours = name.starts_with(['@', '+']) || name == "private";
            if is_ours && path.is_dir() {
                return scripts_in(&path, &extension);
            }
            let is_script = path.extension().is_some_and(|other| *other == *extension);
            Box::new(is_script.then_some(path).into_iter())
        }),
    )
}

fn contains(script: &Path, words: &[&str]) -> bool {
    if !fs::metadata(script).is_ok_and(|file| file.is_file() && file.len() <= LARGEST_SCRIPT) {
        return false;
    }
    let text = fs::read(script).unwrap_or_default();
    let mut found = text.split(|byte| !byte.is_ascii_alphanumeric() && *byte != b'_');
    found.any(|word| words.iter().any(|wanted| wanted.as_bytes() == word))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_found_in_scripts_and_nowhere_else() {
        let folder = std::env::temp_dir().join(format!("tabletop-mentions-{}", std::process::id()));
        fs::create_dir_all(folder.join("private")).unwrap();
        let write = |name: &str, text: &str| fs::write(folder.join(name), text).unwrap();
        write("a.m", "x = sensor.trackerLoc('l-S1');");
        write("b.m", "withheld = heldBack;");
        write("notes.txt", "contacts");
        write("private/c.m", "s = 'objects';");
        write("robot.py", "print(sensor.held)");
        assert!(mention(&folder, &["trackerLoc"]));
        assert!(mention(&folder, &["objects", "contacts"]));
        assert!(!mention(&folder, &["held", "contacts"]));
        assert!(mention(&folder.join("robot.py"), &["held"]));
        assert!(!mention(&folder.join("robot.py"), &["trackerLoc"]));
        assert!(!mention(Path::new("no such folder"), &["held"]));
        fs::remove_dir_all(folder).unwrap();
    }
}
