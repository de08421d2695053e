//! The surfaces of polyhedra, as they are drawn.

use std::collections::HashMap;

use bevy::prelude::*;

use crate::{
    Rgb, Triangles,
    polyhedron::{Polyhedron, PolyhedronData},
};

impl Polyhedron {
    /// Its surface in a colour. The normals are those of its faces, or of the round surface that it is meant to have.
    pub fn surface(&self, color: Rgb) -> Triangles {
        let PolyhedronData {
            corners,
            triangles,
            crease,
            ..
        } = &*self.0;
        let area = |&[a, b, c]: &[u32; 3]| {
            let [a, b, c] = [a, b, c].map(|corner| corners[corner as usize]);
            (b - a).cross(c - a)
        };
        let areas: Vec<Vec3> = triangles.iter().map(area).collect();
        let normals: Vec<Vec3> = areas.iter().map(|area| area.normalize_or_zero()).collect();
        let mut around = vec![Vec::new(); corners.len()];
        for (index, triangle) in triangles.iter().enumerate() {
            for &corner in triangle {
                around[corner as usize].push(index);
            }
        }
        let mut surface = Triangles::default();
        let mut known = HashMap::new();
        for (index, triangle) in triangles.iter().enumerate() {
            let vertices = triangle.map(|corner| {
                let smooth = around[corner as usize]
                    .iter()
                    .filter(|&&other| normals[other].dot(normals[index]) >= *crease)
                    .map(|&other| areas[other]);
                let normal = smooth.sum::<Vec3>().normalize_or(normals[index]);
                let key = (corner, normal.to_array().map(f32::to_bits));
                *known.entry(key).or_insert_with(|| {
                    surface.positions.push(corners[corner as usize]);
                    surface.normals.push(normal);
                    surface.colors.push(color);
                    surface.positions.len() as u32 - 1
                })
            });
            surface.indices.push(vertices);
        }
        surface
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_sides_look_round_and_few_flat() {
        let normals = |sides| {
            let surface = Polyhedron::prism(1.0, 1.0, sides).surface(Rgb::GRAY);
            let on_side = surface.normals.iter().filter(|normal| normal.y.abs() < 0.5);
            on_side.count()
        };
        assert_eq!(normals(6), 6 * 4);
        assert_eq!(normals(32), 32 * 2);
    }
}
