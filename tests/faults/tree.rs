//! Folders with all that is in them.

use std::{collections::BTreeMap, fs, path::Path};

/// The files of a folder and below by their paths, without those that are hidden.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tree(pub BTreeMap<String, Vec<u8>>);

impl Tree {
    pub fn of(folder: &Path) -> Self {
        let mut tree = Self::default();
        tree.collect(folder, "");
        tree
    }

    fn collect(&mut self, folder: &Path, prefix: &str) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_string_lossy();
            if name.starts_with('.') {
                continue;
            }
            let name = format!("{prefix}{name}");
            match path.is_dir() {
                true => self.collect(&path, &format!("{name}/")),
                false => drop(self.0.insert(name, fs::read(&path).unwrap())),
            }
        }
    }

    /// The first file that differs from another tree's.
    pub fn first_difference(&self, other: &Self) -> Option<String> {
        let mut names = self.0.keys().chain(other.0.keys());
        let differs = |name: &&String| self.0.get(*name) != other.0.get(*name);
        names.find(differs).cloned()
    }

    /// The folders directly in it that hold recordings.
    pub fn recordings(&self) -> Vec<String> {
        let sessions = self.0.keys();
        let folders = sessions.filter_map(|name| name.strip_suffix("/session.jsonl"));
        folders.map(str::to_owned).collect()
    }
}

pub fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        let to = to.join(path.file_name().unwrap());
        match path.is_dir() {
            true => copy(&path, &to),
            false => drop(fs::copy(&path, &to).unwrap()),
        }
    }
}
