//! Where the files are that a description names.
//!
//! ROS finds a package by an index of all that are installed. A description that stands alone has none, so packages are looked for around it.

use std::path::{Path, PathBuf};

use tabletop_storage::{Symlinks, read_regular_text};

use super::error::LookError;
use crate::source::DescriptionSource;

/// Size of the largest `package.xml` that is read.
const MOST_MANIFEST_BYTES: u64 = 1 << 20;

/// Number of folders above a description in whose other folders packages are looked for: those of a workspace, such as
/// `workspace/src/REPOSITORY/PACKAGE/urdf`.
const WORKSPACE_DEPTH: usize = 5;

/// Most folders beside each other in which packages are looked for.
const MOST_SIBLINGS: usize = 1000;

/// The file that a description names.
///
/// `package://NAME/rest` and `model://NAME/rest` are looked for as `NAME/rest` and, where a folder or its `package.xml` is called NAME,
/// as `rest`, in the folders around the description from the inside out, and then in the folders in these. Other names are relative to the
/// description. Backslashes are slashes, and `%20` is a space unless a file has it in its name.
pub(super) fn find(file: &str, source: Option<&DescriptionSource>) -> Result<PathBuf, LookError> {
    let name = file.replace('\\', "/");
    let decoded = percent_decoded(&name);
    let names = [name.as_str(), decoded.as_str()];
    let names = match name == decoded {
        true => &names[..1],
        false => &names[..],
    };
    let mut searched = Vec::new();
    for name in names {
        for path in near(name, source) {
            if path.is_file() {
                return within(path, source);
            }
            searched.push(path);
        }
    }
    let mut beside = names.iter().flat_map(|name| in_siblings(name, source));
    match beside.find(|path| path.is_file()) {
        Some(path) => within(path, source),
        None => Err(LookError::Missing {
            file: file.to_owned(),
            searched,
        }),
    }
}

fn within(path: PathBuf, source: Option<&DescriptionSource>) -> Result<PathBuf, LookError> {
    match source.is_none_or(|source| source.reaches(&path)) {
        true => Ok(path),
        false => Err(LookError::Outside { path }),
    }
}

/// The package and the path in it that a name means.
fn in_package(name: &str) -> Option<(&str, &str)> {
    let rest = ["package://", "model://"]
        .into_iter()
        .find_map(|scheme| name.strip_prefix(scheme))?;
    Some(rest.split_once('/').unwrap_or((rest, "")))
}

/// The places in the description's folder and those around it.
fn near(name: &str, source: Option<&DescriptionSource>) -> Vec<PathBuf> {
    let Some((package, inside)) = in_package(name) else {
        let path = Path::new(name.strip_prefix("file://").unwrap_or(name));
        return match source {
            Some(source) => vec![source.folder().join(path)],
            None if path.is_absolute() => vec![path.to_owned()],
            None => Vec::new(),
        };
    };
    let around = around(source).into_iter();
    around
        .flat_map(|folder| in_folder(&folder, package, inside, source))
        .collect()
}

/// The places of a package's file if the package is this folder or is in it.
fn in_folder(
    folder: &Path,
    package: &str,
    inside: &str,
    source: Option<&DescriptionSource>,
) -> impl Iterator<Item = PathBuf> + use<> {
    let is_called = folder.file_name().is_some_and(|name| name == package);
    let is_it = is_called
        || source.is_some_and(|source| source.reaches(folder)) && is_named(folder, package);
    let own = is_it.then(|| folder.join(inside));
    own.into_iter().chain([folder.join(package).join(inside)])
}

/// The places of a package in the folders beside the description's and beside those around it.
fn in_siblings<'a>(
    name: &'a str,
    source: Option<&'a DescriptionSource>,
) -> impl Iterator<Item = PathBuf> + 'a {
    let package = in_package(name);
    let around = package.map(|_| around(source)).unwrap_or_default();
    let around = around.into_iter().take(WORKSPACE_DEPTH);
    let reached = move |folder: &PathBuf| source.is_some_and(|source| source.reaches(folder));
    let siblings = around
        .flat_map(|folder| folders_in(&folder))
        .filter(reached);
    siblings
        .filter_map(move |folder| Some((folder, package?)))
        .flat_map(move |(folder, (package, inside))| in_folder(&folder, package, inside, source))
}

/// The folder of the description and those above it, from the inside out.
fn around(source: Option<&DescriptionSource>) -> Vec<PathBuf> {
    let folder = source.map(|source| match source.folder() {
        // A relative path begins in the working folder, and the folders above that count, too.
        folder if folder == Path::new("") => std::path::absolute("."),
        folder => std::path::absolute(folder),
    });
    let folder = folder.and_then(Result::ok);
    let around = folder.iter().flat_map(|folder| folder.ancestors());
    around.map(Path::to_owned).collect()
}

/// The folders in a folder, by name.
fn folders_in(folder: &Path) -> Vec<PathBuf> {
    let entries = folder.read_dir().into_iter().flatten().flatten();
    let paths = entries.take(MOST_SIBLINGS).map(|entry| entry.path());
    let mut folders: Vec<_> = paths.filter(|path| path.is_dir()).collect();
    folders.sort();
    folders
}

/// True if the `package.xml` in a folder has this name.
fn is_named(folder: &Path, package: &str) -> bool {
    let manifest = folder.join("package.xml");
    let text = read_regular_text(&manifest, MOST_MANIFEST_BYTES, Symlinks::Followed);
    text.is_ok_and(|text| {
        let name = text
            .split_once("<name>")
            .map(|(_, rest)| rest.split("</name>"));
        name.and_then(|mut name| name.next()).map(str::trim) == Some(package)
    })
}

/// A text with the characters that `%20` and the like stand for; what is no UTF-8 then stays as it is.
fn percent_decoded(text: &str) -> String {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let [first, tail @ ..] = rest {
        let code = tail.get(..2).and_then(|digits| str::from_utf8(digits).ok());
        let code = code.filter(|digits| digits.bytes().all(|digit| digit.is_ascii_hexdigit()));
        let byte = code.and_then(|digits| u8::from_str_radix(digits, 16).ok());
        match (first, byte) {
            (b'%', Some(byte)) => {
                bytes.push(byte);
                rest = &tail[2..];
            }
            _ => {
                bytes.push(*first);
                rest = tail;
            }
        }
    }
    String::from_utf8(bytes).unwrap_or_else(|_| text.to_owned())
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn percent_signs_are_read() {
        for (text, decoded) in [
            ("my%20arm/%C3%A4.stl", "my arm/ä.stl"),
            ("100%", "100%"),
            ("%2", "%2"),
            ("%+1", "%+1"),
            ("%ff", "%ff"),
        ] {
            assert_eq!(percent_decoded(text), decoded);
        }
    }

    #[test]
    fn strangers_names_are_found() {
        let root = std::env::temp_dir().join(format!("tabletop-names-{}", std::process::id()));
        let files = [
            (
                "src/arm_ros/arm description/package.xml",
                "<package>\n<name> arm_description </name></package>",
            ),
            ("src/arm_ros/arm description/meshes/my link.stl", ""),
            (
                "src/grippers/hand/package.xml",
                "<package><name>hand_description</name></package>",
            ),
            ("src/grippers/hand/a.stl", ""),
            ("src/grippers/nested_description/b.stl", ""),
            ("src/arm_ros/arm_meshes/c%20d.stl", ""),
        ];
        for (path, text) in files {
            let path = root.join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        let urdf = root.join("src/arm_ros/arm description/urdf/arm.urdf");
        fs::create_dir_all(urdf.parent().unwrap()).unwrap();
        let source = DescriptionSource {
            path: urdf,
            urdf: String::new(),
            layout: None,
            reach: None,
        };
        for (file, place) in [
            ("package://arm_description/meshes/my%20link.stl", 1),
            ("package://arm_description\\meshes\\my link.stl", 1),
            ("model://arm_description/meshes/my link.stl", 1),
            ("..\\meshes\\my%20link.stl", 1),
            ("package://nested_description/b.stl", 4),
            ("package://arm_meshes/c%20d.stl", 5),
        ] {
            let found = find(file, Some(&source)).map(|path| path.canonicalize().unwrap());
            let expected = root.join(files[place].0).canonicalize().unwrap();
            assert_eq!(found.unwrap(), expected, "{file}");
        }
        let missing = find("package://hand_description/z.stl", Some(&source));
        assert!(missing.is_err());
        fs::remove_dir_all(root).unwrap();
    }

    #[test]
    fn packages_are_found_above_the_working_folder() {
        let source = |path: &str| DescriptionSource {
            path: path.into(),
            urdf: String::new(),
            layout: None,
            reach: None,
        };
        // Tests run in the folder of the crate.
        for path in ["robot.urdf", "src/robot.urdf"] {
            let found = find("package://tabletop_robot/Cargo.toml", Some(&source(path)));
            assert!(found.is_ok(), "{path}: {found:?}");
        }
    }
}
