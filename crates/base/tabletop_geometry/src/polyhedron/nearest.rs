//! Intersections and distances of rays and points with polyhedra.

use bevy::prelude::*;

use crate::polyhedron::Polyhedron;
use crate::triangles::enter_triangle;

impl Polyhedron {
    /// The point where a ray enters its surface, as a factor of the direction. A ray that begins inside does not enter.
    pub fn entry(&self, origin: Vec3, direction: Vec3) -> Option<f32> {
        self.faces()
            .filter_map(|[a, b, c]| enter_triangle(origin, direction, a, b, c))
            .min_by(f32::total_cmp)
    }

    /// True if a point is inside. For convex ones.
    pub fn contains(&self, point: Vec3) -> bool {
        self.faces()
            .all(|[a, b, c]| (b - a).cross(c - a).dot(point - a) <= 0.0)
    }

    /// Distance of a point outside it. For convex ones.
    pub fn distance_to(&self, point: Vec3) -> f32 {
        if self.contains(point) {
            return 0.0;
        }
        let distances = self
            .faces()
            .map(|face| nearest_of_triangle(face, point).distance(point));
        distances.fold(f32::INFINITY, f32::min)
    }
}

/// The point of a triangle that is nearest to another point.
fn nearest_of_triangle([a, b, c]: [Vec3; 3], point: Vec3) -> Vec3 {
    let (ab, ac) = (b - a, c - a);
    let normal = ab.cross(ac);
    let area = normal.length_squared();
    if area > 0.0 {
        let from_a = point - a;
        let v = from_a.cross(ac).dot(normal) / area;
        let w = ab.cross(from_a).dot(normal) / area;
        if v >= 0.0 && w >= 0.0 && v + w <= 1.0 {
            return a + ab * v + ac * w;
        }
    }
    let on_edges = [(a, b), (b, c), (c, a)].map(|(start, end)| {
        let along = end - start;
        let length = along.length_squared().max(f32::MIN_POSITIVE);
        start + along * ((point - start).dot(along) / length).clamp(0.0, 1.0)
    });
    let [first, others @ ..] = on_edges;
    others.into_iter().fold(first, |nearest, other| {
        match other.distance_squared(point) < nearest.distance_squared(point) {
            true => other,
            false => nearest,
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_goes_through_the_hole_of_a_ring() {
        let ring = Polyhedron::ring(1.0, 0.5, 0.4, 32);
        let down = |x| ring.entry(Vec3::new(x, 0.05, 5.0), Vec3::NEG_Z);
        assert_eq!(down(0.0), None);
        assert!(down(0.8).is_some_and(|distance| (distance - 4.8).abs() < 1e-5));
        assert_eq!(down(1.1), None);
    }

    #[test]
    fn points_inside_a_convex_polyhedron_have_distance_zero() {
        let prism = Polyhedron::prism(1.0, 2.0, 6);
        assert!(prism.contains(Vec3::new(0.9, 0.9, 0.0)));
        assert!(!prism.contains(Vec3::new(0.9, 1.1, 0.0)));
        assert!(!prism.contains(Vec3::new(0.0, 0.0, 0.9)));
        assert_eq!(prism.distance_to(Vec3::new(0.9, 0.9, 0.0)), 0.0);
        assert!((prism.distance_to(Vec3::new(4.0, 5.0, 0.0)) - 5.0).abs() < 1e-5);
        assert!((prism.distance_to(Vec3::new(0.0, 3.0, 0.2)) - 2.0).abs() < 1e-5);
    }
}
