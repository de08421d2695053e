//! Upright cuboids around objects.

use bevy::prelude::*;

/// Gap, in units, below which physics keeps two solids as a pair: contact prediction reaches so far, and the boxes of the broad phase are a
/// little larger.
pub const PAIR_GAP: f32 = 0.28;

/// An upright cuboid, in units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The corner of least coordinates.
    pub low: Vec3,
    /// The corner of greatest coordinates.
    pub high: Vec3,
}

impl Bounds {
    /// The bounds that reach equally far from a point to both sides of each axis.
    pub fn around(center: Vec3, reach: Vec3) -> Self {
        Self {
            low: center - reach,
            high: center + reach,
        }
    }

    /// The bounds of this one and another together.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    /// True if a point is inside, or straight above or below.
    pub fn is_below(self, point: Vec3) -> bool {
        let point = point.xy();
        point.cmpge(self.low.xy()).all() && point.cmple(self.high.xy()).all()
    }

    /// True if the two share a point that lies deeper than `distance` inside both.
    pub fn overlaps(self, other: Self, distance: f32) -> bool {
        let depth = (self.high - other.low).min(other.high - self.low);
        depth.min_element() > distance
    }

    /// True if the gap between the two, along each axis, is less than [`PAIR_GAP`].
    pub fn is_near(self, other: Self) -> bool {
        self.overlaps(other, -PAIR_GAP)
    }

    /// Distance by which another one stands out of this one.
    pub fn distance_out(self, other: Self) -> f32 {
        (self.low - other.low)
            .max(other.high - self.high)
            .max_element()
            .max(0.0)
    }

    /// True if the gap between the two, seen from above, is less than `distance`.
    pub fn is_crowded_by(self, other: Self, distance: f32) -> bool {
        let gap = (self.low - other.high).max(other.low - self.high);
        gap.xy().max_element() < distance
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        let farther = Bounds::around(Vec3::X * 1.3, Vec3::splat(0.5));
        assert!(unit.is_near(beside) && unit.is_near(unit) && !unit.is_near(farther));
        assert!(unit.is_below(Vec3::Z * 9.0) && !unit.is_below(Vec3::X));
    }
}
