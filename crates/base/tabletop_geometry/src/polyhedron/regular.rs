//! Prisms, frustums, rings and their wedges.

use std::f32::consts::TAU;

use bevy::prelude::*;

use crate::polyhedron::{
    FLAT, MOST_SIDES, Polyhedron, PolyhedronData,
    recipe::{Along, Recipe},
};

impl Polyhedron {
    /// A prism or frustum of a pyramid along Z, centred. Its ends are regular polygons of these circumscribed radii; their first corners
    /// are towards X.
    pub fn frustum(radius_top: f32, radius_bottom: f32, zspan: f32, sides: u32) -> Self {
        Self::tapered(Along::Z, [radius_bottom, radius_top], zspan, sides)
    }

    /// A prism along Y, centred, with its first corner towards X.
    pub fn prism(radius: f32, yspan: f32, sides: u32) -> Self {
        Self::tapered(Along::Y, [radius; 2], yspan, sides)
    }

    fn tapered(along: Along, radii: [f32; 2], span: f32, sides: u32) -> Self {
        let sides = sides.clamp(3, MOST_SIDES);
        let recipe = Recipe::Tapered {
            along,
            radii: radii.map(f32::to_bits),
            span: span.to_bits(),
            sides,
        };
        Self::rounded(recipe, sides, || {
            let rim = |end: usize, height| {
                (0..sides).map(move |side| {
                    along.point(height, radii[end], TAU * side as f32 / sides as f32)
                })
            };
            let corners = rim(0, -span / 2.0).chain(rim(1, span / 2.0)).collect();
            let walls = (0..sides).flat_map(|side| {
                let next = (side + 1) % sides;
                [
                    [side, next, sides + next],
                    [side, sides + next, sides + side],
                ]
            });
            let ends = (1..sides - 1)
                .flat_map(|side| [[0, side + 1, side], [sides, sides + side, sides + side + 1]]);
            (corners, walls.chain(ends).collect(), along.axis())
        })
    }

    /// A ring about Z, centred. Its hole is as wide as a circle of the inner radius. It is not convex.
    pub fn ring(radius_outer: f32, radius_inner: f32, zspan: f32, sides: u32) -> Self {
        let sides = sides.clamp(3, MOST_SIDES);
        let recipe = Recipe::Ring {
            radii: [radius_outer, radius_inner].map(f32::to_bits),
            span: zspan.to_bits(),
            sides,
        };
        Self::rounded(recipe, sides, || {
            let inner = around_circle(radius_inner, radius_outer, sides);
            let corners = (0..sides).flat_map(|side| {
                let angle = TAU * side as f32 / sides as f32;
                let corner = |radius, height: f32| Along::Z.point(height, radius, angle);
                let half = zspan / 2.0;
                [
                    corner(radius_outer, -half),
                    corner(radius_outer, half),
                    corner(inner, half),
                    corner(inner, -half),
                ]
            });
            let corners = corners.collect();
            let triangles = (0..sides).flat_map(|side| {
                let (this, next) = (4 * side, 4 * ((side + 1) % sides));
                (0..4).flat_map(move |corner| {
                    let (a, b) = (corner, (corner + 1) % 4);
                    [
                        [this + a, next + a, next + b],
                        [this + a, next + b, this + b],
                    ]
                })
            });
            (corners, triangles.collect(), Vec3::Z)
        })
    }

    /// The part of a [ring](Self::ring) between its first and second corner, in the frame of the ring. It is convex.
    pub fn wedge(radius_outer: f32, radius_inner: f32, zspan: f32, sides: u32) -> Self {
        let sides = sides.clamp(3, MOST_SIDES);
        let recipe = Recipe::Wedge {
            radii: [radius_outer, radius_inner].map(f32::to_bits),
            span: zspan.to_bits(),
            sides,
        };
        Self::kept(recipe, || {
            let inner = around_circle(radius_inner, radius_outer, sides);
            let corners = [-zspan / 2.0, zspan / 2.0].into_iter().flat_map(|height| {
                let corner = move |radius, side: f32| {
                    Along::Z.point(height, radius, TAU * side / sides as f32)
                };
                [
                    corner(inner, 0.0),
                    corner(radius_outer, 0.0),
                    corner(radius_outer, 1.0),
                    corner(inner, 1.0),
                ]
            });
            let corners = corners.collect();
            let walls = (0..4_u32).flat_map(|side| {
                let next = (side + 1) % 4;
                [[side, next, 4 + next], [side, 4 + next, 4 + side]]
            });
            let ends = [[0, 2, 1], [0, 3, 2], [4, 5, 6], [4, 6, 7]];
            PolyhedronData::new(corners, walls.chain(ends).collect(), None, FLAT)
        })
    }
}

/// Radius of the corners of a regular polygon around a circle, limited to less than the outer radius.
fn around_circle(radius: f32, outer: f32, sides: u32) -> f32 {
    let corner = radius / libm::cosf(TAU / 2.0 / sides as f32);
    corner.min(f32::midpoint(radius, outer))
}

#[cfg(test)]
mod tests {
    use std::f32::consts::PI;

    use super::*;

    /// True if every edge belongs to two triangles, which run along it in opposite directions.
    fn is_closed(polyhedron: &Polyhedron) -> bool {
        let mut edges: Vec<_> = polyhedron
            .triangles()
            .iter()
            .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
            .collect();
        edges.sort_unstable();
        edges
            .iter()
            .all(|&[a, b]| edges.binary_search(&[b, a]).is_ok())
            && edges.windows(2).all(|pair| pair[0] != pair[1])
    }

    #[test]
    fn made_polyhedra_are_closed_and_have_their_volume() {
        let cone = PI / 3.0 * (1.0 + 0.5 + 0.25) * 2.0;
        for (polyhedron, volume) in [
            (Polyhedron::frustum(0.5, 1.0, 2.0, 64), cone),
            (Polyhedron::frustum(1.0, 1.0, 2.0, 4), 4.0),
            (Polyhedron::prism(1.0, 2.0, 4), 4.0),
            (Polyhedron::ring(1.0, 0.5, 2.0, 64), PI * 1.5),
            (Polyhedron::wedge(1.0, 0.5, 2.0, 64), PI * 1.5 / 64.0),
        ] {
            assert!(is_closed(&polyhedron), "{polyhedron:?}");
            let found = polyhedron.volume();
            assert!((found / volume - 1.0).abs() < 0.005, "{found} {volume}");
        }
    }

    #[test]
    fn a_ring_is_its_wedges_and_its_hole_is_as_wide_as_it_says() {
        for sides in [3, 8, 32] {
            let ring = Polyhedron::ring(1.0, 0.45, 0.4, sides);
            let wedge = Polyhedron::wedge(1.0, 0.45, 0.4, sides);
            let whole = wedge.volume() * sides as f32;
            assert!((ring.volume() / whole - 1.0).abs() < 1e-4);
            let nearest = wedge.faces().map(|[a, b, c]| {
                let normal = (b - a).cross(c - a).normalize();
                match normal.z.abs() < 0.5 && a.truncate().length() < 1.0 {
                    true => normal.dot(a).abs(),
                    false => 1.0,
                }
            });
            let nearest = nearest.filter(|distance| *distance > 1e-3);
            let nearest = nearest.fold(1.0, f32::min);
            assert!(
                sides == 3 || (nearest - 0.45).abs() < 1e-3,
                "{sides}: {nearest}"
            );
        }
    }
}
