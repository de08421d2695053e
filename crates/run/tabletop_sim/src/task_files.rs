//! The task files of a folder, and the present state as a task file.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use bevy::prelude::World;
use tabletop_scene::{PresentScene, present_scene};
use tabletop_storage::{Storage, Symlinks, read_regular_file};
use tabletop_xml::{MAX_FILE_BYTES, is_task, write};

/// The folder of the task files that the window lists, in the working folder.
pub const TASK_FOLDER: &str = "tablesetup";

/// The task files directly in a folder, by name: without those that only hold templates (`def-*.xml`), and without the
/// `debug.xml` that the later program wrote.
///
/// ```
/// use std::path::Path;
/// use tabletop_sim::task_files::{TASK_FOLDER, task_files};
///
/// let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..").join(TASK_FOLDER);
/// assert!(task_files(&folder).contains(&folder.join("default.xml")));
/// ```
pub fn task_files(folder: &Path) -> Vec<PathBuf> {
    let Ok(found) = fs::read_dir(folder) else {
        return Vec::new();
    };
    let mut files: Vec<_> = found
        .flatten()
        .map(|found| found.path())
        .filter(|path| is_listed(path))
        .collect();
    files.sort();
    files
}

/// True if a file is a task file to be listed, by its name and its content.
pub fn is_task_file(path: &Path, text: &[u8]) -> bool {
    is_task_name(path) && is_task(text)
}

fn is_task_name(path: &Path) -> bool {
    let name = path.file_name().and_then(|name| name.to_str());
    name.is_some_and(|name| {
        name.ends_with(".xml") && !name.starts_with("def-") && name != "debug.xml"
    })
}

fn is_listed(path: &Path) -> bool {
    let read = || read_regular_file(path, MAX_FILE_BYTES as u64, Symlinks::Followed);
    is_task_name(path) && read().is_ok_and(|text| is_task(&text))
}

/// Saves the table as a task file, replacing an existing one. Returns the parts of it that a task file cannot express.
///
/// # Errors
///
/// The file cannot be written; an existing one is unchanged.
pub fn save_task(world: &World, path: &Path) -> io::Result<Vec<String>> {
    save_with(world, |text| Storage::default().replace(path, text))
}

/// Saves the table as a new task file. Returns the parts of it that a task file cannot express.
///
/// # Errors
///
/// Something is there, or the file cannot be written.
pub fn save_new_task(world: &World, path: &Path) -> io::Result<Vec<String>> {
    save_with(world, |text| Storage::default().write_new(path, text))
}

fn save_with(world: &World, save: impl FnOnce(&[u8]) -> io::Result<()>) -> io::Result<Vec<String>> {
    let PresentScene { scene, unsaid } = present_scene(world);
    save(write(&scene).as_bytes())?;
    Ok(unsaid)
}

#[cfg(test)]
mod tests {
    use bevy::prelude::*;
    use tabletop_core::prelude::*;

    use super::*;
    use tabletop_scene::{IdAllocator, assemble};
    use tabletop_storage::TemporaryFolder;
    use tabletop_xml::read_task;

    use crate::headless::headless_app;

    #[test]
    fn task_files_are_listed_by_name_and_templates_are_not() {
        let temporary = TemporaryFolder::new("tabletop-task-files-listed").unwrap();
        let folder = temporary.path();
        let task = "<tabletop xmlns='http://synapse.cs.umd.edu/tabletop-xml'/>";
        for (name, text) in [
            ("b.xml", task),
            ("a.xml", task),
            ("faulty.xml", "<tabletop><cube/>"),
            ("def-lid.xml", task),
            ("debug.xml", task),
            ("template.xml", "<tabletop><def name='lid'/></tabletop>"),
            ("other.xml", "<robot/>"),
            ("notes.txt", task),
            ("none.xml", ""),
        ] {
            fs::write(folder.join(name), text).unwrap();
        }
        fs::create_dir(folder.join("folder.xml")).unwrap();
        let files = task_files(folder);
        let names: Vec<_> = files.iter().map(|path| path.file_name().unwrap()).collect();
        assert_eq!(names, ["a.xml", "b.xml", "faulty.xml"]);
        assert_eq!(task_files(&folder.join("missing")), Vec::<PathBuf>::new());
    }

    /// The largest difference of two scenes' rotations, which are the same otherwise.
    fn deviation(mut one: SceneSpec, other: &SceneSpec) -> f32 {
        let mut largest = 0.0_f32;
        let pose = |item: &SceneItem| match item {
            SceneItem::Object(object) => Some(object.pose),
            SceneItem::LidBox(lidbox) => Some(lidbox.pose),
            SceneItem::Jointed(jointed) => Some(jointed.pose),
            SceneItem::Chain(_) => None,
        };
        for (one, other) in one.items.iter_mut().zip(&other.items) {
            let (Some(mine), Some(theirs)) = (pose(one), pose(other)) else {
                continue;
            };
            let difference = Vec4::from(mine.rotation) - Vec4::from(theirs.rotation);
            largest = largest.max(difference.abs().max_element());
            match one {
                SceneItem::Object(object) => object.pose.rotation = theirs.rotation,
                SceneItem::LidBox(lidbox) => lidbox.pose.rotation = theirs.rotation,
                SceneItem::Jointed(jointed) => jointed.pose.rotation = theirs.rotation,
                SceneItem::Chain(_) => {}
            }
        }
        assert_eq!(one, *other);
        largest
    }

    fn saved(app: &App, path: &Path) -> SceneSpec {
        save_task(app.world(), path).unwrap();
        let task = read_task(path).unwrap();
        assert_eq!(task.faults, []);
        task.scene
    }

    #[test]
    fn a_saved_scene_is_the_same_when_it_is_loaded() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
        let temporary = TemporaryFolder::new("tabletop-task-files-saved").unwrap();
        let folder = temporary.path();
        let path = folder.join("saved.xml");
        fs::copy(root.join("tablesetup/cup.stl"), folder.join("cup.stl")).unwrap();
        for file in task_files(&root.join(TASK_FOLDER)) {
            let mut app = headless_app();
            app.world_mut()
                .write_command(SceneCommand::Load(file.clone()));
            app.step(90);
            let present = present_scene(app.world()).scene;
            let first = saved(&app, &path);
            let off = deviation(first.clone(), &present);
            assert!(off <= 2e-7, "{}: {off}", file.display());
            // A scene from a file survives writing and reading to the bit.
            fs::write(&path, write(&first)).unwrap();
            assert_eq!(read_task(&path).unwrap().scene, first);
            let ids = |scene: &SceneSpec| {
                let assembly = assemble(scene, &mut IdAllocator::default());
                assembly
                    .objects
                    .into_iter()
                    .map(|object| object.id)
                    .collect::<Vec<_>>()
            };
            let index = app.world().resource::<ObjectIndex>();
            let objects = index
                .iter()
                .filter_map(|object| app.world().get::<ObjectSpec>(object));
            let there: Vec<_> = objects.map(|spec| spec.id.clone()).collect();
            assert_eq!(ids(&first), there, "{}", file.display());
        }
    }
}
