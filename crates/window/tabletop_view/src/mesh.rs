//! The meshes of solids and figures. There is one for each polyhedron, and one for each other kind of solid, which its transform stretches
//! to size, so that objects of all sizes are drawn together.

use bevy::{
    asset::RenderAssetUsages,
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
};
use tabletop_geometry::{Rgb, Solid, Triangles};

/// Sides of a cylinder, and of a ball around its axis.
pub(crate) const SIDES: u32 = 64;

/// Rings of a ball from pole to pole.
const RINGS: u32 = 32;

/// A cuboid of extents 1.
pub(crate) fn unit_cuboid() -> Mesh {
    without_uv(Cuboid::from_length(1.0).into())
}

/// A cylinder along Y of radius 1 and length 1.
pub(crate) fn unit_cylinder() -> Mesh {
    without_uv(Cylinder::new(1.0, 1.0).mesh().resolution(SIDES).into())
}

/// A ball of radius 1.
pub(crate) fn unit_ball() -> Mesh {
    without_uv(Sphere::new(1.0).mesh().uv(SIDES, RINGS))
}

/// The scale that stretches the unit mesh of its kind to this solid.
pub(crate) fn scale_of(solid: &Solid) -> Vec3 {
    match *solid {
        Solid::Cuboid(span) => span,
        Solid::Cylinder { radius, yspan } => Vec3::new(radius, yspan, radius),
        Solid::Ball(radius) => Vec3::splat(radius),
        Solid::Polyhedron(_) => Vec3::ONE,
    }
}

/// A surface of triangles with the colours of its vertices.
pub(crate) fn of_triangles(surface: &Triangles) -> Mesh {
    let colors = surface.colors.iter();
    let colors: Vec<_> = colors
        .map(|&Rgb { red, green, blue }| [red, green, blue, 1.0])
        .collect();
    Mesh::new(
        PrimitiveTopology::TriangleList,
        RenderAssetUsages::default(),
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, surface.positions.clone())
    .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, surface.normals.clone())
    .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colors)
    .with_inserted_indices(Indices::U32(surface.indices.concat()))
}

/// No surface has a texture.
fn without_uv(mut mesh: Mesh) -> Mesh {
    mesh.remove_attribute(Mesh::ATTRIBUTE_UV_0);
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vectors(mesh: &Mesh, attribute: bevy::mesh::MeshVertexAttribute) -> Vec<Vec3> {
        let values = mesh.attribute(attribute).unwrap().as_float3().unwrap();
        values.iter().copied().map(Vec3::from).collect()
    }

    fn positions_and_normals(mesh: &Mesh) -> (Vec<Vec3>, Vec<Vec3>) {
        (
            vectors(mesh, Mesh::ATTRIBUTE_POSITION),
            vectors(mesh, Mesh::ATTRIBUTE_NORMAL),
        )
    }

    #[test]
    fn normals_are_of_unit_length_and_point_outward() {
        for mesh in [unit_cuboid(), unit_cylinder(), unit_ball()] {
            let (positions, normals) = positions_and_normals(&mesh);
            assert!(positions.len() >= 24);
            for (position, normal) in positions.into_iter().zip(normals) {
                assert!((normal.length() - 1.0).abs() < 1e-5, "{normal}");
                assert!(position.dot(normal) > 0.0, "{normal} at {position}");
            }
        }
    }

    #[test]
    fn triangles_face_outward() {
        for mesh in [unit_cuboid(), unit_cylinder(), unit_ball()] {
            let (positions, _) = positions_and_normals(&mesh);
            let corners: Vec<usize> = mesh.indices().unwrap().iter().collect();
            for triangle in corners.chunks_exact(3) {
                let [a, b, c] = [0, 1, 2].map(|corner| positions[triangle[corner]]);
                let face = (b - a).cross(c - a);
                assert!(face.dot(a + b + c) >= 0.0, "{a} {b} {c}");
            }
        }
    }

    #[test]
    fn the_side_of_a_cylinder_is_round_and_its_caps_are_flat() {
        let (positions, normals) = positions_and_normals(&unit_cylinder());
        let (mut sides, mut caps) = (0, 0);
        for (position, normal) in positions.into_iter().zip(normals) {
            if normal.y.abs() > 0.5 {
                assert_eq!(normal, Vec3::Y * position.y.signum());
                caps += 1;
            } else {
                let radial = position.with_y(0.0);
                assert!((radial - normal).length() < 1e-5, "{normal} at {position}");
                sides += 1;
            }
        }
        assert!(sides >= 2 * SIDES && caps >= 2 * SIDES);
    }

    #[test]
    fn scaled_meshes_have_the_size_of_their_solid() {
        let cylinder = Solid::Cylinder {
            radius: 2.0,
            yspan: 5.0,
        };
        let cuboid = Solid::Cuboid(Vec3::new(1.0, 2.0, 3.0));
        for (mesh, solid, extents) in [
            (unit_cylinder(), cylinder, Vec3::new(4.0, 5.0, 4.0)),
            (unit_cuboid(), cuboid, Vec3::new(1.0, 2.0, 3.0)),
            (unit_ball(), Solid::Ball(1.5), Vec3::splat(3.0)),
        ] {
            let (positions, _) = positions_and_normals(&mesh);
            let farthest = positions
                .into_iter()
                .map(|position| (position * scale_of(&solid)).abs())
                .fold(Vec3::ZERO, Vec3::max);
            assert!((farthest * 2.0 - extents).length() < 1e-4, "{farthest}");
        }
    }
}
