//! Where the files are that a file of a stranger may name.

use std::path::{Path, PathBuf};

/// The folders in which, and below, a file may name others.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Reach(Vec<PathBuf>);

impl Reach {
    /// These folders, as far as they are there.
    pub fn of<P: AsRef<Path>>(folders: impl IntoIterator<Item = P>) -> Self {
        let there = folders.into_iter().filter_map(|folder| {
            let folder = match folder.as_ref() == Path::new("") {
                true => Path::new("."),
                false => folder.as_ref(),
            };
            folder.canonicalize().ok()
        });
        Self(there.collect())
    }

    /// Whether a file or folder is there, and not outside by way of a link.
    pub fn contains(&self, path: &Path) -> bool {
        let path = path.canonicalize();
        path.is_ok_and(|path| self.0.iter().any(|folder| path.starts_with(folder)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_in_the_folders_or_below_are_within_reach() {
        let reach = Reach::of(["src", "no such folder"]);
        for (path, is_within) in [
            ("src", true),
            ("src/lib.rs", true),
            ("src/../src/reach.rs", true),
            ("Cargo.toml", false),
            ("src/../Cargo.toml", false),
            ("src/no_such_file.rs", false),
            ("no such folder", false),
        ] {
            assert_eq!(reach.contains(Path::new(path)), is_within, "{path}");
        }
        assert!(Reach::of([""]).contains(Path::new("Cargo.toml")));
        assert!(!Reach::default().contains(Path::new("src")));
    }

    #[cfg(unix)]
    #[test]
    fn a_link_leads_out() {
        let root = std::env::temp_dir().join(format!("tabletop_within_{}", std::process::id()));
        std::fs::create_dir_all(root.join("in")).unwrap();
        std::fs::write(root.join("out"), "").unwrap();
        std::os::unix::fs::symlink(root.join("out"), root.join("in/link")).unwrap();
        assert!(!Reach::of([root.join("in")]).contains(&root.join("in/link")));
        std::fs::remove_dir_all(root).unwrap();
    }
}
