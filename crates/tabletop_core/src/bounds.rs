//! Upright cuboids around objects.

use bevy::prelude::*;

use crate::{ChainSpec, LidBoxSpec, Pose, Primitive, SceneItem, Shape, Solid};

/// An upright cuboid, in units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Its corner of the least coordinates.
    pub low: Vec3,
    /// Its corner of the greatest coordinates.
    pub high: Vec3,
}

impl Bounds {
    /// Around the solids of a shape whose origin is at a pose.
    pub fn of_shape(shape: &Shape, at: Pose) -> Self {
        shape
            .colliding()
            .into_iter()
            .map(|part| Self::of_primitive(part, at))
            .reduce(Self::union)
            .unwrap_or(Self::around(at.location, Vec3::ZERO))
    }

    /// Around an element of a task file, roughly if it is a chain.
    pub fn of_item(item: &SceneItem) -> Self {
        match item {
            SceneItem::Object(object) => Self::of_shape(&object.shape, object.pose),
            SceneItem::Chain(chain) => Self::of_chain(chain),
            SceneItem::LidBox(lidbox) => Self::of_lidbox(lidbox),
            SceneItem::Jointed(jointed) => {
                let [first, second] = jointed
                    .placed()
                    .map(|object| Self::of_shape(&object.shape, object.pose));
                first.union(second)
            }
        }
    }

    fn of_chain(chain: &ChainSpec) -> Self {
        let reach = chain.link_span.max_element();
        Self::around(chain.start, Vec3::splat(reach))
            .union(Self::around(chain.end, Vec3::splat(reach)))
    }

    fn of_lidbox(lidbox: &LidBoxSpec) -> Self {
        let top = lidbox.thickness + lidbox.handle_span.z;
        let center = lidbox.pose * Pose::at(Vec3::Z * top / 2.0);
        Self::of_cuboid(lidbox.span + Vec3::Z * top, center)
    }

    /// Around a solid of a shape whose origin is at a pose.
    pub fn of_primitive(part: Primitive, at: Pose) -> Self {
        let at = at * part.pose;
        match part.solid {
            Solid::Cuboid(span) => Self::of_cuboid(span, at),
            Solid::Ball(radius) => Self::around(at.location, Vec3::splat(radius)),
            Solid::Cylinder { radius, yspan } => {
                let axis = at.rotation * Vec3::Y;
                let across = (Vec3::ONE - axis * axis).max(Vec3::ZERO).map(f32::sqrt);
                Self::around(at.location, axis.abs() * yspan / 2.0 + across * radius)
            }
            Solid::Polyhedron(polyhedron) => Self::of_polyhedron(polyhedron, at),
        }
    }

    fn of_cuboid(span: Vec3, at: Pose) -> Self {
        let half = span / 2.0;
        let reach = Mat3::from_quat(at.rotation).abs() * half;
        Self::around(at.location, reach)
    }

    /// Around a point, as far in each direction.
    pub fn around(center: Vec3, reach: Vec3) -> Self {
        Self {
            low: center - reach,
            high: center + reach,
        }
    }

    /// Around this one and another.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    /// Whether a point is straight above or below it, or in it.
    pub fn is_below(self, point: Vec3) -> bool {
        let point = point.xy();
        point.cmpge(self.low.xy()).all() && point.cmple(self.high.xy()).all()
    }

    /// Whether the two have points in common that are farther than a distance inside of both.
    pub fn overlaps(self, other: Self, distance: f32) -> bool {
        let depth = (self.high - other.low).min(other.high - self.low);
        depth.min_element() > distance
    }

    /// How far another one stands out of this one.
    pub fn distance_out(self, other: Self) -> f32 {
        (self.low - other.low)
            .max(other.high - self.high)
            .max_element()
            .max(0.0)
    }

    /// Whether less than this distance is between the two as seen from above.
    pub fn is_crowded_by(self, other: Self, distance: f32) -> bool {
        let gap = (self.low - other.high).max(other.low - self.high);
        gap.xy().max_element() < distance
    }
}

#[cfg(test)]
mod tests {
    use std::f32::consts::SQRT_2;

    use super::*;
    use crate::Rgb;

    #[test]
    fn turned_solids_reach_as_far_as_they_do() {
        let turned = Pose::from_degrees(Vec3::X, Vec3::new(0.0, 0.0, 45.0));
        let color = Rgb::GRAY;
        let block = Shape::Block {
            span: Vec3::new(1.0, 1.0, 2.0),
            color,
        };
        let cylinder = Shape::Cylinder {
            radius: 1.0,
            yspan: 2.0,
            color,
        };
        let ball = Shape::Sphere { radius: 0.5, color };
        for (shape, reach) in [
            (block, Vec3::new(SQRT_2 / 2.0, SQRT_2 / 2.0, 1.0)),
            (cylinder, Vec3::new(SQRT_2, SQRT_2, 1.0)),
            (ball, Vec3::splat(0.5)),
        ] {
            let bounds = Bounds::of_shape(&shape, turned);
            assert!(
                (bounds.low - (Vec3::X - reach)).length() < 1e-5,
                "{bounds:?}"
            );
            assert!(
                (bounds.high - (Vec3::X + reach)).length() < 1e-5,
                "{bounds:?}"
            );
        }
    }

    #[test]
    fn distances_between_and_out_of_cuboids() {
        let unit = Bounds::around(Vec3::ZERO, Vec3::splat(0.5));
        let beside = Bounds::around(Vec3::X * 1.2, Vec3::splat(0.5));
        assert!(unit.is_crowded_by(beside, 0.3) && !unit.is_crowded_by(beside, 0.1));
        assert!((unit.distance_out(beside) - 1.2).abs() < 1e-6);
        assert_eq!(unit.distance_out(unit), 0.0);
        let into = Bounds::around(Vec3::X * 0.9, Vec3::splat(0.5));
        assert!(unit.overlaps(into, 0.05) && into.overlaps(unit, 0.05));
        assert!(!unit.overlaps(into, 0.2) && !unit.overlaps(beside, 0.0));
        assert!(unit.is_below(Vec3::Z * 9.0) && !unit.is_below(Vec3::X));
    }
}
