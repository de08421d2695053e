//! The section of a solid with a plane.

use bevy::prelude::*;
use tabletop_geometry::{Pose, Solid};

use crate::polyhedron;

/// A plane in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Plane {
    /// One of its points.
    pub point: Vec3,
    /// The direction at right angles to it, of unit length.
    pub normal: Vec3,
}

impl Plane {
    /// The outline of the cut through a solid of this pose, as points of the world in their order around it; empty if
    /// the plane misses the solid.
    pub fn cut(self, solid: &Solid, pose: Pose) -> Vec<Vec3> {
        let height = |point: Vec3| (point - self.point).dot(self.normal);
        if let Solid::Ball(radius) = *solid {
            return self.circle(pose.location, height(pose.location), radius);
        }
        let corners: Vec<Vec3> = polyhedron::corners(solid)
            .into_iter()
            .map(|corner| pose * corner)
            .collect();
        let crossings = polyhedron::edges(solid).into_iter().filter_map(|edge| {
            let [start, end] = edge.map(|corner| corners[corner]);
            let (below, above) = (height(start), height(end));
            ((below < 0.0) != (above < 0.0)).then(|| start.lerp(end, below / (below - above)))
        });
        self.in_order(crossings.collect())
    }

    /// The circle in which the plane cuts a ball whose centre is so high above it.
    fn circle(self, center: Vec3, height: f32, radius: f32) -> Vec<Vec3> {
        if height.abs() >= radius {
            return Vec::new();
        }
        let upright = Quat::from_rotation_arc(Vec3::Y, self.normal);
        polyhedron::rim((radius * radius - height * height).sqrt())
            .map(|point| center - self.normal * height + upright * point)
            .collect()
    }

    /// The corners of a convex polygon in this plane, in their order around it.
    fn in_order(self, mut corners: Vec<Vec3>) -> Vec<Vec3> {
        let center = corners.iter().sum::<Vec3>() / corners.len().max(1) as f32;
        let (x, y) = self.normal.any_orthonormal_pair();
        let direction = |corner: Vec3| (corner - center).dot(y).atan2((corner - center).dot(x));
        corners.sort_by(|&a, &b| direction(a).total_cmp(&direction(b)));
        corners
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LEVEL: Plane = Plane {
        point: Vec3::ZERO,
        normal: Vec3::Z,
    };

    fn length_around(outline: &[Vec3]) -> f32 {
        let next = outline.iter().cycle().skip(1);
        outline.iter().zip(next).map(|(a, b)| a.distance(*b)).sum()
    }

    fn assert_near(actual: f32, expected: f32) {
        assert!(
            (actual - expected).abs() < 0.01,
            "{actual} is not {expected}"
        );
    }

    #[test]
    fn a_cuboid_is_cut_in_a_polygon() {
        let cuboid = Solid::Cuboid(Vec3::new(2.0, 3.0, 4.0));
        let flat = LEVEL.cut(&cuboid, Pose::at(Vec3::Z));
        assert_eq!(flat.len(), 4);
        assert_near(length_around(&flat), 10.0);
        // Across all six faces of a cube: a regular hexagon.
        let diagonal = Plane {
            point: Vec3::ZERO,
            normal: Vec3::ONE.normalize(),
        };
        let hexagon = diagonal.cut(&Solid::Cuboid(Vec3::splat(2.0)), Pose::IDENTITY);
        assert_eq!(hexagon.len(), 6);
        assert_near(length_around(&hexagon), 6.0 * 2.0_f32.sqrt());
    }

    #[test]
    fn a_cylinder_is_cut_in_a_rectangle_a_circle_or_an_ellipse() {
        let cylinder = Solid::Cylinder {
            radius: 1.0,
            yspan: 4.0,
        };
        let lying = LEVEL.cut(&cylinder, Pose::IDENTITY);
        assert_near(length_around(&lying), 12.0);
        let upright = Pose::from_degrees(Vec3::ZERO, Vec3::X * 90.0);
        let circle = LEVEL.cut(&cylinder, upright);
        assert_near(length_around(&circle), std::f32::consts::TAU);
        let tilted = Pose::from_degrees(Vec3::ZERO, Vec3::X * 45.0);
        let ellipse = LEVEL.cut(&cylinder, tilted);
        assert_near(length_around(&ellipse), 7.640);
    }

    #[test]
    fn a_ball_is_cut_in_a_circle() {
        let cut = LEVEL.cut(&Solid::Ball(5.0), Pose::at(Vec3::new(1.0, 2.0, 3.0)));
        for point in cut {
            assert_near(point.z, 0.0);
            assert_near(point.distance(Vec3::new(1.0, 2.0, 0.0)), 4.0);
        }
    }

    #[test]
    fn every_cut_lies_in_the_plane() {
        let plane = Plane {
            point: Vec3::new(1.0, 0.5, 0.0),
            normal: Vec3::new(0.6, 0.8, 0.0),
        };
        let cylinder = Solid::Cylinder {
            radius: 1.0,
            yspan: 4.0,
        };
        let pose = Pose::from_degrees(Vec3::new(1.0, 1.0, 1.0), Vec3::new(20.0, 40.0, 60.0));
        for solid in [cylinder, Solid::Ball(2.0), Solid::Cuboid(Vec3::splat(3.0))] {
            let cut = plane.cut(&solid, pose);
            assert!(cut.len() >= 4);
            for point in cut {
                assert_near((point - plane.point).dot(plane.normal), 0.0);
            }
        }
    }

    #[test]
    fn solids_beside_the_plane_are_not_cut() {
        for solid in [
            Solid::Ball(1.0),
            Solid::Cuboid(Vec3::splat(2.0)),
            Solid::Cylinder {
                radius: 1.0,
                yspan: 2.0,
            },
        ] {
            assert_eq!(LEVEL.cut(&solid, Pose::at(Vec3::Z * 2.0)), []);
        }
    }
}
