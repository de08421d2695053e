//! Meshes that descriptions of robots name.

use std::{collections::BTreeMap, io, sync::Arc};

use bevy::math::Vec3;
use tabletop_core::Figure;
use tabletop_geometry::{Rgb, Triangles};
use tabletop_kinematics::{Geometry, LinkShape};
use tabletop_mesh::{ColoredTriangles, MeshFileError, Triangle, read_collada, read_obj, read_stl};
use tabletop_storage::{Symlinks, read_regular_file, read_regular_text};

use super::{
    error::LookError, hull::Hull, mesh_path::find, shape_file::read_shape, shipped::PARTS,
};
use crate::source::DescriptionSource;

/// Prefix of the names of the program's own shapes.
const OUR_PACKAGE: &str = "package://tabletop/";

/// Size of the largest file that is read.
const MOST_BYTES: u64 = 64 << 20;

/// Most triangles of a mesh.
const MOST_TRIANGLES: usize = 1_000_000;

/// Number of triangles beyond which a mesh is simplified for the head camera.
const COARSE_TRIANGLES: usize = 400;

/// Number of cells along the longest side of such a mesh.
const COARSE_CELLS: f32 = 24.0;

/// Largest coordinate, in m, that can be drawn.
const FARTHEST: f32 = 1e6;

/// True if a shape is one of the program's own.
pub(crate) fn is_ours(shape: &LinkShape) -> bool {
    matches!(&shape.geometry, Geometry::Mesh { file, .. } if file.starts_with(OUR_PACKAGE))
}

/// The figure of a mesh, in units. `source` is the description that names it, if it was read from files. What has no colour in the mesh
/// has this one.
pub(super) fn figure(
    file: &str,
    scale: Vec3,
    color: Rgb,
    source: Option<&DescriptionSource>,
) -> Result<Figure, LookError> {
    let ours = file.strip_prefix(OUR_PACKAGE).and_then(|name| {
        let known = PARTS.iter().find(|(known, _)| *known == name);
        known.map(|(_, text)| *text)
    });
    if let Some(text) = ours {
        return shape(file, text);
    }
    let path = find(file, source)?;
    let failed = |source| LookError::Mesh {
        path: path.clone(),
        source,
    };
    if file.ends_with(".shape.json") {
        let text = read_regular_text(&path, MOST_BYTES, Symlinks::Followed).map_err(failed)?;
        return shape(file, &text);
    }
    let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
    let read: fn(&[u8]) -> Result<Vec<ColoredTriangles>, MeshFileError> = match extension.to_str() {
        Some("stl") => |bytes| Ok(colorless(read_stl(bytes, MOST_TRIANGLES)?.concat())),
        Some("obj") => |bytes| read_obj(bytes, MOST_TRIANGLES).map(colorless),
        Some("dae") => |bytes| read_collada(bytes, MOST_TRIANGLES),
        _ => {
            let kinds = "only STL, OBJ and COLLADA files (.dae) can be read; Blender, for example, converts others";
            return Err(failed(io::Error::other(kinds)));
        }
    };
    let parts = read_regular_file(&path, MOST_BYTES, Symlinks::Followed)
        .and_then(|bytes| read(&bytes).map_err(io::Error::other))
        .map_err(failed)?;
    let hulls = hulls(parts, scale, color);
    let fine = Arc::new(shaded(&hulls));
    if fine.indices.is_empty() {
        return Err(LookError::Empty { path });
    }
    let coarse = if fine.indices.len() > COARSE_TRIANGLES {
        shaded(&simplified(&hulls)).into()
    } else {
        Arc::clone(&fine)
    };
    Ok(Figure { fine, coarse })
}

fn shape(file: &str, text: &str) -> Result<Figure, LookError> {
    read_shape(text).map_err(|source| LookError::Shape {
        file: file.to_owned(),
        source,
    })
}

fn colorless(triangles: Vec<Triangle>) -> Vec<ColoredTriangles> {
    vec![ColoredTriangles {
        color: None,
        triangles,
    }]
}

/// A surface for each colour.
fn hulls(parts: Vec<ColoredTriangles>, scale: Vec3, color: Rgb) -> Vec<(Hull, Rgb)> {
    let mut of_color: Vec<(Rgb, Vec<Triangle>)> = Vec::new();
    let mut places = BTreeMap::new();
    for part in parts {
        let color = part.color.unwrap_or(color);
        let place = *places.entry(color.to_bytes()).or_insert_with(|| {
            of_color.push((color, Vec::new()));
            of_color.len() - 1
        });
        of_color[place].1.extend(part.triangles);
    }
    let hulls = of_color.into_iter();
    hulls
        .map(|(color, triangles)| (welded(&triangles, scale), color))
        .collect()
}

fn shaded(hulls: &[(Hull, Rgb)]) -> Triangles {
    let mut all = Triangles::default();
    for (hull, color) in hulls {
        all.append(&hull.shaded(*color));
    }
    all
}

/// The surface of these triangles, in m.
fn welded(triangles: &[Triangle], scale: Vec3) -> Hull {
    let is_mirrored = scale.x * scale.y * scale.z < 0.0;
    let can_be_drawn = |point: &Vec3| point.abs().cmple(Vec3::splat(FARTHEST)).all();
    let scaled = triangles.iter().map(|corners| {
        let [a, b, c] = corners.map(|point| point * scale);
        match is_mirrored {
            true => [a, c, b],
            false => [a, b, c],
        }
    });
    Hull::welded(scaled.filter(|corners| corners.iter().all(can_be_drawn)))
}

fn simplified(hulls: &[(Hull, Rgb)]) -> Vec<(Hull, Rgb)> {
    let bounds = hulls.iter().map(|(hull, _)| hull.bounds());
    let whole = bounds.reduce(|[least, most], [low, high]| [least.min(low), most.max(high)]);
    let [least, most] = whole.unwrap_or_default();
    let longest = (most - least).max_element().max(f32::MIN_POSITIVE);
    let simpler = hulls.iter();
    simpler
        .map(|(hull, color)| (hull.simplified(longest / COARSE_CELLS), *color))
        .collect()
}

#[cfg(test)]
mod tests {
    use std::{fs, path::PathBuf};

    use tabletop_core::Reach;

    use super::*;

    /// A folder of its own for each test, with files in it.
    struct MeshFolder(PathBuf);

    impl MeshFolder {
        fn with(name: &str, files: &[(&str, &str)]) -> Self {
            let folder =
                std::env::temp_dir().join(format!("tabletop-{name}-{}", std::process::id()));
            for (path, text) in files {
                let path = folder.join(path);
                fs::create_dir_all(path.parent().unwrap()).unwrap();
                fs::write(path, text).unwrap();
            }
            Self(folder)
        }

        fn look(&self, file: &str, urdf: &str) -> Result<Figure, LookError> {
            self.look_within(file, urdf, None)
        }

        fn look_within(
            &self,
            file: &str,
            urdf: &str,
            reach: Option<Reach>,
        ) -> Result<Figure, LookError> {
            let source = DescriptionSource {
                path: self.0.join(urdf),
                urdf: String::new(),
                layout: None,
                reach,
            };
            figure(file, Vec3::new(1.0, 2.0, -1.0), Rgb::WHITE, Some(&source))
        }
    }

    impl Drop for MeshFolder {
        fn drop(&mut self) {
            fs::remove_dir_all(&self.0).unwrap();
        }
    }

    const STL: &str = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n\
        endloop\nendfacet\nendsolid a\n";
    const OBJ: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    const DAE: &str = "<COLLADA><library_geometries><geometry id='g'><mesh>\
        <source id='s'><float_array>0 0 0 1 0 0 0 1 0</float_array>\
        <technique_common><accessor stride='3'/></technique_common></source>\
        <vertices id='v'><input semantic='POSITION' source='#s'/></vertices>\
        <triangles><input semantic='VERTEX' source='#v'/><p>0 1 2</p></triangles></mesh></geometry></library_geometries>\
        <library_visual_scenes><visual_scene><node><instance_geometry url='#g'/></node></visual_scene></library_visual_scenes></COLLADA>";

    #[test]
    fn meshes_are_read_scaled_and_keep_their_outside_outside() {
        let folder = MeshFolder::with("kinds", &[("a.stl", STL), ("a.obj", OBJ), ("a.DAE", DAE)]);
        for file in ["a.stl", "a.obj", "a.DAE"] {
            let figure = folder.look(file, "robot.urdf").unwrap();
            let surface = &*figure.fine;
            assert_eq!(surface.indices.len(), 1, "{file}");
            // From m to units, and mirrored.
            let farthest = surface
                .positions
                .iter()
                .copied()
                .fold(Vec3::ZERO, Vec3::max);
            assert_eq!(farthest, Vec3::new(10.0, 20.0, 0.0), "{file}");
            assert_eq!(surface.normals, [Vec3::NEG_Z; 3], "{file}");
            assert_eq!(surface.colors, [Rgb::WHITE; 3], "{file}");
            assert!(Arc::ptr_eq(&figure.fine, &figure.coarse));
        }
    }

    #[test]
    fn packages_are_found_in_the_folders_around_the_description() {
        let folder = MeshFolder::with("packages", &[("arm_description/meshes/a.stl", STL)]);
        for urdf in [
            "robot.urdf",
            "arm_description/robot.urdf",
            "arm_description/urdf/robot.urdf",
            "other/urdf/robot.urdf",
        ] {
            let file = "package://arm_description/meshes/a.stl";
            assert!(folder.look(file, urdf).is_ok(), "{urdf}");
        }
        assert!(
            folder
                .look("../meshes/a.stl", "arm_description/urdf/robot.urdf")
                .is_err()
        );
        fs::create_dir(folder.0.join("arm_description/urdf")).unwrap();
        assert!(
            folder
                .look("../meshes/a.stl", "arm_description/urdf/robot.urdf")
                .is_ok()
        );
    }

    #[test]
    fn a_strangers_description_names_meshes_within_reach_alone() {
        let files = [("demo/robot/in.stl", STL), ("arm/out.stl", STL)];
        let folder = MeshFolder::with("reach", &files);
        let reach = |place: &str| Some(Reach::of([folder.0.join(place)]));
        let look = |file: &str, place: &str| {
            folder.look_within(file, "demo/robot/robot.urdf", reach(place))
        };
        assert!(look("in.stl", "demo").is_ok());
        let absolute = folder.0.join("arm/out.stl");
        for outside in [
            "../../arm/out.stl",
            "package://arm/out.stl",
            absolute.to_str().unwrap(),
        ] {
            let error = look(outside, "demo").unwrap_err().to_string();
            assert!(error.contains("--allow-path"), "{error}");
            assert!(look(outside, "arm").is_ok(), "{outside}");
        }
    }

    #[test]
    fn a_mesh_that_cannot_be_drawn_is_an_error_that_names_the_file() {
        let broken = [
            ("broken.stl", "solid a\nfacet normal 0 0"),
            ("empty.stl", "solid a\nendsolid a\n"),
            ("far.obj", "v 0 0 0\nv 1e30 0 0\nv 0 1 nan\nf 1 2 3\n"),
            ("wrong.obj", "v 0 0 0\nf 1 2 9\n"),
            ("other.dae", "<COLLADA><library_geometries>"),
            ("text.txt", "what?"),
            ("a.shape.json", "{}"),
        ];
        let folder = MeshFolder::with("broken", &broken);
        for (file, _) in broken.iter().chain([&("missing.stl", "")]) {
            let error = folder.look(file, "robot.urdf").unwrap_err().to_string();
            assert!(error.contains(file), "{error}");
        }
        let missing = figure("package://a/b.stl", Vec3::ONE, Rgb::WHITE, None).unwrap_err();
        assert!(missing.to_string().contains("not in a file"), "{missing}");
    }

    #[test]
    fn a_mesh_of_many_triangles_has_fewer_for_the_head_camera() {
        let mut text = String::new();
        for i in 0..2000 {
            let (x, y) = (i % 50, i / 50);
            for (x, y) in [(x, y), (x + 1, y), (x, y + 1)] {
                text += &format!("v {} {} 0\n", f64::from(x) * 0.01, f64::from(y) * 0.01);
            }
            text += &format!("f {} {} {}\n", 3 * i + 1, 3 * i + 2, 3 * i + 3);
        }
        let folder = MeshFolder::with("many", &[("a.obj", &text)]);
        let figure = folder.look("a.obj", "robot.urdf").unwrap();
        assert_eq!(figure.fine.indices.len(), 2000);
        assert!((200..800).contains(&figure.coarse.indices.len()));
    }
}
