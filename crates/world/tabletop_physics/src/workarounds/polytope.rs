//! Solids with flat faces: polyhedra, and the prisms that stand in for cylinders.

use std::f32::consts::PI;

use bevy_rapier3d::{
    parry::{
        bounding_volume::{Aabb, BoundingSphere},
        mass_properties::MassProperties,
        query::{PointProjection, PointQuery, Ray, RayCast, RayIntersection},
        shape::{
            ConvexPolyhedron, FeatureId, PackedFeatureId, PolygonalFeature, PolygonalFeatureMap,
            Segment, Shape, ShapeType, SharedShape, SupportMap, TypedShape,
        },
    },
    rapier::prelude::Vector,
};
use tabletop_geometry::Polyhedron;

const SIDES: u32 = 32;

/// A quarter of the sides.
const QUARTER: u32 = SIDES / 4;

/// A convex solid with flat faces.
///
/// A face with many corners touches with four of them, spread around it. Rapier's own convex polyhedron touches with the first four corners of a
/// face, and would stand on one side of the face and stagger.
#[derive(Clone)]
pub(crate) struct Polytope {
    hull: ConvexPolyhedron,
    touch: Touch,
}

/// The faces with which a polytope touches.
#[derive(Clone, Copy)]
enum Touch {
    /// The faces of a prism of [`SIDES`] along Y, which stands in for a cylinder.
    Prism { radius: f32, half_yspan: f32 },
    /// Any faces.
    Face,
}

impl Polytope {
    /// A prism with its facets on a cylinder's surface, so that a lying cylinder's centre is at its radius. `None` if its numbers are too
    /// small or too great. Rapier's own cylinder never comes to rest on its side: inexact contact normals drive it on at some
    /// 0.2 units/s.
    pub fn of_cylinder(radius: f32, yspan: f32) -> Option<SharedShape> {
        let half_yspan = yspan / 2.0;
        let half_angle = PI / SIDES as f32;
        let corner_radius = radius / libm::cosf(half_angle);
        let corners = [-half_yspan, half_yspan].into_iter().flat_map(|y| {
            (0..SIDES).map(move |side| {
                let (sin, cos) = libm::sincosf((2 * side + 1) as f32 * half_angle);
                Vector::new(cos * corner_radius, y, sin * corner_radius)
            })
        });
        let sides = (0..SIDES).flat_map(|side| {
            let next = (side + 1) % SIDES;
            let [low, low_next, high, high_next] = [side, next, SIDES + side, SIDES + next];
            [[low, high, low_next], [low_next, high, high_next]]
        });
        let ends = (1..SIDES - 1)
            .flat_map(|side| [[0, side, side + 1], [SIDES, SIDES + side + 1, SIDES + side]]);
        let triangles: Vec<_> = sides.chain(ends).collect();
        let hull = ConvexPolyhedron::from_convex_mesh(corners.collect(), &triangles)?;
        let touch = Touch::Prism { radius, half_yspan };
        Some(SharedShape::new(Self { hull, touch }))
    }

    /// A convex polyhedron; `None` if it is too flat or too thin to compute with.
    pub fn of_polyhedron(polyhedron: &Polyhedron) -> Option<SharedShape> {
        let corners = polyhedron.corners().to_vec();
        let hull = ConvexPolyhedron::from_convex_mesh(corners, polyhedron.triangles())
            .or_else(|| ConvexPolyhedron::from_convex_hull(polyhedron.corners()))?;
        let touch = Touch::Face;
        Some(SharedShape::new(Self { hull, touch }))
    }

    /// The axis and the radius of the cylinder for which a prism stands in.
    pub fn axis(&self) -> Option<(Segment, f32)> {
        match self.touch {
            Touch::Prism { radius, half_yspan } => {
                let [low, high] = [-half_yspan, half_yspan].map(|y| Vector::Y * y);
                Some((Segment::new(low, high), radius))
            }
            Touch::Face => None,
        }
    }

    /// Four corners around the face in a direction, one of them next to a point; all corners if there are no more.
    fn face(&self, direction: Vector, near: Vector) -> PolygonalFeature {
        let mut feature = PolygonalFeature::default();
        let facing = |face: usize| self.hull.faces()[face].normal.dot(direction);
        let mut best = 0;
        for face in 1..self.hull.faces().len() {
            if facing(face) > facing(best) {
                best = face;
            }
        }
        let face = &self.hull.faces()[best];
        let first = face.first_vertex_or_edge as usize;
        let corners = first..first + face.num_vertices_or_edges as usize;
        let vertices = &self.hull.vertices_adj_to_face()[corners.clone()];
        let edges = &self.hull.edges_adj_to_face()[corners];
        let count = vertices.len();
        let point = |corner: usize| self.hull.points()[vertices[corner] as usize];
        let by_distance =
            |&a: &usize, &b: &usize| point(a).distance(near).total_cmp(&point(b).distance(near));
        let nearest = match count > 4 {
            true => (0..count).min_by(by_distance).unwrap_or(0),
            false => 0,
        };
        feature.num_vertices = count.min(4);
        for i in 0..feature.num_vertices {
            let corner = match count > 4 {
                true => (nearest + (i * count + 2) / 4) % count,
                false => i,
            };
            feature.vertices[i] = point(corner);
            feature.vids[i] = PackedFeatureId::vertex(vertices[corner]);
            feature.eids[i] = PackedFeatureId::edge(edges[corner]);
        }
        feature.fid = PackedFeatureId::face(best as u32);
        feature
    }

    /// Four corners around the end of a prism in a direction, one of them next to a point.
    fn end(&self, direction: Vector, near: Vector) -> PolygonalFeature {
        let turn = libm::atan2f(near.z, near.x) / (2.0 * PI) * SIDES as f32 - 0.5;
        let nearest = turn.round().rem_euclid(SIDES as f32) as u32;
        let first = if direction.y < 0.0 { 0 } else { SIDES };
        let corners =
            [0, 1, 2, 3].map(|quarter| first + (nearest % QUARTER + quarter * QUARTER) % SIDES);
        PolygonalFeature {
            vertices: corners.map(|corner| self.hull.points()[corner as usize]),
            vids: corners.map(PackedFeatureId::vertex),
            eids: corners.map(|corner| PackedFeatureId::edge(4 * SIDES + corner)),
            fid: PackedFeatureId::face(4 * SIDES + first),
            num_vertices: 4,
        }
    }
}

impl PolygonalFeatureMap for Polytope {
    fn local_support_feature(&self, direction: Vector, feature: &mut PolygonalFeature) {
        self.local_support_feature_toward(direction, Vector::ZERO, feature);
    }

    fn local_support_feature_toward(
        &self,
        direction: Vector,
        hint: Vector,
        feature: &mut PolygonalFeature,
    ) {
        match self.touch {
            Touch::Face => *feature = self.face(direction, hint),
            Touch::Prism { .. } if direction.y.abs() > libm::hypotf(direction.x, direction.z) => {
                *feature = self.end(direction, hint);
            }
            Touch::Prism { .. } => self
                .hull
                .local_support_feature(direction.with_y(0.0), feature),
        }
    }

    fn is_convex_polyhedron(&self) -> bool {
        true
    }
}

impl SupportMap for Polytope {
    fn local_support_point(&self, direction: Vector) -> Vector {
        self.hull.local_support_point(direction)
    }
}

impl Shape for Polytope {
    fn compute_local_aabb(&self) -> Aabb {
        self.hull.compute_local_aabb()
    }

    fn compute_local_bounding_sphere(&self) -> BoundingSphere {
        self.hull.compute_local_bounding_sphere()
    }

    fn clone_dyn(&self) -> Box<dyn Shape> {
        Box::new(self.clone())
    }

    fn scale_dyn(&self, scale: Vector, _subdivisions: u32) -> Option<Box<dyn Shape>> {
        let hull = self.hull.clone().scaled(scale)?;
        let touch = self.touch;
        Some(Box::new(Self { hull, touch }))
    }

    fn mass_properties(&self, density: f32) -> MassProperties {
        self.hull.mass_properties(density)
    }

    fn is_convex(&self) -> bool {
        true
    }

    fn shape_type(&self) -> ShapeType {
        ShapeType::Custom
    }

    fn as_typed_shape(&self) -> TypedShape<'_> {
        TypedShape::Custom(self)
    }

    fn ccd_thickness(&self) -> f32 {
        self.hull.ccd_thickness()
    }

    fn ccd_angular_thickness(&self) -> f32 {
        self.hull.ccd_angular_thickness()
    }

    fn as_support_map(&self) -> Option<&dyn SupportMap> {
        Some(self)
    }

    fn as_polygonal_feature_map(&self) -> Option<(&dyn PolygonalFeatureMap, f32)> {
        Some((self, 0.0))
    }

    fn feature_normal_at_point(&self, feature: FeatureId, point: Vector) -> Option<Vector> {
        self.hull.feature_normal_at_point(feature, point)
    }
}

impl RayCast for Polytope {
    fn cast_local_ray_and_get_normal(
        &self,
        ray: &Ray,
        most: f32,
        is_solid: bool,
    ) -> Option<RayIntersection> {
        self.hull.cast_local_ray_and_get_normal(ray, most, is_solid)
    }
}

impl PointQuery for Polytope {
    fn project_local_point(&self, point: Vector, is_solid: bool) -> PointProjection {
        self.hull.project_local_point(point, is_solid)
    }

    fn project_local_point_and_get_feature(&self, point: Vector) -> (PointProjection, FeatureId) {
        self.hull.project_local_point_and_get_feature(point)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_prism_stands_in_for_every_size_of_cylinder() {
        for (radius, yspan) in [(0.5, 1.0), (0.001, 1000.0), (1000.0, 0.001), (0.35, 5.0)] {
            let prism = Polytope::of_cylinder(radius, yspan);
            let prism = prism.unwrap_or_else(|| panic!("no prism for {radius} x {yspan}"));
            let bounds = prism.compute_local_aabb();
            assert!((bounds.maxs.z / radius - 1.0).abs() < 1e-3, "{bounds:?}");
            assert!(
                (bounds.maxs.y * 2.0 / yspan - 1.0).abs() < 1e-3,
                "{bounds:?}"
            );
        }
    }

    #[test]
    fn an_end_touches_at_four_corners_all_around_it() {
        let prism = Polytope::of_cylinder(0.5, 1.0);
        let prism = prism.unwrap_or_else(|| panic!("no prism"));
        let (map, _) = prism
            .as_polygonal_feature_map()
            .unwrap_or_else(|| panic!("no features"));
        for (down, near) in [
            (-1.0, Vector::ZERO),
            (-1.0, Vector::new(0.3, -0.5, -0.4)),
            (1.0, Vector::new(-0.5, 0.5, 0.01)),
        ] {
            let mut end = PolygonalFeature::default();
            map.local_support_feature_toward(Vector::Y * down, near, &mut end);
            assert_eq!(end.num_vertices, 4);
            assert!(end.vertices.iter().all(|corner| corner.y == 0.5 * down));
            let middle = end.vertices.iter().sum::<Vector>() / 4.0;
            assert!(middle.with_y(0.0).length() < 1e-6, "{middle}");
            let nearest = end.vertices.map(|corner| corner.distance(near));
            let nearest = nearest.into_iter().fold(f32::INFINITY, f32::min);
            assert!(near == Vector::ZERO || nearest < 0.06, "{nearest}");
        }
    }

    #[test]
    fn a_lying_prism_touches_with_a_facet() {
        let prism = Polytope::of_cylinder(0.5, 2.0);
        let prism = prism.unwrap_or_else(|| panic!("no prism"));
        let (map, _) = prism
            .as_polygonal_feature_map()
            .unwrap_or_else(|| panic!("no features"));
        let mut facet = PolygonalFeature::default();
        map.local_support_feature(Vector::new(0.0, 1e-4, -1.0), &mut facet);
        assert_eq!(facet.num_vertices, 4);
        assert!(
            facet
                .vertices
                .iter()
                .all(|corner| (corner.z + 0.5).abs() < 1e-6)
        );
    }

    #[test]
    fn a_face_of_many_corners_touches_all_around_it() {
        for sides in [3, 4, 5, 6, 12, 32] {
            let frustum = Polyhedron::frustum(0.7, 1.0, 2.0, sides);
            let shape = Polytope::of_polyhedron(&frustum);
            let shape = shape.unwrap_or_else(|| panic!("no polytope of {sides} sides"));
            let (map, _) = shape
                .as_polygonal_feature_map()
                .unwrap_or_else(|| panic!("no features"));
            let near = Vector::new(-0.3, 0.2, -1.0);
            let mut end = PolygonalFeature::default();
            map.local_support_feature_toward(Vector::NEG_Z, near, &mut end);
            assert_eq!(end.num_vertices, sides.min(4) as usize);
            let corners = &end.vertices[..end.num_vertices];
            assert!(corners.iter().all(|corner| (corner.z + 1.0).abs() < 1e-6));
            // The middle is well inside them.
            let next = corners.iter().cycle().skip(1);
            for (a, b) in corners.iter().zip(next) {
                let along = (*b - *a).normalize();
                let inside = Vector::Z.cross(along).dot(-*a).abs();
                assert!(inside > 0.3, "{sides}: {inside}");
            }
        }
    }
}
