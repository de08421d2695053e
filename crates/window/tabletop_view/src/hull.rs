//! The convex hull of points of a plane.

use bevy::prelude::*;

/// The corners of the convex hull, counter-clockwise, without those on straight edges.
pub(crate) fn convex_hull<T: Copy>(mut points: Vec<T>, place: impl Fn(T) -> Vec2) -> Vec<T> {
    let turns_left = |a: T, b: T, c: T| {
        let [a, b, c] = [a, b, c].map(&place);
        (b - a).perp_dot(c - b) > f32::EPSILON * a.distance(c)
    };
    points.sort_by(|&a, &b| {
        let (a, b) = (place(a), place(b));
        a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y))
    });
    let half = |points: &mut dyn Iterator<Item = T>| {
        let mut hull: Vec<T> = Vec::new();
        for point in points {
            while let [.., a, b] = hull[..]
                && !turns_left(a, b, point)
            {
                hull.pop();
            }
            hull.push(point);
        }
        hull.pop();
        hull
    };
    let mut hull = half(&mut points.iter().copied());
    hull.extend(half(&mut points.iter().rev().copied()));
    hull
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_corners_are_left_counter_clockwise() {
        let points = [
            (0.0, 0.0),
            (2.0, 0.0),
            (1.0, 0.0),
            (2.0, 2.0),
            (1.0, 1.0),
            (0.0, 2.0),
        ];
        let hull = convex_hull(points.map(Vec2::from).to_vec(), |point| point);
        let corners = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)];
        assert_eq!(hull, corners.map(Vec2::from));
    }
}
