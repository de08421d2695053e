//! Surfaces of triangles, and their shading.

use std::collections::HashMap;

use bevy::math::Vec3;
use tabletop_geometry::{Rgb, Triangles, UNITS_PER_METER};

/// Cosine of the largest angle, 50°, at which neighbouring faces form one smooth surface.
const SMOOTH_COSINE: f32 = 0.643;

/// A surface of triangles that share their corners, which run counterclockwise as seen from outside.
/// Lengths in m.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Hull {
    /// The corners.
    pub points: Vec<Vec3>,
    /// The triangles, by indices of their corners.
    pub triangles: Vec<[u32; 3]>,
}

impl Hull {
    /// The surface from ring to ring, closed at both ends. All rings have equally many points, or one, which is a tip;
    /// those at the ends are flat and convex.
    pub fn through(rings: &[Vec<Vec3>]) -> Self {
        let mut hull = Self::around(rings);
        let [Some(first), Some(last)] = [rings.first(), rings.last()] else {
            return hull;
        };
        let top = (hull.points.len() - last.len()) as u32;
        hull.triangles
            .extend((2..first.len() as u32).map(|i| [0, i, i - 1]));
        hull.triangles
            .extend((2..last.len() as u32).map(|i| [top, top + i - 1, top + i]));
        hull
    }

    /// The same without its ends.
    pub fn around(rings: &[Vec<Vec3>]) -> Self {
        let points: Vec<_> = rings.concat();
        let mut triangles = Vec::new();
        let mut first = 0;
        for (lower, upper) in rings.iter().zip(rings.iter().skip(1)) {
            let (below, above) = (lower.len() as u32, upper.len() as u32);
            for i in 0..below.max(above) {
                let [a, b] = [i, i + 1].map(|i| first + i % below);
                let [c, d] = [i, i + 1].map(|i| first + below + i % above);
                if below > 1 {
                    triangles.push([a, b, d]);
                }
                if above > 1 {
                    triangles.push([a, d, c]);
                }
            }
            first += below;
        }
        Self { points, triangles }
    }

    /// The surface of these triangles, whose corners are shared where they are the same.
    pub fn welded(corners: impl IntoIterator<Item = [Vec3; 3]>) -> Self {
        let mut hull = Self::default();
        let mut known = HashMap::new();
        for corners in corners {
            let triangle = corners.map(|corner| {
                // Adding 0 makes -0 the same as 0.
                let key = (corner + 0.0).to_array().map(f32::to_bits);
                *known.entry(key).or_insert_with(|| {
                    hull.points.push(corner);
                    hull.points.len() as u32 - 1
                })
            });
            hull.triangles.push(triangle);
        }
        hull
    }

    /// The least and the largest coordinates.
    pub fn bounds(&self) -> [Vec3; 2] {
        let (mut least, mut most) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for &point in &self.points {
            least = least.min(point);
            most = most.max(point);
        }
        [least, most]
    }

    /// The volume inside, in m³; negative if it is inside out.
    pub fn volume(&self) -> f32 {
        let six_times = |&triangle: &[u32; 3]| {
            let [a, b, c] = self.corners(triangle);
            a.cross(b).dot(c)
        };
        self.triangles.iter().map(six_times).sum::<f32>() / 6.0
    }

    /// The same surface, turned outside out.
    pub fn oriented(mut self) -> Self {
        if self.volume() < 0.0 {
            self.triangles
                .iter_mut()
                .for_each(|triangle| triangle.swap(1, 2));
        }
        self
    }

    /// The same surface with its points mapped by a rigid motion or a reflection.
    pub fn mapped(mut self, map: impl Fn(Vec3) -> Vec3) -> Self {
        self.points
            .iter_mut()
            .for_each(|point| *point = map(*point));
        self
    }

    /// A similar surface of fewer triangles: points in the same cell of a grid are merged.
    pub fn simplified(&self, cell: f32) -> Self {
        let mut cells = HashMap::new();
        let mut sums: Vec<(Vec3, f32)> = Vec::new();
        let cell_of: Vec<u32> = self
            .points
            .iter()
            .map(|&point| {
                let key = (point / cell).round().to_array().map(|part| part as i32);
                let index = *cells.entry(key).or_insert_with(|| {
                    sums.push((Vec3::ZERO, 0.0));
                    sums.len() - 1
                });
                sums[index].0 += point;
                sums[index].1 += 1.0;
                index as u32
            })
            .collect();
        let mut triangles: Vec<_> = self
            .triangles
            .iter()
            .map(|triangle| triangle.map(|i| cell_of[i as usize]))
            .filter(|[a, b, c]| a != b && b != c && c != a)
            .map(|[a, b, c]| match a.min(b).min(c) {
                least if least == a => [a, b, c],
                least if least == b => [b, c, a],
                _ => [c, a, b],
            })
            .collect();
        triangles.sort_unstable();
        triangles.dedup();
        Self {
            points: sums.into_iter().map(|(sum, count)| sum / count).collect(),
            triangles,
        }
    }

    /// The surface in one colour, in units, with normals that are smooth where its faces meet at small angles.
    pub fn shaded(&self, color: Rgb) -> Triangles {
        let faces: Vec<([u32; 3], Vec3)> = self
            .triangles
            .iter()
            .filter_map(|&triangle| {
                let [a, b, c] = self.corners(triangle);
                let twice_area = (b - a).cross(c - a);
                (twice_area.length_squared() > 1e-20).then_some((triangle, twice_area))
            })
            .collect();
        let mut vertex_of = Joined::new(faces.len() * 3);
        for [one, other] in shared_edges(&faces) {
            let is_smooth = faces[one / 3]
                .1
                .normalize_or_zero()
                .dot(faces[other / 3].1.normalize_or_zero())
                > SMOOTH_COSINE;
            if is_smooth {
                vertex_of.join(one, next_corner(other));
                vertex_of.join(next_corner(one), other);
            }
        }
        let mut surface = Triangles::default();
        let mut vertices = vec![u32::MAX; faces.len() * 3];
        for (face, &(triangle, twice_area)) in faces.iter().enumerate() {
            let mut corners = [0; 3];
            for (side, corner) in corners.iter_mut().enumerate() {
                let vertex = &mut vertices[vertex_of.root(face * 3 + side)];
                if *vertex == u32::MAX {
                    *vertex = surface.positions.len() as u32;
                    let point = self.points[triangle[side] as usize];
                    surface.positions.push(point * UNITS_PER_METER as f32);
                    surface.normals.push(Vec3::ZERO);
                    surface.colors.push(color);
                }
                *corner = *vertex;
                surface.normals[*vertex as usize] += twice_area;
            }
            surface.indices.push(corners);
        }
        for normal in &mut surface.normals {
            *normal = normal.normalize_or(Vec3::Z);
        }
        surface
    }

    fn corners(&self, triangle: [u32; 3]) -> [Vec3; 3] {
        triangle.map(|i| self.points[i as usize])
    }
}

/// The corner after this one in its face.
const fn next_corner(corner: usize) -> usize {
    corner - corner % 3 + (corner + 1) % 3
}

/// The edges between two faces, each by the corners where it starts in either face.
fn shared_edges(faces: &[([u32; 3], Vec3)]) -> Vec<[usize; 2]> {
    let mut halves: Vec<([u32; 2], usize)> = faces
        .iter()
        .enumerate()
        .flat_map(|(face, (triangle, _))| {
            (0..3).map(move |side| {
                let (from, to) = (triangle[side], triangle[(side + 1) % 3]);
                ([from.min(to), from.max(to)], face * 3 + side)
            })
        })
        .collect();
    halves.sort_unstable();
    halves
        .chunk_by(|one, other| one.0 == other.0)
        .filter_map(|edge| match *edge {
            [(_, one), (_, other)] => {
                let start = |corner: usize| faces[corner / 3].0[corner % 3];
                (start(one) != start(other)).then_some([one, other])
            }
            _ => None,
        })
        .collect()
}

/// A partition of numbers into groups.
struct Joined(Vec<usize>);

impl Joined {
    fn new(count: usize) -> Self {
        Self((0..count).collect())
    }

    /// The least number of this one's group.
    fn root(&mut self, mut number: usize) -> usize {
        while self.0[number] != number {
            self.0[number] = self.0[self.0[number]];
            number = self.0[number];
        }
        number
    }

    fn join(&mut self, one: usize, other: usize) {
        let (one, other) = (self.root(one), self.root(other));
        self.0[one.max(other)] = one.min(other);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    impl Hull {
        /// True if each edge is passed once in each direction.
        pub fn is_closed(&self) -> bool {
            let edges = self.triangles.iter();
            let mut edges: Vec<_> = edges
                .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
                .collect();
            let mut turned: Vec<_> = edges.iter().map(|&[a, b]| [b, a]).collect();
            edges.sort_unstable();
            turned.sort_unstable();
            edges == turned && edges.windows(2).all(|pair| pair[0] != pair[1])
        }
    }

    fn cube() -> Hull {
        let ring = |z| {
            [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| Vec3::new(x, y, z))
        };
        Hull::through(&[ring(1.0).to_vec(), ring(-1.0).to_vec()]).oriented()
    }

    #[test]
    fn a_surface_through_rings_is_closed_and_can_be_turned_right() {
        let cube = cube();
        assert!(cube.is_closed());
        assert!((cube.volume() - 8.0).abs() < 1e-5);
        let mirrored = cube
            .clone()
            .mapped(|point| point * Vec3::new(1.0, -1.0, 1.0));
        assert!((mirrored.volume() + 8.0).abs() < 1e-5);
        assert!((mirrored.oriented().volume() - 8.0).abs() < 1e-5);
    }

    #[test]
    fn edges_stay_sharp_and_round_surfaces_smooth() {
        let cube = cube().shaded(Rgb::GRAY);
        assert_eq!(cube.positions.len(), 6 * 4);
        assert!(
            cube.normals
                .iter()
                .all(|normal| normal.abs().max_element() > 0.999)
        );
        let ring = |z: f32| {
            let turn = |i: i32| (i as f32 * 30.0_f32).to_radians();
            (0..12)
                .map(|i| Vec3::new(turn(i).cos(), turn(i).sin(), z))
                .collect()
        };
        let drum = Hull::through(&[ring(1.0), ring(-1.0)]);
        let drum = drum.oriented().shaded(Rgb::GRAY);
        assert_eq!(drum.positions.len(), 2 * 12 + 2 * 12);
    }

    #[test]
    fn equal_corners_are_welded_and_cells_merged() {
        let cube = cube();
        let soup = cube
            .triangles
            .iter()
            .map(|&triangle| cube.corners(triangle));
        let welded = Hull::welded(soup);
        assert_eq!(welded.points.len(), cube.points.len());
        assert!(welded.is_closed());
        // The corners are in cells of their own, unless these are large.
        assert_eq!(welded.simplified(0.5).triangles.len(), cube.triangles.len());
        assert_eq!(welded.simplified(10.0).triangles.len(), 0);
    }
}
