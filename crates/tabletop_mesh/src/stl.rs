//! STL files, ASCII and binary.

use std::{collections::HashMap, io};

use bevy::math::Vec3;
use tabletop_core::{MeshError, MeshSpec, Polyhedron, PolyhedronError};

/// Largest size of a file, in bytes: 16 MiB.
pub const MAX_STL_BYTES: usize = 16 << 20;

/// The error of a file that is no mesh.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StlError {
    /// It has more than [`MAX_STL_BYTES`].
    #[error("it is larger than {MAX_STL_BYTES} bytes")]
    TooLarge,
    /// It is not written as STL.
    #[error("it is no STL file: {0}")]
    Syntax(#[source] io::Error),
    /// Its content is no surface.
    #[error(transparent)]
    Surface(#[from] PolyhedronError),
    /// Its content is too large, or no solid.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

/// The surface in a file: its first solid. Its axes become those of an object as in the later program: the file's Y is up, its Z towards
/// the user. If it is inside out, it is turned.
///
/// # Errors
/// The bytes are not an STL file, or have no triangle with an area, or more than [`MeshSpec::MOST_TRIANGLES`].
pub fn read_stl(bytes: &[u8]) -> Result<Polyhedron, StlError> {
    if bytes.len() > MAX_STL_BYTES {
        return Err(StlError::TooLarge);
    }
    let scene = mesh_loader::stl::from_slice(bytes).map_err(StlError::Syntax)?;
    let Some(mesh) = scene.meshes.first() else {
        return Err(PolyhedronError::Empty.into());
    };
    if mesh.faces.len() > MeshSpec::MOST_TRIANGLES {
        return Err(MeshError::TooManyTriangles.into());
    }
    let mut corners = Vec::new();
    let mut known = HashMap::new();
    let mut triangles = Vec::new();
    for face in &mesh.faces {
        let mut triangle = [0; 3];
        for (corner, &index) in triangle.iter_mut().zip(face) {
            let vertex = mesh.vertices.get(index as usize);
            let [x, y, z] = *vertex.ok_or(PolyhedronError::NoCorner)?;
            // Zeros of both signs are the same place.
            let place = Vec3::new(x, -z, y) + Vec3::ZERO;
            *corner = *known
                .entry(place.to_array().map(f32::to_bits))
                .or_insert_with(|| {
                    corners.push(place);
                    corners.len() as u32 - 1
                });
        }
        let [a, b, c] = triangle;
        if a != b && b != c && c != a {
            triangles.push(triangle);
        }
    }
    let surface = Polyhedron::new(corners.clone(), triangles.clone())?;
    if surface.volume() >= 0.0 {
        return Ok(surface);
    }
    for triangle in &mut triangles {
        triangle.swap(1, 2);
    }
    Ok(Polyhedron::new(corners, triangles)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pyramid whose tip is at the file's Y 1.
    const FACETS: [[[f32; 3]; 3]; 4] = [
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
        [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]],
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    ];

    fn ascii(facets: &[[[f32; 3]; 3]]) -> Vec<u8> {
        let mut text = "solid pyramid\n".to_owned();
        for facet in facets {
            text += "facet normal 0 0 0\nouter loop\n";
            for [x, y, z] in facet {
                text += &format!("vertex {x} {y} {z}\n");
            }
            text += "endloop\nendfacet\n";
        }
        (text + "endsolid pyramid\n").into_bytes()
    }

    fn binary(facets: &[[[f32; 3]; 3]]) -> Vec<u8> {
        let mut bytes = vec![0; 80];
        bytes.extend((facets.len() as u32).to_le_bytes());
        for facet in facets {
            bytes.extend([0; 12]);
            let numbers = facet.iter().flatten();
            bytes.extend(numbers.flat_map(|number| number.to_le_bytes()));
            bytes.extend([0; 2]);
        }
        bytes
    }

    #[test]
    fn both_kinds_of_file_are_the_same_surface() -> Result<(), StlError> {
        let surface = read_stl(&ascii(&FACETS))?;
        assert_eq!(read_stl(&binary(&FACETS))?, surface);
        assert_eq!(surface.corners().len(), 4);
        assert!((surface.volume() - 1.0 / 6.0).abs() < 1e-6);
        // Its tip is up, and the file's Z is towards the user.
        assert_eq!(surface.farthest(Vec3::Z), Vec3::Z);
        assert_eq!(surface.farthest(Vec3::NEG_Y), Vec3::NEG_Y);
        Ok(())
    }

    #[test]
    fn a_surface_that_is_inside_out_is_turned() -> Result<(), StlError> {
        let turned = FACETS.map(|[a, b, c]| [a, c, b]);
        assert!(read_stl(&ascii(&turned))?.volume() > 0.0);
        Ok(())
    }

    #[test]
    fn what_is_no_mesh_is_refused_with_the_reason() {
        let reason = |bytes: &[u8]| match read_stl(bytes) {
            Ok(surface) => panic!("{surface:?}"),
            Err(error) => error.to_string(),
        };
        let cut = ascii(&FACETS);
        let cut = reason(&cut[..cut.len() / 2]);
        assert!(cut.starts_with("it is no STL file: "), "{cut}");
        let short = binary(&FACETS);
        assert!(reason(&short[..100]).starts_with("it is no STL file: "));
        assert_eq!(reason(&ascii(&[])), "it has no triangles");
        assert_eq!(reason(&ascii(&[[[0.0; 3]; 3]])), "it has no triangles");
        let far = [[[0.0; 3], [1e9, 0.0, 0.0], [0.0, 1.0, 0.0]]];
        assert_eq!(reason(&binary(&far)), "a corner is not a place");
        assert_eq!(
            reason(&vec![0; MAX_STL_BYTES + 1]),
            "it is larger than 16777216 bytes"
        );
    }
}
