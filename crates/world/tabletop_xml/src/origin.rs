//! The origin of an element: a place in a file, and the instances that inserted it.

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

use crate::fault::{Position, PositionCursor};

/// The origin of something.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Origin {
    /// The file, as an index into [`Sources`].
    pub source: usize,
    /// The byte in its text.
    pub offset: usize,
    /// The instance that inserted it; absent for an element of the file itself.
    pub instance: Option<InstanceId>,
}

/// An instance of a template, as an index into [`Sources`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct InstanceId(usize);

/// The files of a task, and the instances in them.
#[derive(Debug, Default)]
pub(crate) struct Sources<'a> {
    texts: Vec<(PathBuf, &'a str)>,
    /// The place of each `<instance>`, which another instance may have inserted.
    instances: Vec<Origin>,
}

impl<'a> Sources<'a> {
    /// Notes a file, and returns its index.
    pub fn add(&mut self, file: &Path, text: &'a str) -> usize {
        self.texts.push((file.to_owned(), text));
        self.texts.len() - 1
    }

    /// Notes an instance that is written at a place.
    pub fn add_instance(&mut self, origin: Origin) -> InstanceId {
        self.instances.push(origin);
        InstanceId(self.instances.len() - 1)
    }

    /// The names of all files, in the order in which they were read.
    pub fn files(&self) -> Vec<PathBuf> {
        self.texts.iter().map(|(file, _)| file.clone()).collect()
    }

    /// The instances that inserted it, the innermost first.
    pub fn instances_of(&self, origin: Origin) -> impl Iterator<Item = Origin> + '_ {
        let above = |origin: &Origin| {
            let instance = origin.instance?;
            self.instances.get(instance.0).copied()
        };
        std::iter::successors(above(&origin), above)
    }

    /// The positions of several origins. Each text is gone through once.
    pub fn positions(
        &self,
        origins: impl IntoIterator<Item = Origin>,
    ) -> BTreeMap<(usize, usize), Position> {
        let mut positions: BTreeMap<_, _> = origins
            .into_iter()
            .map(|origin| ((origin.source, origin.offset), Position::default()))
            .collect();
        let mut walk: Option<(usize, PositionCursor)> = None;
        for (&(source, offset), position) in &mut positions {
            let Some((file, text)) = self.texts.get(source) else {
                continue;
            };
            let cursor = match &mut walk {
                Some((walked, cursor)) if *walked == source => cursor,
                other => &mut other.insert((source, PositionCursor::new(text))).1,
            };
            let (line, column) = cursor.advance_to(offset);
            *position = Position {
                file: file.clone(),
                line,
                column,
            };
        }
        positions
    }
}
