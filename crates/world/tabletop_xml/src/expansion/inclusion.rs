//! Files that others include.

use std::{collections::BTreeSet, path::PathBuf};

use crate::{
    document::{self, build::MAX_ELEMENTS, decode::decode, tree::Element},
    elements::attributes::AttributeReader,
    fault::{Excerpt, Faults},
    files::{Arena, FileTree, MAX_FILE_BYTES, TaskPath},
    origin::Sources,
};

/// The element that includes a file.
pub(crate) const INCLUDE: &str = "include";
/// Largest number of files of a task.
const MAX_FILES: usize = 100;

/// Reads the files of a task, and inserts the content of included files in place.
pub(crate) struct Inclusion<'a, 'f> {
    pub arena: &'a Arena,
    pub tree: &'f FileTree<'f>,
    pub task: &'f TaskPath,
    pub sources: &'f mut Sources<'a>,
    pub faults: &'f mut Faults,
    loaded: BTreeSet<PathBuf>,
    /// The files that are being read, the outermost first.
    open: Vec<PathBuf>,
    bytes: usize,
    elements: usize,
}

impl<'a, 'f> Inclusion<'a, 'f> {
    pub fn new(
        arena: &'a Arena,
        tree: &'f FileTree<'f>,
        task: &'f TaskPath,
        sources: &'f mut Sources<'a>,
        faults: &'f mut Faults,
    ) -> Self {
        Self {
            arena,
            tree,
            task,
            sources,
            faults,
            loaded: BTreeSet::new(),
            open: Vec::new(),
            bytes: 0,
            elements: 0,
        }
    }

    /// The root of the task file, with the files that it includes.
    pub fn task(mut self, bytes: &'a [u8]) -> Option<Element<'a>> {
        self.document(self.task, bytes)
    }

    fn document(&mut self, file: &TaskPath, bytes: &'a [u8]) -> Option<Element<'a>> {
        self.bytes += bytes.len();
        let decoded = decode(bytes);
        let source = self.sources.add(&file.shown, decoded.text);
        self.loaded.insert(file.true_path.clone());
        let mut root = document::root(&decoded, source, self.faults)?;
        self.elements += root.count();
        if self.elements > MAX_ELEMENTS {
            let problem = "the files have too many elements; this one is left out";
            let expected = format_args!("at most {MAX_ELEMENTS} elements");
            self.faults.report(root.place(), problem, expected);
            root.children.clear();
        }
        self.open.push(file.true_path.clone());
        for child in std::mem::take(&mut root.children) {
            if child.name == INCLUDE && child.is_of_the_language() {
                root.children
                    .extend(self.include(&child, file).unwrap_or_default());
            } else {
                root.children.push(child);
            }
        }
        self.open.pop();
        Some(root)
    }

    /// The content of an included file; `None` if it is already included, or cannot be, and a fault has the reason.
    fn include(&mut self, element: &Element, naming: &TaskPath) -> Option<Vec<Element<'a>>> {
        for child in &element.children {
            let problem = "it cannot stand in <include>";
            self.faults
                .report(child.place(), problem, "no element in <include>");
        }
        let mut attributes = AttributeReader::of(element, self.faults);
        let written = attributes.require("file", String::new(), "path", |text| Ok(text.to_owned()));
        let written = attributes.finish(Some(written))?;
        let place = element.place_of("file");
        let file = match self.tree.find(self.task, naming, &written) {
            Ok(file) => file,
            Err(error) => {
                self.faults.report(place, error.problem, error.expected);
                return None;
            }
        };
        if self.open.contains(&file.true_path) {
            let problem = format_args!("`{}` includes itself", Excerpt(&written));
            let expected = "files that do not include each other";
            self.faults.report(place, problem, expected);
            return None;
        }
        if self.loaded.contains(&file.true_path) {
            return None;
        }
        if self.loaded.len() >= MAX_FILES {
            let problem = "too many files are included";
            self.faults
                .report(place, problem, format_args!("at most {MAX_FILES} files"));
            return None;
        }
        let left = MAX_FILE_BYTES.saturating_sub(self.bytes);
        match self.tree.read(&file, left) {
            Ok(bytes) if bytes.len() > left => {
                let problem = "the files are too large together";
                let expected = format_args!("at most {MAX_FILE_BYTES} bytes");
                self.faults.report(place, problem, expected);
                None
            }
            Ok(bytes) => {
                let root = self.document(&file, self.arena.keep(bytes))?;
                Some(root.children)
            }
            Err(error) => {
                let problem = format_args!("it cannot be read: {error}");
                self.faults
                    .report(place, problem, "a file that can be read");
                None
            }
        }
    }
}
