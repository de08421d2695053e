//! Measuring of distances and angles on the table.

use bevy::prelude::*;

/// The points that the user measures: two are a distance, three also the angle at the second.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct Measuring {
    /// True while clicks set points.
    pub is_on: bool,
    points: Vec<Vec3>,
}

impl Measuring {
    /// The largest number of points.
    const MOST: usize = 3;

    /// Begins to measure, or ends and forgets the points.
    pub fn switch(&mut self) {
        *self = Self {
            is_on: !self.is_on,
            points: Vec::new(),
        };
    }

    /// Sets a point, in units. The one after the third is the first again.
    pub fn add(&mut self, point: Vec3) {
        if self.points.len() == Self::MOST {
            self.points.clear();
        }
        self.points.push(point);
    }

    /// The points, in units.
    pub fn points(&self) -> &[Vec3] {
        &self.points
    }

    /// The way from the last point but one to the last, in units.
    pub fn way(&self) -> Option<Vec3> {
        let [.., from, to] = self.points[..] else {
            return None;
        };
        Some(to - from)
    }

    /// The angle at the second of three points, in radians.
    pub fn angle(&self) -> Option<f32> {
        let [from, corner, to] = self.points[..] else {
            return None;
        };
        let [a, b] = [from - corner, to - corner];
        (a != Vec3::ZERO && b != Vec3::ZERO).then(|| a.angle_between(b))
    }
}

#[cfg(test)]
mod tests {
    use std::f32::consts::FRAC_PI_2;

    use super::*;

    #[test]
    fn two_points_are_a_distance_and_three_an_angle() {
        let mut measuring = Measuring::default();
        measuring.switch();
        assert!(measuring.is_on);
        let points = [Vec3::X, Vec3::ZERO, Vec3::Y * 2.0];
        let results = points.map(|point| {
            measuring.add(point);
            (measuring.way(), measuring.angle())
        });
        let ways = results.map(|(way, _)| way);
        assert_eq!(ways, [None, Some(Vec3::NEG_X), Some(Vec3::Y * 2.0)]);
        assert_eq!(results[1].1, None);
        let angle = results[2].1.unwrap();
        assert!((angle - FRAC_PI_2).abs() < 1e-3, "{angle}");
        measuring.add(Vec3::Z);
        assert_eq!(measuring.points(), [Vec3::Z]);
        measuring.switch();
        assert_eq!(measuring, Measuring::default());
    }

    #[test]
    fn there_is_no_angle_where_two_points_are_one() {
        let mut measuring = Measuring::default();
        for point in [Vec3::X, Vec3::X, Vec3::Y] {
            measuring.add(point);
        }
        assert_eq!(measuring.angle(), None);
    }
}
