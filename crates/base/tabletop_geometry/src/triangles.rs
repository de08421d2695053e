//! Surfaces of triangles, and the rays that enter them.

use bevy::prelude::*;

use crate::{Pose, Rgb};

/// A surface of triangles, with a normal and a colour at each vertex. A triangle's vertices run
/// counterclockwise as seen from outside. Lengths in units.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Triangles {
    /// Locations of the vertices, in the frame of the surface's owner.
    pub positions: Vec<Vec3>,
    /// Outward unit normals of the vertices.
    pub normals: Vec<Vec3>,
    /// Colours of the vertices.
    pub colors: Vec<Rgb>,
    /// Vertices of the triangles.
    pub indices: Vec<[u32; 3]>,
}

impl Triangles {
    /// Adds another surface.
    pub fn append(&mut self, other: &Self) {
        let first = self.positions.len() as u32;
        self.positions.extend(&other.positions);
        self.normals.extend(&other.normals);
        self.colors.extend(&other.colors);
        self.indices.extend(
            other
                .indices
                .iter()
                .map(|triangle| triangle.map(|i| i + first)),
        );
    }

    /// Distance along a ray at which it meets the surface from outside; `None` if it misses. `body` is the surface's pose.
    pub fn distance_along(&self, ray: Ray3d, body: Pose) -> Option<f32> {
        let to_body = body.inverse();
        let origin = to_body * ray.origin;
        let direction = to_body.rotation * *ray.direction;
        self.indices
            .iter()
            .filter_map(|&triangle| {
                let [a, b, c] = triangle.map(|i| self.positions[i as usize]);
                enter_triangle(origin, direction, a, b, c)
            })
            .min_by(f32::total_cmp)
    }
}

/// Sine of the angle to a plane up to which a ray lies in it. (`a_ray_in_the_plane_of_a_triangle_does_not_enter_it`)
const GRAZING: f32 = 1e-5;

/// The point where a ray enters a triangle through its front (Möller and Trumbore).
pub(crate) fn enter_triangle(
    origin: Vec3,
    direction: Vec3,
    a: Vec3,
    b: Vec3,
    c: Vec3,
) -> Option<f32> {
    let (ab, ac) = (b - a, c - a);
    let across = direction.cross(ac);
    let det = ab.dot(across);
    if det <= 0.0 {
        return None;
    }
    let from_a = origin - a;
    let u = from_a.dot(across);
    let v = direction.dot(from_a.cross(ab));
    let distance = ac.dot(from_a.cross(ab)) / det;
    let is_met = u >= 0.0 && v >= 0.0 && u + v <= det && distance >= 0.0;
    (is_met && !is_grazed(det, direction, ab.cross(ac))).then_some(distance)
}

/// True of a ray that lies in the plane of a triangle up to rounding, so that where it meets it is chance.
fn is_grazed(det: f32, direction: Vec3, normal: Vec3) -> bool {
    det * det <= GRAZING * GRAZING * direction.length_squared() * normal.length_squared()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_in_the_plane_of_a_triangle_does_not_enter_it() {
        let (b, c) = (Vec3::new(0.7, 0.0, 0.2), Vec3::new(0.7, 0.0, -0.2));
        for turn in [0.0, 1e-8, 1e-7, -1e-7] {
            let down = Vec3::new(turn, turn, -1.0);
            for y in [0.0, 1e-8, -1e-8] {
                let origin = Vec3::new(0.5, y, 0.5);
                for [a, b, c] in [[Vec3::X, b, c], [Vec3::X, c, b]] {
                    assert_eq!(enter_triangle(origin, down, a, b, c), None, "{turn}, {y}");
                }
            }
        }
        let near = Vec3::new(0.8, 1e-3, 0.3);
        let towards = Vec3::new(0.0, -1e-3, -0.3);
        let sides = [[b, c], [c, b]];
        let met = sides.map(|[b, c]| enter_triangle(near, towards, Vec3::X, b, c).is_some());
        assert_ne!(met[0], met[1], "one of them is its front");
    }

    #[test]
    fn a_ray_meets_a_triangle_from_its_front_only() {
        let surface = Triangles {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
            normals: vec![Vec3::Z; 3],
            colors: vec![Rgb::GRAY; 3],
            indices: vec![[0, 1, 2]],
        };
        let from = |origin: Vec3, direction| {
            surface.distance_along(Ray3d::new(origin, direction), Pose::at(Vec3::X * 5.0))
        };
        assert_eq!(from(Vec3::new(5.2, 0.2, 3.0), Dir3::NEG_Z), Some(3.0));
        assert_eq!(from(Vec3::new(5.2, 0.2, -3.0), Dir3::Z), None);
        assert_eq!(from(Vec3::new(5.8, 0.8, 3.0), Dir3::NEG_Z), None);
        assert_eq!(from(Vec3::new(5.2, 0.2, -3.0), Dir3::NEG_Z), None);
    }
}
