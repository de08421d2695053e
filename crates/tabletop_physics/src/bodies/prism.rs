//! Prisms that stand in for cylinders.

use std::f32::consts::PI;

use bevy_rapier3d::{
    parry::{
        bounding_volume::{Aabb, BoundingSphere},
        mass_properties::MassProperties,
        query::{PointProjection, PointQuery, Ray, RayCast, RayIntersection},
        shape::{
            ConvexPolyhedron, FeatureId, PackedFeatureId, PolygonalFeature, PolygonalFeatureMap,
            Shape, ShapeType, SharedShape, SupportMap, TypedShape,
        },
    },
    rapier::prelude::Vector,
};

const SIDES: u32 = 32;

/// A quarter of the sides.
const QUARTER: u32 = SIDES / 4;

/// A prism with its facets on a cylinder's surface, so that a lying cylinder's centre is at its radius. Rapier's own cylinder never comes
/// to rest on its side: inexact contact normals drive it on at some 0.2 units/s.
///
/// It touches with its ends at four corners around them. A convex polyhedron of Rapier touches with the first four that a face has, and
/// would stand on one side of the end and stagger.
#[derive(Clone)]
pub(crate) struct Prism {
    hull: ConvexPolyhedron,
}

impl Prism {
    /// The shape that stands in for a cylinder, if there are numbers small and great enough for it.
    pub fn shape(radius: f32, yspan: f32) -> Option<SharedShape> {
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
        Some(SharedShape::new(Self { hull }))
    }

    /// Four corners around the end in a direction, one of them next to a point.
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

impl PolygonalFeatureMap for Prism {
    fn local_support_feature(&self, direction: Vector, feature: &mut PolygonalFeature) {
        self.local_support_feature_toward(direction, Vector::ZERO, feature);
    }

    fn local_support_feature_toward(
        &self,
        direction: Vector,
        hint: Vector,
        feature: &mut PolygonalFeature,
    ) {
        if direction.y.abs() > libm::hypotf(direction.x, direction.z) {
            *feature = self.end(direction, hint);
        } else {
            self.hull
                .local_support_feature(direction.with_y(0.0), feature);
        }
    }

    fn is_convex_polyhedron(&self) -> bool {
        true
    }
}

impl SupportMap for Prism {
    fn local_support_point(&self, direction: Vector) -> Vector {
        self.hull.local_support_point(direction)
    }
}

impl Shape for Prism {
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
        Some(Box::new(Self { hull }))
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

impl RayCast for Prism {
    fn cast_local_ray_and_get_normal(
        &self,
        ray: &Ray,
        most: f32,
        is_solid: bool,
    ) -> Option<RayIntersection> {
        self.hull.cast_local_ray_and_get_normal(ray, most, is_solid)
    }
}

impl PointQuery for Prism {
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
            let prism = Prism::shape(radius, yspan);
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
        let prism = Prism::shape(0.5, 1.0);
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
        let prism = Prism::shape(0.5, 2.0);
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
}
