//! The program among the applications of a desktop: an entry and an icon, after the specifications of freedesktop.org.

use std::{
    env,
    path::{Path, PathBuf},
};

use crate::storage::{InnerPath, Storage, parent_of};

use super::{Failure, Output};

/// The icon: a block on a table.
const ICON: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 64 64">
  <path fill="#e8eaed" d="M32 30 62 44 32 58 2 44z"/>
  <path fill="#b6bbc2" d="M2 44v4l30 14 30-14v-4L32 58z"/>
  <path fill="#40c4b4" d="M32 8 48 15 32 22 16 15z"/>
  <path fill="#2b9b8d" d="M16 15v20l16 8V22z"/>
  <path fill="#1f7a70" d="M48 15v20l-16 8V22z"/>
</svg>
"##;

/// Writes entry and icon to the user's folder of data, for a program that starts in a folder.
pub(super) fn install(folder: Option<&Path>) -> Result<(), Failure> {
    let data = data_folder().ok_or_else(|| {
        Failure::run("there is no folder for the entry: neither XDG_DATA_HOME nor HOME is set")
    })?;
    let program = env::current_exe().map_err(Failure::run)?;
    let folder = folder.map(|folder| std::path::absolute(folder).map_err(Failure::run));
    let entry = entry(&program, folder.transpose()?.as_deref());
    for (place, text) in [
        ("icons/hicolor/scalable/apps/tabletop.svg", ICON),
        ("applications/tabletop.desktop", &*entry),
    ] {
        let path = InnerPath::fixed(place).below(&data);
        let storage = Storage::default();
        storage
            .create_folders(parent_of(&path))
            .and_then(|()| storage.replace(&path, text.as_bytes()))
            .map_err(|error| Failure::at(&path, error))?;
        Output::tell(&format!("{} written\n", path.display()))?;
    }
    Ok(())
}

/// `XDG_DATA_HOME`, or what stands for it.
fn data_folder() -> Option<PathBuf> {
    let named = |name| {
        let path = PathBuf::from(env::var_os(name)?);
        path.is_absolute().then_some(path)
    };
    named("XDG_DATA_HOME").or_else(|| Some(named("HOME")?.join(".local/share")))
}

fn entry(program: &Path, folder: Option<&Path>) -> String {
    let start = folder.map(|folder| format!("Path={}\n", escaped(folder)));
    format!(
        "[Desktop Entry]\n\
         Type=Application\n\
         Name=tabletop\n\
         Comment=Show a robot what to do with the things on a table\n\
         Exec={}\n\
         Icon=tabletop\n\
         Categories=Science;Robotics;Education;\n\
         Terminal=false\n\
         {}",
        quoted(program),
        start.unwrap_or_default()
    )
}

/// A value of an entry.
fn escaped(path: &Path) -> String {
    let text = path.display().to_string();
    text.replace('\\', "\\\\").replace('\n', "\\n")
}

/// A word of a command line: in quotes, with what they leave special escaped, and percent signs doubled.
fn quoted(path: &Path) -> String {
    let text = path.display().to_string();
    let escaped = text.chars().fold(String::new(), |mut escaped, char| {
        match char {
            '"' | '`' | '$' | '\\' => escaped.push('\\'),
            '%' => escaped.push('%'),
            _ => {}
        }
        escaped.push(char);
        escaped
    });
    format!("\"{escaped}\"").replace('\\', "\\\\")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_entry_starts_the_program_whatever_its_path() {
        let entry = entry(
            Path::new("/opt/my $tools/100%/tabletop"),
            Some(Path::new("/home/a b")),
        );
        let lines: Vec<_> = entry.lines().collect();
        assert_eq!(lines[0], "[Desktop Entry]");
        assert!(
            lines.contains(&r#"Exec="/opt/my \\$tools/100%%/tabletop""#),
            "{entry}"
        );
        assert!(lines.contains(&"Path=/home/a b"), "{entry}");
        assert!(
            lines.iter().skip(1).all(|line| line.contains('=')),
            "{entry}"
        );
    }
}
