//! Triangles as the surface of a solid.

use std::collections::HashMap;

use bevy::math::Vec3;
use tabletop_core::MeshSpec;
use tabletop_geometry::{Polyhedron, PolyhedronError};

use crate::{Triangle, error::MeshFileError, limits::MAX_STL_BYTES, stl::read_stl};

/// The surface in an STL file: its first solid. Its axes become those of an object as in the later program: the file's Y is up, its Z
/// towards the user. If it is inside out, it is turned.
///
/// # Errors
/// The bytes are not an STL file, or have no triangle with an area, or more than [`MeshSpec::MOST_TRIANGLES`].
pub fn surface(bytes: &[u8]) -> Result<Polyhedron, MeshFileError> {
    if bytes.len() > MAX_STL_BYTES {
        return Err(MeshFileError::TooLarge);
    }
    let solids = read_stl(bytes, MeshSpec::MOST_TRIANGLES)?;
    let first = solids.first().ok_or(PolyhedronError::Empty)?;
    let (corners, mut triangles) = welded(first);
    let surface = Polyhedron::new(corners.clone(), triangles.clone())?;
    if surface.volume() >= 0.0 {
        return Ok(surface);
    }
    for triangle in &mut triangles {
        triangle.swap(1, 2);
    }
    Ok(Polyhedron::new(corners, triangles)?)
}

/// Corners in the axes of an object, each once, and the triangles between three of them.
fn welded(triangles: &[Triangle]) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut corners = Vec::new();
    let mut known = HashMap::new();
    let mut indices = Vec::new();
    for triangle in triangles {
        let triangle = triangle.map(|Vec3 { x, y, z }| {
            // Zeros of both signs are the same place.
            let place = Vec3::new(x, -z, y) + Vec3::ZERO;
            *known
                .entry(place.to_array().map(f32::to_bits))
                .or_insert_with(|| {
                    corners.push(place);
                    corners.len() as u32 - 1
                })
        });
        let [a, b, c] = triangle;
        if a != b && b != c && c != a {
            indices.push(triangle);
        }
    }
    (corners, indices)
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
    fn both_kinds_of_file_are_the_same_surface() -> Result<(), MeshFileError> {
        let pyramid = surface(&ascii(&FACETS))?;
        assert_eq!(surface(&binary(&FACETS))?, pyramid);
        assert_eq!(pyramid.corners().len(), 4);
        assert!((pyramid.volume() - 1.0 / 6.0).abs() < 1e-6);
        // Its tip is up, and the file's Z is towards the user.
        assert_eq!(pyramid.farthest(Vec3::Z), Vec3::Z);
        assert_eq!(pyramid.farthest(Vec3::NEG_Y), Vec3::NEG_Y);
        Ok(())
    }

    #[test]
    fn a_surface_that_is_inside_out_is_turned() -> Result<(), MeshFileError> {
        let turned = FACETS.map(|[a, b, c]| [a, c, b]);
        assert!(surface(&ascii(&turned))?.volume() > 0.0);
        Ok(())
    }

    #[test]
    fn malformed_meshes_are_refused_with_the_reason() {
        let reason = |bytes: &[u8]| match surface(bytes) {
            Ok(found) => panic!("{found:?}"),
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
        assert_eq!(reason(&binary(&far)), "a corner is not a finite location");
        assert_eq!(
            reason(&vec![0; MAX_STL_BYTES + 1]),
            "it is larger than 16777216 bytes"
        );
    }
}
