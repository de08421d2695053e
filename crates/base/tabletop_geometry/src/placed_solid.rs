//! Convex solids with their poses, and their distances (Gilbert, Johnson and Keerthi's algorithm).

use bevy::math::{Vec2, Vec3, Vec3Swizzles as _};

use crate::{Bounds, Pose, Primitive, Solid};

/// A convex solid with its pose, in the table's frame.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedSolid {
    /// The pose of its centre.
    pub pose: Pose,
    /// The solid.
    pub solid: Solid,
}

impl PlacedSolid {
    /// A solid of a body at this pose.
    pub fn of(primitive: &Primitive, body: Pose) -> Self {
        Self {
            pose: body * primitive.pose,
            solid: primitive.solid.clone(),
        }
    }

    /// The point that lies farthest in a direction.
    pub fn farthest(&self, direction: Vec3) -> Vec3 {
        let d = self.pose.rotation.inverse() * direction;
        let point = match self.solid {
            Solid::Cuboid(span) => span / 2.0 * d.signum(),
            Solid::Cylinder { radius, yspan } => {
                let across = Vec2::new(d.x, d.z).normalize_or_zero() * radius;
                Vec3::new(across.x, yspan / 2.0 * d.y.signum(), across.y)
            }
            Solid::Ball(radius) => d.normalize_or_zero() * radius,
            Solid::Polyhedron(ref polyhedron) => polyhedron.farthest(d),
        };
        self.pose * point
    }

    /// Where solids begin and end in a direction, in units.
    pub fn extent(solids: &[Self], way: Vec3) -> [f32; 2] {
        let reach = |way: Vec3| {
            let all = solids.iter().map(|solid| solid.farthest(way).dot(way));
            all.fold(f32::NEG_INFINITY, f32::max)
        };
        [-reach(-way), reach(way)]
    }

    /// Radius of the ball about its centre that encloses it.
    pub fn radius(&self) -> f32 {
        match self.solid {
            Solid::Cuboid(span) => span.length() / 2.0,
            Solid::Cylinder { radius, yspan } => libm::hypotf(radius, yspan / 2.0),
            Solid::Ball(radius) => radius,
            Solid::Polyhedron(ref polyhedron) => polyhedron.radius(),
        }
    }

    /// Its lowest and highest Z.
    pub fn heights(&self) -> [f32; 2] {
        [Vec3::NEG_Z, Vec3::Z].map(|way| self.farthest(way).z)
    }

    /// The same solid, made thinner by this length on all sides.
    pub fn shrunk(&self, by: f32) -> Self {
        let less = |extent: f32| (extent - 2.0 * by).max(extent * 0.1);
        let mut pose = self.pose;
        let solid = match self.solid {
            Solid::Cuboid(span) => Solid::Cuboid(span.map(less)),
            Solid::Cylinder { radius, yspan } => Solid::Cylinder {
                radius: less(2.0 * radius) / 2.0,
                yspan: less(yspan),
            },
            Solid::Ball(radius) => Solid::Ball(less(2.0 * radius) / 2.0),
            Solid::Polyhedron(ref polyhedron) => {
                let Bounds { low, high } = polyhedron.bounds();
                let (middle, span) = (low.midpoint(high), high - low);
                let factors = span.map(less) / span.max(Vec3::splat(f32::MIN_POSITIVE));
                // About its middle, not about the origin of its frame.
                pose.location += pose.rotation * (middle - middle * factors);
                Solid::Polyhedron(polyhedron.scaled(factors.max(Vec3::splat(0.1))))
            }
        };
        Self { pose, solid }
    }

    /// The same solid, moved.
    pub fn moved(&self, by: Vec3) -> Self {
        Self {
            pose: Pose {
                location: self.pose.location + by,
                ..self.pose
            },
            solid: self.solid.clone(),
        }
    }

    /// The vector from the other solid's nearest point to this one's; zero if they overlap.
    pub fn away_from(&self, other: &Self) -> Vec3 {
        self.away(other, None)
    }

    /// True if they are nearer to each other than this distance.
    pub fn is_within(&self, distance: f32, other: &Self) -> bool {
        let between = self.pose.location.distance(other.pose.location);
        between - self.radius() - other.radius() < distance
            && self.away(other, Some(distance)).length() < distance
    }

    fn away(&self, other: &Self, enough: Option<f32>) -> Vec3 {
        nearest_to_origin(self.pose.location - other.pose.location, enough, |way| {
            self.farthest(way) - other.farthest(-way)
        })
    }

    /// Gap between the two, seen from above; 0 if one is above a part of the other.
    pub fn gap_from_above(&self, other: &Self) -> f32 {
        let flat = |point: Vec3| point.xy().extend(0.0);
        let between = self.pose.location - other.pose.location;
        nearest_to_origin(flat(between), None, |way| {
            let way = flat(way);
            flat(self.farthest(way) - other.farthest(-way))
        })
        .length()
    }

    /// True if a ray meets it.
    pub fn is_hit_by(&self, from: Vec3, towards: Vec3) -> bool {
        let origin = self.pose.inverse() * from;
        let ray = self.pose.rotation.inverse() * towards;
        self.solid.contains(origin) || self.solid.entry(origin, ray).is_some()
    }
}

/// The point of a convex set that is nearest to the origin. The set is given by its farthest points. As soon as it is clear on which side
/// of the distance `enough` the nearest point is, any point on that side does.
fn nearest_to_origin(inside: Vec3, enough: Option<f32>, farthest: impl Fn(Vec3) -> Vec3) -> Vec3 {
    const STEPS: usize = 64;
    let mut nearest = farthest(-inside);
    let mut simplex = Simplex::of(nearest);
    for _ in 0..STEPS {
        let length = nearest.length_squared();
        if length < 1e-10 {
            return Vec3::ZERO;
        }
        let next = farthest(-nearest);
        let towards = nearest.dot(next);
        if let Some(enough) = enough {
            // No point is nearer than its component along the nearest known one.
            let is_beyond = towards > 0.0 && towards * towards > length * enough * enough;
            if is_beyond || length < enough * enough {
                break;
            }
        }
        // No point is nearer than this one.
        let gain = length - towards;
        if gain <= 1e-5 * length.max(1e-4) || simplex.corners().contains(&next) {
            break;
        }
        simplex.add(next);
        let (point, kept) = simplex.nearest();
        if kept.count == 4 {
            return Vec3::ZERO;
        }
        if point.length_squared() >= length {
            break;
        }
        (nearest, simplex) = (point, kept);
    }
    nearest
}

/// A simplex of up to four corners.
#[derive(Clone, Copy)]
struct Simplex {
    all: [Vec3; 4],
    count: usize,
}

impl Simplex {
    fn of(corner: Vec3) -> Self {
        Self {
            all: [corner; 4],
            count: 1,
        }
    }

    fn corners(&self) -> &[Vec3] {
        &self.all[..self.count]
    }

    fn add(&mut self, corner: Vec3) {
        self.all[self.count] = corner;
        self.count += 1;
    }

    /// The point nearest to the origin, and the corners between which it lies.
    fn nearest(&self) -> (Vec3, Self) {
        // The foot of the origin on every face that contains it, in ascending dimension.
        let mut best: Option<(Vec3, Self)> = None;
        for chosen in 1_u32..1 << self.count {
            let mut face = Self {
                all: self.all,
                count: 0,
            };
            for (i, corner) in self.corners().iter().enumerate() {
                if chosen & (1 << i) != 0 {
                    face.add(*corner);
                }
            }
            if let Some(foot) = face.foot()
                && best.as_ref().is_none_or(|(nearest, kept)| {
                    let (new, old) = (foot.length_squared(), nearest.length_squared());
                    new < old - 1e-12 || (face.count < kept.count && new <= old)
                })
            {
                best = Some((foot, face));
            }
        }
        best.unwrap_or_else(|| (self.all[0], Self::of(self.all[0])))
    }

    /// The foot of the perpendicular from the origin, if it is within the simplex.
    fn foot(&self) -> Option<Vec3> {
        let weights: [f32; 4] = match *self.corners() {
            [_] => [1.0, 0.0, 0.0, 0.0],
            [a, b] => {
                let along = b - a;
                let t = -a.dot(along) / along.length_squared();
                [1.0 - t, t, 0.0, 0.0]
            }
            [a, b, c] => {
                let (u, v) = (b - a, c - a);
                let (uu, uv, vv) = (u.dot(u), u.dot(v), v.dot(v));
                let (au, av) = (-a.dot(u), -a.dot(v));
                let det = uu * vv - uv * uv;
                let (s, t) = ((au * vv - av * uv) / det, (av * uu - au * uv) / det);
                [1.0 - s - t, s, t, 0.0]
            }
            [a, b, c, d] => {
                let (u, v, w) = (b - a, c - a, d - a);
                let det = u.dot(v.cross(w));
                let [r, s, t] = [
                    -a.dot(v.cross(w)) / det,
                    u.dot((-a).cross(w)) / det,
                    u.dot(v.cross(-a)) / det,
                ];
                [1.0 - r - s - t, r, s, t]
            }
            _ => return None,
        };
        let is_within = weights
            .iter()
            .all(|weight| weight.is_finite() && *weight >= 0.0);
        is_within.then(|| {
            let corners = self.corners().iter().zip(weights);
            corners.map(|(corner, weight)| *corner * weight).sum()
        })
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn convex(solid: Solid, location: Vec3, degrees: Vec3) -> PlacedSolid {
        PlacedSolid {
            pose: Pose::from_degrees(location, degrees),
            solid,
        }
    }

    #[test]
    fn distances_are_those_of_geometry() {
        let cube = convex(Solid::Cuboid(Vec3::splat(2.0)), Vec3::ZERO, Vec3::ZERO);
        for (other, expected) in [
            (
                convex(Solid::Ball(1.0), Vec3::X * 5.0, Vec3::ZERO),
                Vec3::X * -3.0,
            ),
            (
                convex(Solid::Ball(1.0), Vec3::X * 1.5, Vec3::ZERO),
                Vec3::ZERO,
            ),
            (
                convex(
                    Solid::Cuboid(Vec3::ONE),
                    Vec3::new(0.5, 0.2, 2.0),
                    Vec3::ZERO,
                ),
                Vec3::Z * -0.5,
            ),
            (
                convex(
                    Solid::Cylinder {
                        radius: 0.5,
                        yspan: 4.0,
                    },
                    Vec3::Z * 4.0,
                    Vec3::X * 90.0,
                ),
                Vec3::Z * -1.0,
            ),
        ] {
            let found = cube.away_from(&other);
            assert!(
                (found - expected).length() < 1e-3,
                "{found} is not {expected}"
            );
        }
    }

    fn solid() -> impl Strategy<Value = Solid> {
        prop_oneof![
            (0.1..3.0_f32, 0.1..3.0_f32, 0.1..3.0_f32)
                .prop_map(|(x, y, z)| Solid::Cuboid(Vec3::new(x, y, z))),
            (0.1..2.0_f32, 0.1..3.0_f32)
                .prop_map(|(radius, yspan)| Solid::Cylinder { radius, yspan }),
            (0.1..2.0_f32).prop_map(Solid::Ball),
        ]
    }

    fn vector(limit: f32) -> impl Strategy<Value = Vec3> {
        (-limit..limit, -limit..limit, -limit..limit).prop_map(Vec3::from)
    }

    proptest! {
        #[test]
        fn the_nearest_points_are_separated_by_planes_through_them(
            a in solid(), b in solid(), at in vector(5.0), turned in vector(180.0),
        ) {
            let (a, b) = (convex(a, Vec3::ZERO, Vec3::ZERO), convex(b, at, turned));
            let away = a.away_from(&b);
            let back = b.away_from(&a);
            prop_assert!((away + back).length() < 1e-2, "{away} and back {back}");
            prop_assert!(a.is_within(away.length() + 0.02, &b));
            prop_assert!(!a.is_within(away.length() - 0.02, &b));
            if away.length() > 0.02 {
                // All of `a` lies beyond all of `b` by the distance, in this direction.
                let way = away.normalize();
                let between = a.farthest(-way).dot(way) - b.farthest(way).dot(way);
                prop_assert!((between - away.length()).abs() < 1e-2);
            }
        }

        #[test]
        fn a_ray_through_an_inner_point_hits(
            solid in solid(), at in vector(5.0), turned in vector(180.0), way in vector(1.0),
        ) {
            prop_assume!(way.length() > 0.1);
            let convex = convex(solid, at, turned);
            prop_assert!(convex.is_hit_by(at - way * 20.0, way));
            prop_assert!(!convex.is_hit_by(at + way.normalize() * 20.0, way));
        }
    }
}
