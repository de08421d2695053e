//! Robots of files.

use std::{
    fmt, io,
    path::{Component, Path, PathBuf},
};

use tabletop_core::{LayoutError, LayoutFile, Reach};
use tabletop_robot::{Description, DescriptionError, DescriptionSource};

use crate::shipped::{ROBOT_FOLDER, read_text, shipped_files, true_path};

/// The error of a robot that cannot be read: its file, and the fault.
#[derive(Debug)]
pub struct RobotFileError {
    path: PathBuf,
    fault: RobotFault,
}

#[derive(Debug)]
enum RobotFault {
    Unreadable(io::Error),
    Layout(LayoutError),
    Description(DescriptionError),
    /// Its URDF, which is out of its folder.
    Outside(String),
}

impl fmt::Display for RobotFileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let RobotFault::Description(error @ DescriptionError::Urdf { .. }) = &self.fault {
            // It names the URDF, not the `robot.ron` beside it.
            return error.fmt(f);
        }
        write!(f, "{}: ", self.path.display())?;
        match &self.fault {
            RobotFault::Unreadable(error) => {
                let way_on = shipped_files().way_on(&self.path, &[ROBOT_FOLDER]);
                write!(f, "{error}{way_on}")
            }
            RobotFault::Layout(error)
            | RobotFault::Description(DescriptionError::Layout(error)) => error.fmt(f),
            RobotFault::Description(error) => error.fmt(f),
            RobotFault::Outside(urdf) => write!(
                f,
                "its URDF {urdf} leads out of its folder; expected a file there or below"
            ),
        }
    }
}

impl std::error::Error for RobotFileError {}

/// Reads a `robot.ron` and the URDF beside it, or a URDF of a robot with Baxter's limbs and joints, from the folder or the program.
///
/// ```
/// use std::path::Path;
///
/// let panda = tabletop_sim::robots::read_robot(Path::new("assets/panda/robot.ron"))?;
/// assert_eq!(panda.layout.limbs.len(), 1);
/// # Ok::<_, tabletop_sim::robots::RobotFileError>(())
/// ```
///
/// # Errors
///
/// A file cannot be read, has a fault, or is out of the folder of the `robot.ron`.
pub fn read_robot(path: &Path) -> Result<Description, RobotFileError> {
    let at = |path: &Path, fault| RobotFileError {
        path: path.to_owned(),
        fault,
    };
    let read =
        |path: &Path| read_text(path).map_err(|error| at(path, RobotFault::Unreadable(error)));
    let text = read(path)?;
    let source = match path.extension().is_some_and(|extension| extension == "ron") {
        true => {
            let file =
                LayoutFile::read(&text).map_err(|error| at(path, RobotFault::Layout(error)))?;
            let urdf = path.with_file_name(&file.urdf);
            if !is_beside(Path::new(&file.urdf)) || is_linked_away(path, &urdf) {
                return Err(at(path, RobotFault::Outside(file.urdf)));
            }
            DescriptionSource {
                urdf: read(&urdf)?,
                path: true_path(&urdf),
                layout: Some(text),
                reach: None,
            }
        }
        false => DescriptionSource {
            path: true_path(path),
            urdf: text,
            layout: None,
            reach: None,
        },
    };
    Description::read(source).map_err(|error| at(path, RobotFault::Description(error)))
}

/// True if a path stays in the folder that it begins in.
fn is_beside(path: &Path) -> bool {
    let mut components = path.components();
    components.all(|component| matches!(component, Component::Normal(_) | Component::CurDir))
}

/// True if links lead from a file beside a `robot.ron` to another folder. A missing file is left to its reader.
fn is_linked_away(robot: &Path, file: &Path) -> bool {
    let is_on_disk = shipped_files().find(file).is_none() && file.exists();
    is_on_disk && !Reach::of(robot.parent()).contains(file)
}
