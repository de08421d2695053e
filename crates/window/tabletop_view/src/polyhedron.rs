//! Corners and edges of solids, a cylinder being taken as a prism of as many sides as it is drawn with.

use std::f32::consts::TAU;

use bevy::prelude::*;
use tabletop_geometry::Solid;

use crate::mesh::SIDES;

/// The corners of a solid in its own frame. A ball has none.
pub(crate) fn corners(solid: &Solid) -> Vec<Vec3> {
    match *solid {
        Solid::Cuboid(span) => (0..8)
            .map(|corner| {
                let side = |bit: u8| if corner & bit == 0 { -0.5 } else { 0.5 };
                span * Vec3::new(side(1), side(2), side(4))
            })
            .collect(),
        Solid::Cylinder { radius, yspan } => rim(radius)
            .flat_map(|point| [-0.5, 0.5].map(|end| point.with_y(yspan * end)))
            .collect(),
        Solid::Polyhedron(ref polyhedron) => polyhedron.corners().to_vec(),
        Solid::Ball(_) => Vec::new(),
    }
}

/// The edges of a solid, as pairs of indices of its [`corners`].
pub(crate) fn edges(solid: &Solid) -> Vec<[usize; 2]> {
    match *solid {
        Solid::Cuboid(_) => [1, 2, 4]
            .into_iter()
            .flat_map(|bit| {
                let starts = (0..8).filter(move |corner| corner & bit == 0);
                starts.map(move |corner| [corner, corner | bit])
            })
            .collect(),
        Solid::Cylinder { .. } => (0..SIDES as usize)
            .flat_map(|side| {
                let (this, next) = (2 * side, 2 * ((side + 1) % SIDES as usize));
                [[this, this + 1], [this, next], [this + 1, next + 1]]
            })
            .collect(),
        Solid::Polyhedron(ref polyhedron) => polyhedron.edges(),
        Solid::Ball(_) => Vec::new(),
    }
}

/// Points of the circle about the Y axis.
pub(crate) fn rim(radius: f32) -> impl Iterator<Item = Vec3> {
    (0..SIDES).map(move |side| {
        let angle = side as f32 / SIDES as f32 * TAU;
        Vec3::new(radius * angle.cos(), 0.0, radius * angle.sin())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_edges_and_faces_satisfy_euler() {
        let sides = SIDES as usize;
        for (solid, faces) in [
            (Solid::Cuboid(Vec3::ONE), 6),
            (
                Solid::Cylinder {
                    radius: 1.0,
                    yspan: 2.0,
                },
                sides + 2,
            ),
        ] {
            assert_eq!(corners(&solid).len() + faces, edges(&solid).len() + 2);
        }
    }

    #[test]
    fn the_edges_of_a_cuboid_have_its_extents() {
        let span = Vec3::new(1.0, 2.0, 3.0);
        let corners = corners(&Solid::Cuboid(span));
        for (axis, extent) in span.to_array().into_iter().enumerate() {
            let along = edges(&Solid::Cuboid(span))
                .into_iter()
                .filter(|&[a, b]| corners[b][axis] - corners[a][axis] == extent);
            assert_eq!(along.count(), 4);
        }
    }
}
