//! The outline of a body as the user sees it: of all its solids together, without lines where they overlap.
//!
//! It is computed, not drawn twice: seen from a point, a convex solid covers a convex polygon, and the outline of the
//! body consists of the parts of these polygons' edges that lie within no other polygon.

use bevy::prelude::*;
use tabletop_geometry::{Pose, Primitive, Solid};

use crate::{hull::convex_hull, polyhedron};

/// Parts that meet within this distance, in units at a distance of 1, have no gap between them: a tenth of a pixel.
const SEAM: f32 = 1e-4;

/// Nothing nearer than this can be seen, in units.
const NEAR: f32 = 0.01;

/// The outline of a body whose solids are `solids`, seen from `eye`, as lines in the world along its surface.
/// A body that reaches behind the eye has none.
pub(crate) fn outline(eye: Pose, body: Pose, solids: &[Primitive]) -> Vec<Vec<Vec3>> {
    let eye_from_body = eye.inverse() * body;
    let polygons: Option<Vec<Polygon>> = solids
        .iter()
        .map(|primitive| Polygon::covered_by(&primitive.solid, eye_from_body * primitive.pose))
        .collect();
    let Some(polygons) = polygons else {
        return Vec::new();
    };
    let mut lines = Vec::new();
    for (rank, polygon) in polygons.iter().enumerate() {
        lines.extend(polygon.visible_lines(rank, &polygons));
    }
    for point in lines.iter_mut().flatten() {
        *point = eye * *point;
    }
    lines
}

/// The polygon that a solid covers of the picture. Points are those of the solid in the frame of the eye, which looks along -Z, in
/// the picture counter-clockwise.
struct Polygon {
    corners: Vec<Corner>,
}

#[derive(Clone, Copy)]
struct Corner {
    point: Vec3,
    /// Its place in the picture, at a distance of 1.
    seen: Vec2,
}

/// A part of an edge, from 0 at its start to 1 at its end as seen.
type Stretch = (f32, f32);

impl Polygon {
    fn covered_by(solid: &Solid, eye_from_solid: Pose) -> Option<Self> {
        let points = if let Solid::Ball(radius) = *solid {
            rim_of_ball(eye_from_solid.location, radius)?
        } else {
            polyhedron::corners(solid)
                .into_iter()
                .map(|corner| eye_from_solid * corner)
                .collect()
        };
        let corners: Option<Vec<Corner>> = points.into_iter().map(Corner::of).collect();
        Some(Self {
            corners: convex_hull(corners?, |corner| corner.seen),
        })
    }

    fn edges(&self) -> impl Iterator<Item = (Corner, Corner)> {
        let next = self.corners.iter().cycle().skip(1);
        self.corners.iter().copied().zip(next.copied())
    }

    /// The parts of its edges that lie within no other polygon, joined where they meet.
    fn visible_lines(&self, rank: usize, polygons: &[Self]) -> Vec<Vec<Vec3>> {
        let mut lines: Vec<Vec<Vec3>> = Vec::new();
        let mut goes_on = false;
        let mut goes_on_at_first = false;
        for (index, edge) in self.edges().enumerate() {
            let stretches = visible_stretches(edge, rank, polygons);
            for &(from, to) in &stretches {
                match lines.last_mut() {
                    Some(line) if goes_on && from == 0.0 => line.push(point_at(edge, to)),
                    _ => lines.push(vec![point_at(edge, from), point_at(edge, to)]),
                }
                goes_on = to == 1.0;
            }
            goes_on &= stretches.last().is_some_and(|&(_, to)| to == 1.0);
            if index == 0 {
                goes_on_at_first = stretches.first().is_some_and(|&(from, _)| from == 0.0);
            }
        }
        if goes_on && goes_on_at_first {
            join_ends(&mut lines);
        }
        lines
    }

    /// The stretch of an edge of another polygon that lies within this one. Where edges of the two run along each other
    /// on the same side, the polygon that comes first keeps its edge.
    fn covered_stretch(
        &self,
        (start, end): (Corner, Corner),
        other_comes_first: bool,
    ) -> Option<Stretch> {
        let (mut from, mut to) = (0.0_f32, 1.0_f32);
        for (a, b) in self.edges() {
            let along = (b.seen - a.seen).normalize_or_zero();
            let depth = |corner: Corner| along.perp_dot(corner.seen - a.seen);
            let (at_start, at_end) = (depth(start), depth(end));
            let runs_along = at_start.abs() <= SEAM && at_end.abs() <= SEAM;
            if runs_along && other_comes_first && along.dot(end.seen - start.seen) > 0.0 {
                return None;
            }
            let (at_start, at_end) = (at_start + SEAM, at_end + SEAM);
            if at_start <= 0.0 && at_end <= 0.0 {
                return None;
            }
            let crossing = at_start / (at_start - at_end);
            if at_start < 0.0 {
                from = from.max(crossing);
            } else if at_end < 0.0 {
                to = to.min(crossing);
            }
        }
        (from < to).then_some((from, to))
    }
}

impl Corner {
    fn of(point: Vec3) -> Option<Self> {
        let seen = point.truncate() / -point.z;
        (point.z < -NEAR).then_some(Self { point, seen })
    }
}

/// The stretches of an edge of the polygon of this rank that no other polygon covers.
fn visible_stretches(edge: (Corner, Corner), rank: usize, polygons: &[Polygon]) -> Vec<Stretch> {
    let mut visible: Vec<Stretch> = vec![(0.0, 1.0)];
    for (other, polygon) in polygons.iter().enumerate() {
        if other == rank {
            continue;
        }
        if let Some((from, to)) = polygon.covered_stretch(edge, rank < other) {
            visible = visible
                .into_iter()
                .flat_map(|(start, end)| [(start, end.min(from)), (start.max(to), end)])
                .filter(|(start, end)| start < end)
                .collect();
        }
    }
    visible
}

/// The point that is seen at this fraction of an edge: more of its nearer part is seen than of its farther part.
fn point_at((start, end): (Corner, Corner), seen: f32) -> Vec3 {
    let [from_start, from_end] = [(1.0 - seen) / -start.point.z, seen / -end.point.z];
    start
        .point
        .lerp(end.point, from_end / (from_start + from_end))
}

/// Joins the last line, which ends where the first begins, to it. A single line becomes a closed one, which goes on a
/// little so that its first corner is joined like the others.
fn join_ends(lines: &mut Vec<Vec<Vec3>>) {
    if let [line] = &mut lines[..] {
        line.truncate(line.len() - 1);
        line.extend_from_within(..2);
    } else if let Some(mut last) = lines.pop() {
        last.pop();
        last.append(&mut lines[0]);
        lines[0] = last;
    }
}

/// The circle along which the lines of sight touch a ball, if the eye is outside.
fn rim_of_ball(center: Vec3, radius: f32) -> Option<Vec<Vec3>> {
    let distance = center.length();
    let nearness = radius / distance;
    if distance <= radius {
        return None;
    }
    let towards_ball = center / distance;
    let facing = Quat::from_rotation_arc(Vec3::Y, towards_ball);
    let middle = center - towards_ball * radius * nearness;
    let rim = polyhedron::rim(radius * (1.0 - nearness * nearness).sqrt());
    Some(rim.map(|point| middle + facing * point).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use tabletop_core::Shape;
    use tabletop_geometry::Rgb;

    /// Ten units above the origin, looking down, X to the right.
    fn above() -> Pose {
        Pose::at(Vec3::Z * 10.0)
    }

    fn block(x: f32, span: Vec3) -> Primitive {
        Primitive {
            pose: Pose::at(Vec3::X * x),
            solid: Solid::Cuboid(span),
            color: Rgb::GRAY,
        }
    }

    fn outline_from_above(solids: &[Primitive]) -> Vec<Vec<Vec3>> {
        outline(above(), Pose::IDENTITY, solids)
    }

    fn length(lines: &[Vec<Vec3>]) -> f32 {
        let of_line = |line: &Vec<Vec3>| -> f32 {
            line.windows(2).map(|ends| ends[0].distance(ends[1])).sum()
        };
        lines.iter().map(of_line).sum()
    }

    fn assert_near(actual: f32, expected: f32) {
        assert!(
            (actual - expected).abs() < 0.02,
            "{actual} is not {expected}"
        );
    }

    #[test]
    fn a_block_is_outlined_by_one_closed_line() {
        let lines = outline_from_above(&[block(0.0, Vec3::new(2.0, 3.0, 1.0))]);
        let [line] = &lines[..] else {
            panic!("{lines:?}");
        };
        assert_eq!(line.len(), 6);
        assert_eq!(line[..2], line[4..]);
        for point in line {
            assert_near(point.x.abs(), 1.0);
            assert_near(point.y.abs(), 1.5);
            assert_near(point.z, 0.5);
        }
    }

    #[test]
    fn parts_that_overlap_have_no_line_between_them() {
        let size = Vec3::new(2.0, 2.0, 1.0);
        let apart = outline_from_above(&[block(-2.0, size), block(2.0, size)]);
        assert_eq!(apart.len(), 2);
        let overlapping = outline_from_above(&[block(-0.5, size), block(0.5, size)]);
        // Three by two units, without the closing strokes that closed lines have.
        assert_near(length(&overlapping), 10.0);
        assert!(
            overlapping
                .iter()
                .flatten()
                .all(|point| point.x.abs() > 1.4 || point.y.abs() > 0.9)
        );
    }

    #[test]
    fn parts_that_touch_have_no_line_between_them() {
        let size = Vec3::new(2.0, 2.0, 1.0);
        let touching = outline_from_above(&[block(-1.0, size), block(1.0, size)]);
        assert_near(length(&touching), 12.0);
    }

    #[test]
    fn parts_that_share_an_edge_keep_one_of_them() {
        let solids = [
            block(0.0, Vec3::new(2.0, 2.0, 1.0)),
            block(0.0, Vec3::new(2.0, 2.0, 1.0)),
        ];
        let line = &outline_from_above(&solids)[..];
        assert_eq!(line.len(), 1);
        // A small one in a corner of a large one.
        let inside = Primitive {
            pose: Pose::at(Vec3::new(0.5, 0.5, 0.0)),
            ..block(0.0, Vec3::ONE)
        };
        let [outside, _] = solids;
        for solids in [[outside.clone(), inside.clone()], [inside, outside]] {
            let total = length(&outline_from_above(&solids));
            assert!((7.9..=10.1).contains(&total), "{total}");
        }
    }

    #[test]
    fn a_part_within_another_is_not_outlined() {
        let lines =
            outline_from_above(&[block(0.0, Vec3::new(4.0, 4.0, 1.0)), block(0.0, Vec3::ONE)]);
        assert_eq!(lines.len(), 1);
    }

    #[test]
    fn an_open_box_is_outlined_around_its_rim_only() {
        let shape = Shape::Box {
            span: Vec3::new(4.0, 3.0, 2.0),
            thickness: 0.2,
            color: Rgb::GRAY,
        };
        let lines = outline_from_above(&shape.drawn());
        let on_rim = |point: &Vec3| point.x.abs() > 1.99 || point.y.abs() > 1.49;
        assert!(lines.iter().flatten().all(on_rim), "{lines:?}");
    }

    #[test]
    fn a_ball_is_outlined_where_the_lines_of_sight_touch_it() {
        let ball = Primitive {
            solid: Solid::Ball(2.0),
            ..block(1.0, Vec3::ONE)
        };
        let lines = outline_from_above(&[ball]);
        assert_eq!(lines.len(), 1);
        let center = Vec3::X;
        for &point in &lines[0] {
            assert_near(point.distance(center), 2.0);
            let sight = point - above().location;
            assert_near(sight.normalize().dot((point - center).normalize()), 0.0);
        }
    }

    #[test]
    fn a_line_on_a_slanted_edge_stays_on_it_where_it_is_cut() {
        let slanted = Pose::from_degrees(Vec3::ZERO, Vec3::new(0.0, 50.0, 0.0));
        let long = block(0.0, Vec3::new(8.0, 0.5, 0.5));
        let across = block(0.0, Vec3::new(1.0, 4.0, 1.0));
        let lines = outline(above(), slanted, &[long, across]);
        for point in lines.into_iter().flatten() {
            let local = slanted.inverse() * point;
            let on_long = (local.y.abs() - 0.25).abs() < 1e-3 || local.x.abs() > 3.99;
            let on_across = (local.y.abs() - 2.0).abs() < 1e-3 || local.x.abs() < 0.501;
            assert!(on_long || on_across, "{local}");
        }
    }

    #[test]
    fn solids_that_reach_behind_the_eye_have_no_outline() {
        let wall = block(0.0, Vec3::new(1.0, 1.0, 30.0));
        assert!(outline_from_above(std::slice::from_ref(&wall)).is_empty());
        let around = Primitive {
            solid: Solid::Ball(11.0),
            ..wall
        };
        assert!(outline_from_above(&[around]).is_empty());
    }
}
