//! Plates: outlines with a thickness.

use bevy::math::{Vec2, Vec3};
use serde::Deserialize;

use super::{axis::LinkAxis, detail::Detail, hull::Hull};

/// A polygon drawn out along an axis. Lengths in m.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Extrusion {
    pub axis: LinkAxis,
    /// Its beginning on the axis.
    pub from: f32,
    /// Its end on the axis.
    pub to: f32,
    /// Corners of the polygon, as u and v. Its edges do not cross.
    pub outline: Vec<[f32; 2]>,
}

impl Extrusion {
    /// Its surface.
    pub fn hull(&self, detail: Detail) -> Hull {
        let outline: Vec<_> = detail
            .thinned(&self.outline)
            .into_iter()
            .filter_map(|i| self.outline.get(i).copied())
            .collect();
        let ring = |at: f32| {
            outline
                .iter()
                .map(|&[u, v]| self.axis.point(u, v, at))
                .collect()
        };
        let (lower, upper): (Vec<Vec3>, _) = (ring(self.from), ring(self.to));
        let mut hull = Hull::around(&[lower, upper]);
        let count = outline.len() as u32;
        let corners: Vec<_> = outline.into_iter().map(Vec2::from).collect();
        let is_clockwise = twice_area(&corners) < 0.0;
        for [a, b, c] in triangles_in(&corners) {
            let [a, b] = if is_clockwise { [b, a] } else { [a, b] };
            hull.triangles.push([b, a, c]);
            hull.triangles.push([a, b, c].map(|i| i + count));
        }
        hull.oriented()
    }
}

/// Twice the area of a polygon; negative if its corners go round clockwise.
fn twice_area(corners: &[Vec2]) -> f32 {
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum()
}

/// Divides a polygon into triangles that go round counterclockwise, by cutting off one corner after the other.
fn triangles_in(corners: &[Vec2]) -> Vec<[u32; 3]> {
    let mut left: Vec<usize> = (0..corners.len()).collect();
    if twice_area(corners) < 0.0 {
        left.reverse();
    }
    let mut triangles = Vec::new();
    while left.len() >= 3 {
        let count = left.len();
        let around = |i: usize| {
            [
                left[(i + count - 1) % count],
                left[i],
                left[(i + 1) % count],
            ]
        };
        let is_ear = |&i: &usize| {
            let ear = around(i);
            let [a, b, c] = ear.map(|corner| corners[corner]);
            let is_outside = |p: Vec2| {
                (b - a).perp_dot(p - a) < 0.0
                    || (c - b).perp_dot(p - b) < 0.0
                    || (a - c).perp_dot(p - c) < 0.0
            };
            (b - a).perp_dot(c - b) > 0.0
                && left
                    .iter()
                    .all(|other| ear.contains(other) || is_outside(corners[*other]))
        };
        // A polygon that crosses itself runs out of ears; then any corner will do.
        let i = (0..count).find(is_ear).unwrap_or(0);
        triangles.push(around(i).map(|corner| corner as u32));
        left.remove(i);
    }
    triangles
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polygon_with_a_dent_is_divided_without_filling_the_dent() {
        let dented = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 0.5], [0.0, 2.0]];
        for outline in [dented.to_vec(), dented.iter().rev().copied().collect()] {
            let corners: Vec<_> = outline.iter().copied().map(Vec2::from).collect();
            let triangles = triangles_in(&corners);
            assert_eq!(triangles.len(), 3);
            let area: f32 = triangles
                .iter()
                .map(|triangle| twice_area(&triangle.map(|i| corners[i as usize])))
                .inspect(|area| assert!(*area > 0.0))
                .sum();
            assert!((area - twice_area(&corners).abs()).abs() < 1e-6);
            let plate = Extrusion {
                axis: LinkAxis::Y,
                from: 0.5,
                to: 1.0,
                outline,
            };
            assert!((plate.hull(Detail::Fine).volume() - area / 4.0).abs() < 1e-6);
        }
    }

    #[test]
    fn senseless_outlines_do_no_harm() {
        for outline in [
            vec![],
            vec![[0.0, 0.0]],
            vec![[0.0, 0.0], [1.0, 0.0]],
            vec![[0.0; 2]; 5],
        ] {
            let plate = Extrusion {
                axis: LinkAxis::Z,
                from: 0.0,
                to: 1.0,
                outline,
            };
            plate.hull(Detail::Fine);
        }
    }
}
