//! The STL files that elements name.

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

use tabletop_core::MeshSpec;
use tabletop_mesh::MAX_STL_BYTES;

use crate::{
    elements::value::ValueError,
    files::{FileTree, TaskPath},
};

/// Largest size of all STL files of a task, in bytes: 64 MiB.
const MAX_ALL_BYTES: usize = 64 << 20;

/// The STL files of a task, each read once.
pub(crate) struct MeshFiles<'f> {
    tree: &'f FileTree<'f>,
    task: &'f TaskPath,
    /// The files of the task, by the numbers of their sources.
    sources: Vec<TaskPath>,
    /// The contents, by the true path.
    read: BTreeMap<PathBuf, Result<Vec<u8>, ValueError>>,
    /// The files that were read, as faults name them.
    files: Vec<PathBuf>,
    bytes: usize,
}

impl<'f> MeshFiles<'f> {
    /// The STL files of a task that is made of these files.
    pub fn new(tree: &'f FileTree<'f>, task: &'f TaskPath, sources: &[PathBuf]) -> Self {
        Self {
            tree,
            task,
            sources: sources.iter().map(|file| tree.task(file)).collect(),
            read: BTreeMap::new(),
            files: Vec::new(),
            bytes: 0,
        }
    }

    /// The files that were read.
    pub fn files(self) -> Vec<PathBuf> {
        self.files
    }

    /// The mesh of a file that a source names.
    pub fn mesh(
        &mut self,
        source: usize,
        written: &str,
        scale: f32,
    ) -> Result<MeshSpec, ValueError> {
        let refused =
            |problem: String| ValueError::new(written, &problem, "an STL file of a solid");
        let naming = self.sources.get(source).unwrap_or(self.task);
        let file = self.tree.find(self.task, naming, written)?;
        let is_stl = |path: &Path| {
            let extension = path.extension().unwrap_or_default();
            extension.eq_ignore_ascii_case("stl")
        };
        if !is_stl(&file.shown) {
            return Err(refused("is not named as an STL file".into()));
        }
        if !self.read.contains_key(&file.true_path) {
            let bytes = self.bytes_of(&file).map_err(refused);
            self.read.insert(file.true_path.clone(), bytes);
            self.files.push(file.shown.clone());
        }
        match &self.read[&file.true_path] {
            Ok(bytes) => tabletop_mesh::mesh(written.trim(), bytes, scale)
                .map_err(|error| refused(format!("cannot be used: {error}"))),
            Err(ValueError { problem, expected }) => Err(ValueError {
                problem: problem.clone(),
                expected: expected.clone(),
            }),
        }
    }

    fn bytes_of(&mut self, file: &TaskPath) -> Result<Vec<u8>, String> {
        let left = MAX_STL_BYTES.min(MAX_ALL_BYTES - self.bytes);
        let bytes = self.tree.read(file, left);
        let bytes = bytes.map_err(|error| format!("cannot be read: {error}"))?;
        if bytes.len() > left {
            return Err(match left < MAX_STL_BYTES {
                true => format!("is too large with the others, more than {MAX_ALL_BYTES} bytes"),
                false => format!("is larger than {MAX_STL_BYTES} bytes"),
            });
        }
        self.bytes += bytes.len();
        Ok(bytes)
    }
}
