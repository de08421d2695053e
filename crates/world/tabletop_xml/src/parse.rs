//! Task files as scenes.

use std::path::{Path, PathBuf};

use tabletop_core::SceneSpec;

use crate::{
    document::{ROOT, build, decode::decode, tree::Element},
    elements::{self, mesh_files::MeshFiles},
    expansion::{self, Inclusion},
    fault::{Fault, Faults, Place},
    files::{Arena, FileTree, MAX_FILE_BYTES, TaskPath},
    origin::Sources,
    write::expanded::write_expanded,
};

/// A parsed task file: its scene and its faults.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ParsedTask {
    /// The table and the elements without faults.
    pub scene: SceneSpec,
    /// The faults, in the order of the files.
    pub faults: Vec<Fault>,
    /// The files that were read: the task file, then its includes, then its meshes. A change of any of them can change the scene.
    pub files: Vec<PathBuf>,
}

/// An expanded task file: without `<include>`, `<def>`, `<instance>`, `<var>` and expressions.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ExpandedTask {
    /// The text, which [reads](parse) as the same scene. Broken parts that have no effect are left out.
    pub text: String,
    /// The faults of the task file.
    pub faults: Vec<Fault>,
}

/// Reads the content of a task file (report section 6.2). It never fails: faulty parts are skipped, and there is
/// always a table. `file` only names the file in the faults.
///
/// ```
/// use std::path::Path;
///
/// let text = br#"<tabletop xmlns="http://synapse.cs.umd.edu/tabletop-xml">
///   <block location="(0,0,0.5)"/>
///   <sphere location="(2,0,0.5)" radius="large"/>
/// </tabletop>"#;
/// let task = tabletop_xml::parse(Path::new("task.xml"), text);
/// assert_eq!(task.scene.items.len(), 1);
/// assert_eq!(
///     task.faults[0].to_string(),
///     "task.xml:3:32: sphere, radius: `large` is not a number, expected a number from 0.001 to 1000"
/// );
/// ```
pub fn parse(file: &Path, text: &[u8]) -> ParsedTask {
    let tree = FileTree::Absent;
    TaskReading::read(&tree, &tree.task(file), text.to_vec(), &Arena::default()).parsed()
}

/// Expands the content of a task file. It includes nothing: a text has no folder.
///
/// ```
/// use std::path::Path;
///
/// let text = br#"<tabletop xmlns="http://synapse.cs.umd.edu/tabletop-xml">
///   <def name="cube">
///     <var name="side" value="2"/>
///     <block location="($x$,0,$side/2$)" xspan="$side$" yspan="$side$" zspan="$side$"/>
///   </def>
///   <instance def="cube"><var name="x" value="-3"/></instance>
/// </tabletop>"#;
/// let task = tabletop_xml::expand(Path::new("task.xml"), text);
/// assert!(task.faults.is_empty());
/// assert!(task.text.contains(r#"<block location="(-3,0,1)" xspan="2" yspan="2" zspan="2"/>"#));
/// ```
pub fn expand(file: &Path, text: &[u8]) -> ExpandedTask {
    let tree = FileTree::Absent;
    TaskReading::read(&tree, &tree.task(file), text.to_vec(), &Arena::default()).expanded()
}

/// An expanded task.
pub(crate) struct TaskReading<'a, 't> {
    tree: &'t FileTree<'t>,
    path: &'t TaskPath,
    root: Option<Element<'a>>,
    sources: Sources<'a>,
    faults: Faults,
}

impl<'a, 't> TaskReading<'a, 't> {
    pub fn read(
        tree: &'t FileTree<'t>,
        path: &'t TaskPath,
        bytes: Vec<u8>,
        arena: &'a Arena,
    ) -> Self {
        let mut sources = Sources::default();
        let mut faults = Faults::default();
        if bytes.len() > MAX_FILE_BYTES {
            let source = sources.add(&path.shown, "");
            let expected = format_args!("at most {MAX_FILE_BYTES} bytes");
            faults.report(Place::outside(source, 0), "the file is too large", expected);
            return Self {
                tree,
                path,
                root: None,
                sources,
                faults,
            };
        }
        let inclusion = Inclusion::new(arena, tree, path, &mut sources, &mut faults);
        let root = inclusion
            .task(arena.keep(bytes))
            .map(|root| expansion::expand(root, &mut sources, &mut faults));
        Self {
            tree,
            path,
            root,
            sources,
            faults,
        }
    }

    pub fn parsed(mut self) -> ParsedTask {
        let mut files = self.sources.files();
        let mut meshes = MeshFiles::new(self.tree, self.path, &files);
        let scene = match &self.root {
            Some(root) => elements::scene(root, &mut meshes, &mut self.faults),
            None => SceneSpec::default(),
        };
        files.extend(meshes.files());
        ParsedTask {
            scene,
            faults: self.faults.locate(&self.sources),
            files,
        }
    }

    pub fn expanded(mut self) -> ExpandedTask {
        if let Some(root) = &self.root {
            let mut meshes = MeshFiles::new(self.tree, self.path, &self.sources.files());
            elements::scene(root, &mut meshes, &mut self.faults);
        }
        ExpandedTask {
            text: write_expanded(self.root.as_ref(), &self.sources),
            faults: self.faults.locate(&self.sources),
        }
    }
}

/// True if a file is meant to be loaded, even with faults: its root is `<tabletop>`, and it is more than a file of `<def>`s
/// for others to include.
///
/// ```
/// use tabletop_xml::is_task;
///
/// assert!(is_task(b"<tabletop><cube/></tabletop>"));
/// assert!(!is_task(b"<tabletop><def name='lid'/></tabletop>"));
/// assert!(is_task(b"<tabletop><def name='lid'/><instance def='lid'/></tabletop>"));
/// assert!(!is_task(b"<robot/>"));
/// ```
pub fn is_task(text: &[u8]) -> bool {
    let root = build::read(&decode(text), 0, &mut Faults::default());
    root.is_some_and(|root| {
        let has = |name| root.children.iter().any(|child| child.name == name);
        let has_more = root
            .children
            .iter()
            .any(|child| !matches!(child.name, "def" | "include"));
        root.name == ROOT && (has_more || !has("def"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_that_is_too_large_is_one_fault() {
        let task = parse(Path::new("f"), &vec![b' '; MAX_FILE_BYTES + 1]);
        assert_eq!(task.faults.len(), 1);
        assert_eq!(task.scene, SceneSpec::default());
    }
}
