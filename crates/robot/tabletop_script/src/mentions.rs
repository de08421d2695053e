//! Words in scripts: some sensor fields cost time, and most scripts do not mention them.

use std::path::{Path, PathBuf};

use tabletop_storage::{Symlinks, read_regular_file};

/// The Python driver, which knows all words, and lies beside scripts that import it.
const DRIVER: &str = "tabletop_driver.py";
/// Larger files are data.
const LARGEST_SCRIPT: u64 = 1 << 20;
/// Folders in folders are looked into this far down.
const DEEPEST: usize = 3;
/// Largest number of entries that are looked at, of all folders at each depth.
const MOST_ENTRIES: usize = 10_000;
/// Largest number of scripts that are read, the outermost first.
const MOST_SCRIPTS: usize = 1000;

/// True if one of the scripts around an agent (a folder of `agentBehavior.m`, or a Python file) contains one of these words.
pub(crate) fn mention(agent: &Path, words: &[&str]) -> bool {
    let beside = agent.parent().filter(|folder| *folder != Path::new(""));
    let scripts = match agent.is_dir() {
        true => scripts_in(agent, "m"),
        false => scripts_in(beside.unwrap_or(Path::new(".")), "py"),
    };
    let is_own = |script: &&PathBuf| script.file_name().is_none_or(|name| name != DRIVER);
    let mut own = scripts.iter().filter(is_own);
    own.any(|script| contains(script, words))
}

/// The scripts in a folder and in those below it that are not hidden.
fn scripts_in(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let mut scripts = Vec::new();
    let mut folders = vec![folder.to_owned()];
    for _ in 0..=DEEPEST {
        let mut entries: Vec<_> = folders
            .iter()
            .flat_map(|folder| folder.read_dir().into_iter().flatten().flatten())
            .filter(|entry| !entry.file_name().as_encoded_bytes().starts_with(b"."))
            .map(|entry| entry.path())
            .collect();
        // The choice must not depend on the file system.
        entries.sort();
        entries.truncate(MOST_ENTRIES);
        let (below, mut files): (Vec<_>, Vec<_>) =
            entries.into_iter().partition(|path| path.is_dir());
        files.retain(|file| file.extension().is_some_and(|other| other == extension));
        scripts.append(&mut files);
        folders = below;
    }
    scripts.truncate(MOST_SCRIPTS);
    scripts
}

fn contains(script: &Path, words: &[&str]) -> bool {
    let Ok(text) = read_regular_file(script, LARGEST_SCRIPT, Symlinks::Followed) else {
        return false;
    };
    let comment = match script.extension().is_some_and(|ending| ending == "py") {
        true => b'#',
        false => b'%',
    };
    let lines = text.split(|byte| *byte == b'\n');
    let mut found = lines
        .map(|line| code(line, comment))
        .flat_map(|code| code.split(|byte| !byte.is_ascii_alphanumeric() && *byte != b'_'));
    found.any(|word| words.iter().any(|wanted| wanted.as_bytes() == word))
}

/// A line without its comment, if it is clear that it is one: text after an open quote may belong to a string.
fn code(line: &[u8], comment: u8) -> &[u8] {
    let is_outside = |before: &[u8]| {
        let quotes = |quote: u8| before.iter().filter(|byte| **byte == quote).count();
        quotes(b'\'') % 2 == 0 && quotes(b'"') % 2 == 0
    };
    let mut signs = (0..line.len()).filter(|&at| line[at] == comment);
    let end = signs.find(|&at| is_outside(&line[..at]));
    &line[..end.unwrap_or(line.len())]
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn words_are_found_in_scripts_and_nowhere_else() {
        let folder = std::env::temp_dir().join(format!("tabletop-mentions-{}", std::process::id()));
        fs::create_dir_all(folder.join("lib/private/a/b")).unwrap();
        let write = |name: &str, text: &str| fs::write(folder.join(name), text).unwrap();
        write("a.m", "x = sensor.trackerLoc('l-S1');");
        write("b.m", "withheld = heldBack;");
        write("notes.txt", "contacts");
        write("lib/private/c.m", "s = 'objects';");
        write("lib/helper.py", "sensor.contacts");
        write("lib/private/a/b/deep.m", "sensor.held");
        write("robot.py", "print(sensor.held)");
        write("tabletop_driver.py", "demoCue");
        write(
            "lib/notes.py",
            "x = 1  # jointTorques\nprint('#', rgbVision)",
        );
        write("notes.m", "y = 2; % endEffPos\nfprintf('%d', headAngle);");
        assert!(mention(&folder, &["trackerLoc"]));
        assert!(mention(&folder, &["objects", "contacts"]));
        assert!(!mention(&folder, &["held", "contacts"]));
        assert!(mention(&folder.join("robot.py"), &["held"]));
        assert!(mention(&folder.join("robot.py"), &["contacts"]));
        assert!(!mention(&folder.join("robot.py"), &["trackerLoc"]));
        assert!(!mention(
            &folder.join("robot.py"),
            &["demoCue", "jointTorques"]
        ));
        assert!(mention(&folder.join("robot.py"), &["rgbVision"]));
        assert!(!mention(&folder, &["endEffPos"]));
        assert!(mention(&folder, &["headAngle"]));
        assert!(!mention(Path::new("no such folder"), &["held"]));
        fs::remove_dir_all(folder).unwrap();
    }
}
