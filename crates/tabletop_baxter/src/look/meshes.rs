//! The meshes that descriptions of robots name.

use std::{
    fs, io,
    path::{Path, PathBuf},
    sync::Arc,
};

use bevy::math::Vec3;
use mesh_loader::Loader;
use tabletop_core::{Figure, Rgb, Triangles};

use super::{LookError, hull::Hull, parts::PARTS, shape_file::ShapeFile};

/// How the shapes that are part of the program are named.
const OUR_PACKAGE: &str = "package://tabletop/";

/// Meshes of more triangles than this have fewer where the head camera sees them.
const COARSE_TRIANGLES: usize = 400;

/// Into how many cells the longest side of such a mesh is divided.
const COARSE_CELLS: f32 = 24.0;

/// Coordinates beyond this, in m, cannot be drawn.
const FARTHEST: f32 = 1e6;

/// What a mesh looks like, in units. `urdf` is the file of the description that names it, if there is one. Meshes without
/// colours have this one.
pub(super) fn figure(
    file: &str,
    scale: Vec3,
    color: Rgb,
    urdf: Option<&Path>,
) -> Result<Figure, LookError> {
    let ours = file.strip_prefix(OUR_PACKAGE).and_then(|name| {
        let known = PARTS.iter().find(|(known, _)| *known == name);
        known.map(|(_, text)| *text)
    });
    if let Some(text) = ours {
        return shape(file, text);
    }
    let path = find(file, urdf)?;
    let failed = |source| LookError::Mesh {
        path: path.clone(),
        source,
    };
    if file.ends_with(".shape.json") {
        return shape(file, &fs::read_to_string(&path).map_err(failed)?);
    }
    let parts = load(&path, scale, color).map_err(failed)?;
    if parts.is_empty() {
        return Err(LookError::Empty { path });
    }
    let fine = Arc::new(shaded(&parts));
    let coarse = if fine.indices.len() > COARSE_TRIANGLES {
        shaded(&simplified(&parts)).into()
    } else {
        Arc::clone(&fine)
    };
    Ok(Figure { fine, coarse })
}

fn shape(file: &str, text: &str) -> Result<Figure, LookError> {
    let shape = ShapeFile::read(text).map_err(|source| LookError::Shape {
        file: file.to_owned(),
        source,
    })?;
    Ok(shape.figure())
}

/// The surfaces of a mesh file, in m.
fn load(path: &Path, scale: Vec3, color: Rgb) -> io::Result<Vec<(Hull, Rgb)>> {
    let scene = Loader::default().load(path)?;
    let is_mirrored = scale.x * scale.y * scale.z < 0.0;
    let parts = scene.meshes.iter().zip(0..).filter_map(|(mesh, i)| {
        let corners = mesh.faces.iter().filter_map(|face| {
            let mut corners = [Vec3::ZERO; 3];
            for (corner, i) in corners.iter_mut().zip(face) {
                let point = Vec3::from(*mesh.vertices.get(*i as usize)?) * scale;
                *corner = point.abs().cmple(Vec3::splat(FARTHEST)).all().then_some(point)?;
            }
            if is_mirrored {
                corners.swap(1, 2);
            }
            Some(corners)
        });
        let hull = Hull::welded(corners);
        let material: Option<&mesh_loader::Material> = scene.materials.get::<usize>(i);
        let own = material.and_then(|material| material.color.diffuse);
        let color = own.map_or(color, |[red, green, blue, _]| Rgb::new(red, green, blue));
        (!hull.triangles.is_empty()).then_some((hull, color))
    });
    Ok(parts.collect())
}

fn simplified(parts: &[(Hull, Rgb)]) -> Vec<(Hull, Rgb)> {
    let extent = |(hull, _): &(Hull, Rgb)| {
        let [least, most] = hull.bounds();
        (most - least).max_element()
    };
    let longest = parts.iter().map(extent).fold(f32::MIN_POSITIVE, f32::max);
    let coarse = |(hull, color): &(Hull, Rgb)| (hull.simplified(longest / COARSE_CELLS), *color);
    parts.iter().map(coarse).collect()
}

fn shaded(parts: &[(Hull, Rgb)]) -> Triangles {
    let mut surface = Triangles::default();
    for (hull, color) in parts {
        surface.append(&hull.shaded(*color));
    }
    surface
}

/// The file that a description names: `package://NAME/rest` is looked for as `NAME/rest` and, where the folder is called
/// NAME itself, as `rest`, in the folders around the description from the inside out; other names are relative to it.
fn find(file: &str, urdf: Option<&Path>) -> Result<PathBuf, LookError> {
    let folder = urdf.map(|urdf| urdf.parent().unwrap_or(Path::new("")));
    let mut searched = Vec::new();
    let candidates: Vec<PathBuf> = if let Some(rest) = file.strip_prefix("package://") {
        let (package, inside) = rest.split_once('/').unwrap_or((rest, ""));
        let around = folder.into_iter().flat_map(Path::ancestors);
        around
            .flat_map(|folder| {
                let is_package = folder.file_name().is_some_and(|name| name == package);
                let own = is_package.then(|| folder.join(inside));
                own.into_iter().chain([folder.join(package).join(inside)])
            })
            .collect()
    } else {
        let path = Path::new(file.strip_prefix("file://").unwrap_or(file));
        match folder {
            Some(folder) => vec![folder.join(path)],
            None if path.is_absolute() => vec![path.to_owned()],
            None => Vec::new(),
        }
    };
    for path in candidates {
        if path.is_file() {
            return Ok(path);
        }
        searched.push(path);
    }
    Err(LookError::Missing {
        file: file.to_owned(),
        searched,
    })
}
