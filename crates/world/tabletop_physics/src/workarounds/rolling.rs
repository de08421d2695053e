//! Cylinders on their side.
//!
//! To Parry, a cylinder is smooth, and the normals of its contacts are so inexact that it never comes to rest; as a prism it stands on a slope. A cylinder
//! on its side touches with a line, which is that of a segment with a radius: exact, since the segment never enters what the cylinder touches.

use bevy::prelude::*;
use bevy_rapier3d::{
    parry::query::{
        ClosestPoints, Contact, ContactManifold, ContactManifoldsWorkspace, DefaultQueryDispatcher,
        NonlinearRigidMotion, PersistentQueryDispatcher, QueryDispatcher, ShapeCastHit,
        Unsupported,
        details::{
            NormalConstraints, ShapeCastOptions, closest_points_segment_segment_with_locations,
            contact_manifolds_composite_shape_composite_shape,
            contact_manifolds_composite_shape_shape, contact_support_map_support_map_with_params,
        },
        gjk::{GJKResult, VoronoiSimplex},
    },
    parry::shape::{PolygonalFeature, PolygonalFeatureMap, Segment},
    prelude::RapierContextSimulation,
    rapier::prelude::{NarrowPhase, Pose, Shape},
};

use super::polytope::Polytope;

/// Sine of the angle, some 3°, by which a cylinder on its side may be tilted.
const MOST_TILT: f32 = 0.05;

/// Cosine of the angle, some 6°, within which directions are about the same: half the angle of a prism's facets.
const SAME: f32 = 0.994;

/// A narrow phase in which cylinders roll.
pub(crate) fn narrow_phase() -> NarrowPhase {
    NarrowPhase::with_query_dispatcher(Rolling)
}

/// Lets cylinders roll in a new context of Rapier.
pub(crate) fn let_cylinders_roll(
    add: On<Add, RapierContextSimulation>,
    mut contexts: Query<&mut RapierContextSimulation>,
) {
    if let Ok(mut simulation) = contexts.get_mut(add.entity) {
        simulation.narrow_phase = narrow_phase();
    }
}

/// Finds the contacts of cylinders on their side, and leaves all else to Parry.
pub(crate) struct Rolling;

/// Finds the points in which a cylinder on its side touches something, from a manifold that knows about where.
fn touch_along_line<M, C: Default + Copy>(
    at: &Pose,
    one: &RollingShape,
    other: &RollingShape,
    prediction: f32,
    manifold: &mut ContactManifold<M, C>,
) {
    let before = manifold.points.clone();
    let about = manifold.local_n1;
    manifold.clear();
    for find_normal in [exact_normal, nearest_normal] {
        let Some(normal) = find_normal(at, one, other, about) else {
            continue;
        };
        let others = at.rotation.inverse() * -normal;
        let (own, theirs) = (one.feature(normal), other.feature(others));
        PolygonalFeature::contacts(
            at,
            &at.inverse(),
            normal,
            others,
            &own,
            &theirs,
            manifold,
            false,
        );
        manifold.local_n1 = normal;
        manifold.local_n2 = others;
        if !manifold.points.is_empty() {
            break;
        }
    }
    let (normal, others) = (manifold.local_n1, manifold.local_n2);
    for point in &mut manifold.points {
        point.local_p1 += one.radius * normal;
        point.local_p2 += other.radius * others;
        point.dist -= one.radius + other.radius;
    }
    manifold.points.retain(|point| point.dist <= prediction);
    manifold.match_contacts(&before);
}

/// The normal by a formula: of two cylinders, or of the face on which one lies, if about there is one.
fn exact_normal(at: &Pose, one: &RollingShape, other: &RollingShape, about: Vec3) -> Option<Vec3> {
    match (one.cylinder, other.cylinder) {
        (Some(own), Some(theirs)) => {
            let (own_at, their_at) =
                closest_points_segment_segment_with_locations(at, &own, &theirs);
            let way = *at * theirs.point_at(&their_at) - own.point_at(&own_at);
            way.try_normalize()
        }
        (Some(_), None) => {
            let face = other.face_about(at.rotation.inverse() * -about)?;
            Some(at.rotation * -face)
        }
        (None, _) => one.face_about(about),
    }
}

/// The direction between the nearest points.
fn nearest_normal(
    at: &Pose,
    one: &RollingShape,
    other: &RollingShape,
    about: Vec3,
) -> Option<Vec3> {
    let nearest = contact_support_map_support_map_with_params(
        at,
        one.features(),
        other.features(),
        f32::MAX,
        &mut VoronoiSimplex::new(),
        about.try_normalize(),
    );
    match nearest {
        GJKResult::ClosestPoints(_, _, normal) => Some(normal),
        GJKResult::Intersection | GJKResult::Proximity(_) | GJKResult::NoIntersection(_) => None,
    }
}

/// A shape, by the line on which it rolls if it is a cylinder.
struct RollingShape<'a> {
    cylinder: Option<Segment>,
    radius: f32,
    shape: &'a dyn PolygonalFeatureMap,
}

impl<'a> RollingShape<'a> {
    fn of(shape: &'a dyn Shape) -> Option<Self> {
        let cylinder = shape.as_shape::<Polytope>().and_then(Polytope::axis);
        let (shape, _) = shape.as_polygonal_feature_map()?;
        Some(Self {
            cylinder: cylinder.map(|(axis, _)| axis),
            radius: cylinder.map_or(0.0, |(_, radius)| radius),
            shape,
        })
    }

    /// The segment of a cylinder, or the shape.
    fn features(&self) -> &dyn PolygonalFeatureMap {
        match &self.cylinder {
            Some(axis) => axis,
            None => self.shape,
        }
    }

    fn feature(&self, direction: Vec3) -> PolygonalFeature {
        let mut feature = PolygonalFeature::default();
        self.features()
            .local_support_feature(direction, &mut feature);
        feature
    }

    /// The normal of its face in a direction, if the face has about this direction.
    fn face_about(&self, direction: Vec3) -> Option<Vec3> {
        let face = self.feature(direction);
        let [a, b, c, _] = face.vertices;
        let normal = (b - a).cross(c - a).try_normalize()?;
        let normal = normal * normal.dot(direction).signum();
        (face.num_vertices > 2 && normal.dot(direction) > SAME).then_some(normal)
    }

    /// True if a normal in its frame is that of a cylinder's side, or it is no cylinder.
    fn has_side_at(&self, normal: Vec3) -> bool {
        self.cylinder.is_none() || (normal != Vec3::ZERO && normal.y.abs() < MOST_TILT)
    }
}

impl<M: Default + Clone, C: Default + Copy> PersistentQueryDispatcher<M, C> for Rolling {
    fn contact_manifolds(
        &self,
        at: &Pose,
        first: &dyn Shape,
        second: &dyn Shape,
        prediction: f32,
        manifolds: &mut Vec<ContactManifold<M, C>>,
        workspace: &mut Option<ContactManifoldsWorkspace>,
    ) -> Result<(), Unsupported> {
        let parts = [first, second].map(|shape| shape.as_composite_shape());
        match parts {
            [Some(one), Some(other)] => contact_manifolds_composite_shape_composite_shape(
                self, at, one, other, prediction, manifolds, workspace,
            ),
            [Some(parts), None] => contact_manifolds_composite_shape_shape(
                self, at, parts, second, prediction, manifolds, workspace, false,
            ),
            [None, Some(parts)] => contact_manifolds_composite_shape_shape(
                self,
                &at.inverse(),
                parts,
                first,
                prediction,
                manifolds,
                workspace,
                true,
            ),
            [None, None] => {
                if manifolds.is_empty() {
                    manifolds.push(ContactManifold::new());
                }
                return self.contact_manifold_convex_convex(
                    at,
                    first,
                    second,
                    None,
                    None,
                    prediction,
                    &mut manifolds[0],
                );
            }
        }
        Ok(())
    }

    fn contact_manifold_convex_convex(
        &self,
        at: &Pose,
        first: &dyn Shape,
        second: &dyn Shape,
        constraints: Option<&dyn NormalConstraints>,
        others: Option<&dyn NormalConstraints>,
        prediction: f32,
        manifold: &mut ContactManifold<M, C>,
    ) -> Result<(), Unsupported> {
        let by_faces = |manifold: &mut ContactManifold<M, C>| {
            DefaultQueryDispatcher.contact_manifold_convex_convex(
                at,
                first,
                second,
                constraints,
                others,
                prediction,
                manifold,
            )
        };
        let surfaces = [RollingShape::of(first), RollingShape::of(second)];
        let [Some(one), Some(other)] = surfaces else {
            return by_faces(manifold);
        };
        if one.cylinder.is_none() && other.cylinder.is_none() {
            return by_faces(manifold);
        }
        let lies = |manifold: &ContactManifold<M, C>| {
            !manifold.points.is_empty()
                && one.has_side_at(manifold.local_n1)
                && other.has_side_at(manifold.local_n2)
        };
        if lies(manifold) {
            touch_along_line(at, &one, &other, prediction, manifold);
            if lies(manifold) {
                return Ok(());
            }
        }
        by_faces(manifold)?;
        if lies(manifold) {
            touch_along_line(at, &one, &other, prediction, manifold);
        }
        Ok(())
    }
}

impl QueryDispatcher for Rolling {
    fn intersection_test(
        &self,
        at: &Pose,
        first: &dyn Shape,
        second: &dyn Shape,
    ) -> Result<bool, Unsupported> {
        DefaultQueryDispatcher.intersection_test(at, first, second)
    }

    fn distance(
        &self,
        at: &Pose,
        first: &dyn Shape,
        second: &dyn Shape,
    ) -> Result<f32, Unsupported> {
        DefaultQueryDispatcher.distance(at, first, second)
    }

    fn contact(
        &self,
        at: &Pose,
        first: &dyn Shape,
        second: &dyn Shape,
        prediction: f32,
    ) -> Result<Option<Contact>, Unsupported> {
        DefaultQueryDispatcher.contact(at, first, second, prediction)
    }

    fn closest_points(
        &self,
        at: &Pose,
        first: &dyn Shape,
        second: &dyn Shape,
        most: f32,
    ) -> Result<ClosestPoints, Unsupported> {
        DefaultQueryDispatcher.closest_points(at, first, second, most)
    }

    fn cast_shapes(
        &self,
        at: &Pose,
        velocity: Vec3,
        first: &dyn Shape,
        second: &dyn Shape,
        options: ShapeCastOptions,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        DefaultQueryDispatcher.cast_shapes(at, velocity, first, second, options)
    }

    fn cast_shapes_nonlinear(
        &self,
        motion: &NonlinearRigidMotion,
        first: &dyn Shape,
        other_motion: &NonlinearRigidMotion,
        second: &dyn Shape,
        start: f32,
        end: f32,
        stops_at_penetration: bool,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        DefaultQueryDispatcher.cast_shapes_nonlinear(
            motion,
            first,
            other_motion,
            second,
            start,
            end,
            stops_at_penetration,
        )
    }
}
