//! Solids with flat faces: what frustums, rings and meshes are made of.

use std::{
    collections::{BTreeMap, HashMap},
    f32::consts::TAU,
    fmt,
    sync::{Mutex, PoisonError},
};

use bevy::prelude::*;

use crate::{Bounds, Pose, Rgb, Triangles, figure::enter_triangle};

/// As many sides and more look round, and are meant to: 20° and less between two of them.
pub const ROUND_SIDES: u32 = 18;

/// More sides than these are not to be told apart: a solid with more has so many.
pub const MOST_SIDES: u32 = 64;

/// A solid with flat faces, in its own frame. Each is kept once as long as the program runs, so that a copy is a reference and equal ones are
/// the same.
#[derive(Clone, Copy)]
pub struct Polyhedron(&'static Facets);

/// What a polyhedron is.
struct Facets {
    /// Its place among all.
    number: usize,
    corners: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    bounds: Bounds,
    volume: f32,
    axis: Option<Vec3>,
    crease: f32,
}

/// Why numbers are no polyhedron.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PolyhedronError {
    /// It has no triangles.
    #[error("it has no triangles")]
    Empty,
    /// A coordinate is no number or beyond a million units.
    #[error("a corner is not a place")]
    NoPlace,
    /// A triangle names a corner that is not there.
    #[error("a triangle has a corner that is not there")]
    NoCorner,
}

/// The polyhedra that there are.
#[derive(Default)]
struct Kept {
    count: usize,
    /// By what they are made of.
    made: BTreeMap<Recipe, Polyhedron>,
    read: HashMap<(Vec<[u32; 3]>, Vec<[u32; 3]>), Polyhedron>,
}

static KEPT: Mutex<Option<Kept>> = Mutex::new(None);

/// What a polyhedron is made of, with the bits of its lengths.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Recipe {
    Tapered {
        along: Along,
        radii: [u32; 2],
        span: u32,
        sides: u32,
    },
    Ring {
        radii: [u32; 2],
        span: u32,
        sides: u32,
    },
    Wedge {
        radii: [u32; 2],
        span: u32,
        sides: u32,
    },
    Scaled {
        of: usize,
        by: [u32; 3],
    },
}

/// The axis of a solid.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Along {
    Y,
    Z,
}

impl Along {
    const fn axis(self) -> Vec3 {
        match self {
            Self::Y => Vec3::Y,
            Self::Z => Vec3::Z,
        }
    }

    /// The point at a height on the axis and so far from it, at an angle from X.
    fn point(self, height: f32, radius: f32, angle: f32) -> Vec3 {
        let (sin, cos) = libm::sincosf(angle);
        match self {
            Self::Y => Vec3::new(radius * cos, height, -radius * sin),
            Self::Z => Vec3::new(radius * cos, radius * sin, height),
        }
    }
}

impl Polyhedron {
    /// Of these corners and triangles, whose corners go round counterclockwise as seen from outside. A solid if they enclose one.
    ///
    /// # Errors
    /// There is no triangle, or the numbers are no places or no corners.
    pub fn new(corners: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Result<Self, PolyhedronError> {
        const FARTHEST: f32 = 1e6;
        if triangles.is_empty() {
            return Err(PolyhedronError::Empty);
        }
        let is_place = |corner: &Vec3| corner.abs().cmple(Vec3::splat(FARTHEST)).all();
        if !corners.iter().all(is_place) {
            return Err(PolyhedronError::NoPlace);
        }
        if !triangles
            .iter()
            .flatten()
            .all(|&corner| (corner as usize) < corners.len())
        {
            return Err(PolyhedronError::NoCorner);
        }
        let bits = corners
            .iter()
            .map(|corner| corner.to_array().map(f32::to_bits))
            .collect();
        Ok(with_kept(|kept| {
            let key = (bits, triangles.clone());
            if let Some(known) = kept.read.get(&key) {
                return *known;
            }
            let new = kept.keep(corners, triangles, None, FLAT);
            kept.read.insert(key, new);
            new
        }))
    }

    /// A prism or a part of a pyramid along Z, centred: with regular ends of these circumscribed radii, whose first corners are
    /// towards X.
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
        Self::made(recipe, || {
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

    /// A ring about Z, centred, whose hole is as wide as a circle of the inner radius. It is not convex.
    pub fn ring(radius_outer: f32, radius_inner: f32, zspan: f32, sides: u32) -> Self {
        let sides = sides.clamp(3, MOST_SIDES);
        let recipe = Recipe::Ring {
            radii: [radius_outer, radius_inner].map(f32::to_bits),
            span: zspan.to_bits(),
            sides,
        };
        Self::made(recipe, || {
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

    /// The part of a [ring](Self::ring) from its first corner to its second one, in the frame of the ring. It is convex.
    pub fn wedge(radius_outer: f32, radius_inner: f32, zspan: f32, sides: u32) -> Self {
        let sides = sides.clamp(3, MOST_SIDES);
        let recipe = Recipe::Wedge {
            radii: [radius_outer, radius_inner].map(f32::to_bits),
            span: zspan.to_bits(),
            sides,
        };
        Self::made(recipe, || {
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
            (corners, walls.chain(ends).collect(), Vec3::Z)
        })
    }

    /// Stretched along its axes from its frame's origin, by factors above 0.
    #[must_use]
    pub fn scaled(self, by: Vec3) -> Self {
        let recipe = Recipe::Scaled {
            of: self.0.number,
            by: by.to_array().map(f32::to_bits),
        };
        with_kept(|kept| {
            if let Some(known) = kept.made.get(&recipe) {
                return *known;
            }
            let corners = self.0.corners.iter().map(|corner| *corner * by).collect();
            let new = kept.keep(
                corners,
                self.0.triangles.clone(),
                self.0.axis,
                self.0.crease,
            );
            kept.made.insert(recipe, new);
            new
        })
    }

    fn made(recipe: Recipe, make: impl FnOnce() -> (Vec<Vec3>, Vec<[u32; 3]>, Vec3)) -> Self {
        with_kept(|kept| {
            if let Some(known) = kept.made.get(&recipe) {
                return *known;
            }
            let (corners, triangles, axis) = make();
            let (is_round, crease) = match recipe {
                Recipe::Tapered { sides, .. } | Recipe::Ring { sides, .. } => {
                    (sides >= ROUND_SIDES, ROUND)
                }
                Recipe::Wedge { .. } | Recipe::Scaled { .. } => (false, FLAT),
            };
            let new = kept.keep(corners, triangles, is_round.then_some(axis), crease);
            kept.made.insert(recipe, new);
            new
        })
    }

    /// Its corners.
    pub fn corners(self) -> &'static [Vec3] {
        &self.0.corners
    }

    /// Its surface, as triangles of its corners, counterclockwise as seen from outside.
    pub fn triangles(self) -> &'static [[u32; 3]] {
        &self.0.triangles
    }

    /// The corners of each triangle.
    pub fn faces(self) -> impl Iterator<Item = [Vec3; 3]> {
        let place = |corner: u32| self.0.corners[corner as usize];
        self.0
            .triangles
            .iter()
            .map(move |triangle| triangle.map(place))
    }

    /// The edges of its triangles, each once, as pairs of corners.
    pub fn edges(self) -> Vec<[usize; 2]> {
        let mut edges: Vec<_> = self
            .0
            .triangles
            .iter()
            .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
            .map(|[a, b]| [a.min(b) as usize, a.max(b) as usize])
            .collect();
        edges.sort_unstable();
        edges.dedup();
        edges
    }

    /// The upright cuboid around it, in its own frame.
    pub fn bounds(self) -> Bounds {
        self.0.bounds
    }

    /// The corner that lies farthest in a direction.
    pub fn farthest(self, direction: Vec3) -> Vec3 {
        let corners = self.0.corners.iter().copied();
        corners
            .max_by(|a, b| a.dot(direction).total_cmp(&b.dot(direction)))
            .unwrap_or_default()
    }

    /// The radius of the ball about its frame's origin that holds it.
    pub fn radius(self) -> f32 {
        let distances = self.0.corners.iter().map(|corner| corner.length());
        distances.fold(0.0, f32::max)
    }

    /// Its volume in cubic units.
    pub fn volume(self) -> f32 {
        self.0.volume
    }

    /// The axis that it is round about, if it is meant to be.
    pub fn axis(self) -> Option<Vec3> {
        self.0.axis
    }

    /// Its place among all polyhedra of the program: different in the next run.
    pub fn number(self) -> usize {
        self.0.number
    }

    /// Where a ray enters it through its surface, as a factor of the direction. A ray that begins inside does not enter.
    pub fn entry(self, origin: Vec3, direction: Vec3) -> Option<f32> {
        self.faces()
            .filter_map(|[a, b, c]| enter_triangle(origin, direction, a, b, c))
            .min_by(f32::total_cmp)
    }

    /// Whether a point is inside, if it is convex.
    pub fn contains(self, point: Vec3) -> bool {
        self.faces()
            .all(|[a, b, c]| (b - a).cross(c - a).dot(point - a) <= 0.0)
    }

    /// How far outside of it a point is, if it is convex.
    pub fn distance_to(self, point: Vec3) -> f32 {
        if self.contains(point) {
            return 0.0;
        }
        let distances = self
            .faces()
            .map(|face| nearest_of_triangle(face, point).distance(point));
        distances.fold(f32::INFINITY, f32::min)
    }

    /// Its surface in a colour, with normals: those of its faces, and of the round surface where it is meant to be one.
    pub fn surface(self, color: Rgb) -> Triangles {
        let Facets {
            corners,
            triangles,
            crease,
            ..
        } = self.0;
        let area = |&[a, b, c]: &[u32; 3]| {
            let [a, b, c] = [a, b, c].map(|corner| corners[corner as usize]);
            (b - a).cross(c - a)
        };
        let areas: Vec<Vec3> = triangles.iter().map(area).collect();
        let normals: Vec<Vec3> = areas.iter().map(|area| area.normalize_or_zero()).collect();
        let mut around = vec![Vec::new(); corners.len()];
        for (index, triangle) in triangles.iter().enumerate() {
            for &corner in triangle {
                around[corner as usize].push(index);
            }
        }
        let mut surface = Triangles::default();
        let mut known = HashMap::new();
        for (index, triangle) in triangles.iter().enumerate() {
            let vertices = triangle.map(|corner| {
                let smooth = around[corner as usize]
                    .iter()
                    .filter(|&&other| normals[other].dot(normals[index]) >= *crease)
                    .map(|&other| areas[other]);
                let normal = smooth.sum::<Vec3>().normalize_or(normals[index]);
                let key = (corner, normal.to_array().map(f32::to_bits));
                *known.entry(key).or_insert_with(|| {
                    surface.positions.push(corners[corner as usize]);
                    surface.normals.push(normal);
                    surface.colors.push(color);
                    surface.positions.len() as u32 - 1
                })
            });
            surface.indices.push(vertices);
        }
        surface
    }
}

/// The point of a triangle that is nearest to another point.
fn nearest_of_triangle([a, b, c]: [Vec3; 3], point: Vec3) -> Vec3 {
    let (ab, ac) = (b - a, c - a);
    let normal = ab.cross(ac);
    let area = normal.length_squared();
    if area > 0.0 {
        let from_a = point - a;
        let v = from_a.cross(ac).dot(normal) / area;
        let w = ab.cross(from_a).dot(normal) / area;
        if v >= 0.0 && w >= 0.0 && v + w <= 1.0 {
            return a + ab * v + ac * w;
        }
    }
    let on_edges = [(a, b), (b, c), (c, a)].map(|(start, end)| {
        let along = end - start;
        let length = along.length_squared().max(f32::MIN_POSITIVE);
        start + along * ((point - start).dot(along) / length).clamp(0.0, 1.0)
    });
    let [first, others @ ..] = on_edges;
    others.into_iter().fold(first, |nearest, other| {
        match other.distance_squared(point) < nearest.distance_squared(point) {
            true => other,
            false => nearest,
        }
    })
}

/// Cosines of the angles below which faces are parts of the same surface: a flat one, and a round one of [`ROUND_SIDES`].
const FLAT: f32 = 0.999_96;
const ROUND: f32 = 0.939;

/// The radius of the corners of a regular polygon around a circle, but less than the outer radius.
fn around_circle(radius: f32, outer: f32, sides: u32) -> f32 {
    let corner = radius / libm::cosf(TAU / 2.0 / sides as f32);
    corner.min(f32::midpoint(radius, outer))
}

fn with_kept<T>(act: impl FnOnce(&mut Kept) -> T) -> T {
    let mut kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    act(kept.get_or_insert_default())
}

impl Kept {
    fn keep(
        &mut self,
        corners: Vec<Vec3>,
        triangles: Vec<[u32; 3]>,
        axis: Option<Vec3>,
        crease: f32,
    ) -> Polyhedron {
        let number = self.count;
        self.count += 1;
        let low = corners.iter().copied().reduce(Vec3::min);
        let high = corners.iter().copied().reduce(Vec3::max);
        let six_volumes = triangles.iter().map(|triangle| {
            let [a, b, c] = triangle.map(|corner| corners[corner as usize].as_dvec3());
            a.dot(b.cross(c))
        });
        Polyhedron(Box::leak(Box::new(Facets {
            number,
            bounds: Bounds {
                low: low.unwrap_or_default(),
                high: high.unwrap_or_default(),
            },
            volume: (six_volumes.sum::<f64>() / 6.0) as f32,
            corners,
            triangles,
            axis,
            crease,
        })))
    }
}

impl PartialEq for Polyhedron {
    fn eq(&self, other: &Self) -> bool {
        self.0.number == other.0.number
    }
}

impl Eq for Polyhedron {}

impl fmt::Debug for Polyhedron {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Bounds { low, high } = self.0.bounds;
        write!(
            f,
            "Polyhedron({} corners from {low} to {high})",
            self.0.corners.len()
        )
    }
}

impl Bounds {
    /// Around a polyhedron at a pose.
    pub fn of_polyhedron(polyhedron: Polyhedron, at: Pose) -> Self {
        let corners = polyhedron.corners().iter().map(|corner| at * *corner);
        corners
            .map(|corner| Self::around(corner, Vec3::ZERO))
            .reduce(Self::union)
            .unwrap_or(Self::around(at.location, Vec3::ZERO))
    }
}

#[cfg(test)]
mod tests {
    use std::f32::consts::PI;

    use super::*;

    /// Whether every edge belongs to two triangles, which go along it in opposite directions.
    fn is_closed(polyhedron: Polyhedron) -> bool {
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
            assert!(is_closed(polyhedron), "{polyhedron:?}");
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

    #[test]
    fn equal_polyhedra_are_the_same() {
        assert_eq!(
            Polyhedron::prism(0.5, 1.0, 6),
            Polyhedron::prism(0.5, 1.0, 6)
        );
        assert_ne!(
            Polyhedron::prism(0.5, 1.0, 6),
            Polyhedron::prism(0.5, 1.0, 7)
        );
        let tetrahedron = || {
            let corners = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
            Polyhedron::new(corners, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
        };
        assert_eq!(tetrahedron(), tetrahedron());
        assert!(tetrahedron().is_ok_and(|it| (it.volume() - 1.0 / 6.0).abs() < 1e-6));
    }

    #[test]
    fn numbers_that_are_no_polyhedron_are_refused() {
        let corners = || vec![Vec3::ZERO, Vec3::X, Vec3::Y];
        assert_eq!(
            Polyhedron::new(corners(), vec![]),
            Err(PolyhedronError::Empty)
        );
        assert_eq!(
            Polyhedron::new(corners(), vec![[0, 1, 3]]),
            Err(PolyhedronError::NoCorner)
        );
        assert_eq!(
            Polyhedron::new(vec![Vec3::NAN; 3], vec![[0, 1, 2]]),
            Err(PolyhedronError::NoPlace)
        );
    }

    #[test]
    fn a_ray_goes_through_the_hole_of_a_ring() {
        let ring = Polyhedron::ring(1.0, 0.5, 0.4, 32);
        let down = |x| ring.entry(Vec3::new(x, 0.05, 5.0), Vec3::NEG_Z);
        assert_eq!(down(0.0), None);
        assert!(down(0.8).is_some_and(|distance| (distance - 4.8).abs() < 1e-5));
        assert_eq!(down(1.1), None);
    }

    #[test]
    fn many_sides_look_round_and_few_flat() {
        let normals = |sides| {
            let surface = Polyhedron::prism(1.0, 1.0, sides).surface(Rgb::GRAY);
            let on_side = surface.normals.iter().filter(|normal| normal.y.abs() < 0.5);
            on_side.count()
        };
        assert_eq!(normals(6), 6 * 4);
        assert_eq!(normals(32), 32 * 2);
    }

    #[test]
    fn what_is_inside_a_convex_one() {
        let prism = Polyhedron::prism(1.0, 2.0, 6);
        assert!(prism.contains(Vec3::new(0.9, 0.9, 0.0)));
        assert!(!prism.contains(Vec3::new(0.9, 1.1, 0.0)));
        assert!(!prism.contains(Vec3::new(0.0, 0.0, 0.9)));
        assert_eq!(prism.distance_to(Vec3::new(0.9, 0.9, 0.0)), 0.0);
        assert!((prism.distance_to(Vec3::new(4.0, 5.0, 0.0)) - 5.0).abs() < 1e-5);
        assert!((prism.distance_to(Vec3::new(0.0, 3.0, 0.2)) - 2.0).abs() < 1e-5);
    }
}
