//! Intersection of rays with solids: for picking with the mouse, and for finding the object below a point.

use bevy::prelude::*;

use crate::{Pose, Primitive, Solid};

impl Primitive {
    /// Distance along the ray at which it enters this primitive of a body at this pose. A ray that
    /// begins inside, or passes only behind its origin, does not enter.
    pub fn distance_along(&self, ray: Ray3d, body: Pose) -> Option<f32> {
        let world_from_solid = body * self.pose;
        let solid_from_world = world_from_solid.inverse();
        let origin = solid_from_world * ray.origin;
        let direction = solid_from_world.rotation * *ray.direction;
        self.solid.entry(origin, direction)
    }
}

impl Solid {
    /// True for a point of the solid.
    pub(crate) fn contains(&self, point: Vec3) -> bool {
        match self {
            Self::Cuboid(span) => point.abs().cmple(*span / 2.0).all(),
            Self::Cylinder { radius, yspan } => {
                point.y.abs() <= yspan / 2.0
                    && point.with_y(0.0).length_squared() <= radius * radius
            }
            Self::Ball(radius) => point.length_squared() <= radius * radius,
            Self::Polyhedron(polyhedron) => polyhedron.contains(point),
        }
    }

    /// The point where a ray enters the solid, as a factor of its direction.
    pub(crate) fn entry(&self, origin: Vec3, direction: Vec3) -> Option<f32> {
        // The points where the straight line enters and leaves. It misses the solid if it leaves before it enters.
        let (enter, leave) = match *self {
            Self::Cuboid(span) => {
                let half = span / 2.0;
                let x = between(origin.x, direction.x, half.x)?;
                let y = between(origin.y, direction.y, half.y)?;
                let z = between(origin.z, direction.z, half.z)?;
                both(both(x, y), z)
            }
            Self::Cylinder { radius, yspan } => {
                let side = within(origin.with_y(0.0), direction.with_y(0.0), radius)?;
                let caps = between(origin.y, direction.y, yspan / 2.0)?;
                both(side, caps)
            }
            Self::Ball(radius) => within(origin, direction, radius)?,
            Self::Polyhedron(ref polyhedron) => return polyhedron.entry(origin, direction),
        };
        (enter <= leave && enter >= 0.0).then_some(enter)
    }
}

/// The common part of two parts of a line.
fn both(a: (f32, f32), b: (f32, f32)) -> (f32, f32) {
    (a.0.max(b.0), a.1.min(b.1))
}

/// The part of a line between two parallel planes, each `half` away from the origin.
fn between(origin: f32, direction: f32, half: f32) -> Option<(f32, f32)> {
    if direction == 0.0 {
        return (origin.abs() <= half).then_some((f32::NEG_INFINITY, f32::INFINITY));
    }
    let [a, b] = [-half, half].map(|plane| (plane - origin) / direction);
    Some((a.min(b), a.max(b)))
}

/// The part of a line in a ball about the origin, or in an endless cylinder if the line is given without its
/// component along the axis.
fn within(origin: Vec3, direction: Vec3, radius: f32) -> Option<(f32, f32)> {
    let speed = direction.length_squared();
    if speed == 0.0 {
        let is_inside = origin.length_squared() <= radius * radius;
        return is_inside.then_some((f32::NEG_INFINITY, f32::INFINITY));
    }
    let nearest = -origin.dot(direction) / speed;
    // Measured from the nearest point of the line, not from its origin: exact for distant things, too.
    let room = radius * radius - (origin + direction * nearest).length_squared();
    let half_chord = (room >= 0.0).then(|| (room / speed).sqrt())?;
    Some((nearest - half_chord, nearest + half_chord))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Rgb;

    const CUBOID: Solid = Solid::Cuboid(Vec3::new(2.0, 4.0, 6.0));
    const CYLINDER: Solid = Solid::Cylinder {
        radius: 1.0,
        yspan: 4.0,
    };
    const BALL: Solid = Solid::Ball(1.5);

    fn distance(solid: &Solid, pose: Pose, origin: [f32; 3], direction: [f32; 3]) -> Option<f32> {
        let primitive = Primitive {
            pose: Pose::IDENTITY,
            solid: solid.clone(),
            color: Rgb::GRAY,
        };
        let direction = Dir3::new(direction.into()).unwrap();
        primitive.distance_along(Ray3d::new(origin.into(), direction), pose)
    }

    fn assert_distance(actual: Option<f32>, expected: f32) {
        assert!(
            actual.is_some_and(|actual| (actual - expected).abs() < 1e-3),
            "{actual:?} is not {expected}"
        );
    }

    #[test]
    fn a_ray_enters_where_it_first_meets_the_surface() {
        let down = [0.0, 0.0, -1.0];
        let at_rest = Pose::IDENTITY;
        assert_distance(distance(&CUBOID, at_rest, [0.5, 1.5, 10.0], down), 7.0);
        assert_distance(distance(&CYLINDER, at_rest, [0.6, 0.0, 10.0], down), 9.2);
        assert_distance(distance(&BALL, at_rest, [0.9, 0.0, 10.0], down), 8.8);
        let along = [0.0, 1.0, 0.0];
        assert_distance(distance(&CYLINDER, at_rest, [0.5, -9.0, 0.5], along), 7.0);
        let slanted = [0.0, 1.0, -1.0];
        assert_distance(
            distance(&CUBOID, at_rest, [0.0, -6.0, 6.0], slanted),
            32.0_f32.sqrt(),
        );
    }

    #[test]
    fn a_ray_that_passes_by_meets_nothing() {
        let down = [0.0, 0.0, -1.0];
        for (solid, beside) in [
            (CUBOID, [1.1, 0.0, 10.0]),
            (CUBOID, [0.0, 2.1, 10.0]),
            (CYLINDER, [1.1, 0.0, 10.0]),
            (CYLINDER, [0.0, 2.1, 10.0]),
            (BALL, [1.1, 1.1, 10.0]),
        ] {
            assert_eq!(distance(&solid, Pose::IDENTITY, beside, down), None);
        }
        // It enters above the caps, towards the axis.
        assert_eq!(
            distance(&CYLINDER, Pose::IDENTITY, [5.0, 2.5, 0.0], [-1.0, 0.0, 0.0]),
            None
        );
    }

    #[test]
    fn a_solid_behind_or_around_the_origin_is_not_entered() {
        for solid in [CUBOID, CYLINDER, BALL] {
            let up = [0.0, 0.0, 1.0];
            assert_eq!(distance(&solid, Pose::IDENTITY, [0.0, 0.0, 10.0], up), None);
            assert_eq!(distance(&solid, Pose::IDENTITY, [0.0; 3], up), None);
        }
    }

    #[test]
    fn a_solid_is_met_where_its_body_is() {
        let pose = Pose::from_degrees(Vec3::new(5.0, 0.0, 1.0), Vec3::new(90.0, 0.0, 0.0));
        let down = [0.0, 0.0, -1.0];
        // Its long Z extent now lies along Y, its Y extent stands upright.
        assert_distance(distance(&CUBOID, pose, [5.0, 2.9, 10.0], down), 7.0);
        assert_distance(distance(&CYLINDER, pose, [5.5, 0.0, 10.0], down), 7.0);
        assert_eq!(distance(&CUBOID, pose, [0.0, 0.0, 10.0], down), None);
    }

    #[test]
    fn a_small_thing_far_away_is_still_met() {
        let ball = Solid::Ball(0.01);
        assert_distance(
            distance(
                &ball,
                Pose::IDENTITY,
                [0.005, 0.0, 1000.0],
                [0.0, 0.0, -1.0],
            ),
            999.9913,
        );
    }
}
