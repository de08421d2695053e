//! Upright cuboids around objects.

use bevy::prelude::*;

/// An upright cuboid, in units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Its corner of the least coordinates.
    pub low: Vec3,
    /// Its corner of the greatest coordinates.
    pub high: Vec3,
}

impl Bounds {
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
        assert!(unit.is_below(Vec3::Z * 9.0) && !unit.is_below(Vec3::X));
    }
}
