//! Levels of detail of shapes.

use std::f64::consts::PI;

/// The level of detail of a shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Detail {
    /// For the window: round shapes look round.
    Fine,
    /// For the head camera: few triangles, and no parts smaller than its pixels.
    Coarse,
}

impl Detail {
    /// Distance in m by which triangles may miss the exact shape.
    pub const fn tolerance(self) -> f32 {
        match self {
            Self::Fine => 0.0003,
            Self::Coarse => 0.009,
        }
    }

    /// Extent in m along every axis up to which a part is left out.
    pub const fn least_extent(self) -> f32 {
        match self {
            Self::Fine => 0.0,
            Self::Coarse => 0.055,
        }
    }

    /// Number of straight lines for a circle of this radius, in m: even.
    pub fn segments(self, radius: f32) -> usize {
        let (least, most) = match self {
            Self::Fine => (12, 64),
            Self::Coarse => (6, 12),
        };
        let missed = f64::from(self.tolerance() / radius).min(1.0);
        let needed = PI / libm::acos(1.0 - missed);
        (needed.clamp(1.0, 1e3).ceil() as usize)
            .next_multiple_of(2)
            .clamp(least, most)
    }

    /// Leaves out points that lie, but for the tolerance, on the line between those that stay (Douglas and Peucker). The
    /// first and the last one stay. Coordinates in m.
    pub fn thinned<const N: usize>(self, points: &[[f32; N]]) -> Vec<usize> {
        let mut kept = vec![0];
        if let Some(last) = points.len().checked_sub(1).filter(|&last| last > 0) {
            self.keep_between(points, 0, last, &mut kept);
            kept.push(last);
        }
        kept
    }

    fn keep_between<const N: usize>(
        self,
        points: &[[f32; N]],
        first: usize,
        last: usize,
        kept: &mut Vec<usize>,
    ) {
        let farthest = (first + 1..last)
            .map(|i| {
                (
                    distance_from_line(points[i], points[first], points[last]),
                    i,
                )
            })
            .max_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((distance, i)) = farthest
            && distance > self.tolerance()
        {
            self.keep_between(points, first, i, kept);
            kept.push(i);
            self.keep_between(points, i, last, kept);
        }
    }
}

fn distance_from_line<const N: usize>(point: [f32; N], from: [f32; N], to: [f32; N]) -> f32 {
    let dot = |a: [f32; N], b: [f32; N]| a.into_iter().zip(b).map(|(a, b)| a * b).sum::<f32>();
    let less = |a: [f32; N], b: [f32; N]| std::array::from_fn(|i| a[i] - b[i]);
    let (along, to_point) = (less(to, from), less(point, from));
    let part = (dot(along, to_point) / dot(along, along).max(1e-12)).clamp(0.0, 1.0);
    let missed = less(to_point, along.map(|a| a * part));
    dot(missed, missed).sqrt()
}

#[cfg(test)]
impl Detail {
    /// Both.
    pub const BOTH: [Self; 2] = [Self::Fine, Self::Coarse];
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_is_missed_by_no_more_than_the_tolerance() {
        for detail in Detail::BOTH {
            for radius in [0.01, 0.05, 0.08] {
                let segments = detail.segments(radius);
                let missed = radius * (1.0 - (std::f32::consts::PI / segments as f32).cos());
                assert!(
                    missed <= detail.tolerance(),
                    "{detail:?} {radius}: {missed}"
                );
                assert_eq!(segments % 2, 0);
            }
            for radius in [0.0, 1e-30, 1e30, f32::INFINITY, f32::NAN, -1.0] {
                assert!((6..=64).contains(&detail.segments(radius)));
            }
        }
    }

    #[test]
    fn points_on_a_line_are_left_out() {
        let points = [
            [0.0, 0.0],
            [0.1, 0.0001],
            [0.2, 0.0],
            [0.2, 0.1],
            [0.2, 0.3],
        ];
        assert_eq!(Detail::Fine.thinned(&points), [0, 2, 4]);
        assert_eq!(Detail::Fine.thinned::<2>(&points[..1]), [0]);
        assert_eq!(Detail::Fine.thinned::<2>(&[]), [0]);
    }
}
