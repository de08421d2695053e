//! Facets: surfaces of triangles, prepared for drawing.

use bevy::math::{Vec3, Vec4};
use tabletop_geometry::Triangles;

use crate::{camera::FourVectors, color::scaled_to_bytes};

/// A surface of triangles, prepared for drawing. Each triangle has the colour of its first corner.
#[derive(Clone, Debug, Default)]
pub struct Facets {
    pub(crate) vertices: Vec<FacetVertex>,
    /// The locations of the vertices, four by four; behind the last one there are zeros.
    pub(crate) places: Vec<FourVectors>,
    pub(crate) triangles: Vec<Facet>,
    /// The planes of the triangles, four by four; behind the last one there are planes that no eye sees.
    pub(crate) planes: Vec<FourPlanes>,
    /// The least and the largest coordinates.
    pub(crate) bounds: [Vec3; 2],
    /// Number of its patches.
    pub(crate) patches: u32,
}

/// A vertex in the frame of the figure. The fourth parts are 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FacetVertex {
    pub place: Vec4,
    pub normal: Vec4,
}

/// The planes of four triangles in the frame of the figure, each a lane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FourPlanes {
    /// Their unit normals.
    pub normals: FourVectors,
    /// Their distances from the origin, along the normals.
    pub heights: Vec4,
}

/// A triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Facet {
    pub corners: [u32; 3],
    /// Unit normal; the fourth part is 0.
    pub normal: Vec4,
    /// Red, green, blue in 0..=255.
    pub color: Vec3,
    /// The smooth part of the surface that it belongs to: triangles with a common vertex are in the same one.
    pub patch: u32,
}

impl Facets {
    /// Number of triangles.
    pub const fn len(&self) -> usize {
        self.triangles.len()
    }

    /// True if there is nothing to be drawn.
    pub const fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }
}

impl From<&Triangles> for Facets {
    /// Leaves out triangles that cannot be drawn: those without area, without corners, or too far away.
    fn from(surface: &Triangles) -> Self {
        let count = surface.positions.len().min(surface.normals.len());
        let positions = &surface.positions[..count];
        let vertices = positions.iter().zip(&surface.normals);
        let vertices = vertices.map(|(place, normal)| FacetVertex {
            place: place.extend(0.0),
            normal: normal.extend(0.0),
        });
        let mut patch_of = Patches::new(count);
        let mut bounds = [Vec3::INFINITY, Vec3::NEG_INFINITY];
        let mut triangles = Vec::with_capacity(surface.indices.len());
        let (mut normals, mut heights) = (Vec::new(), Vec::new());
        for &corners in &surface.indices {
            let Some(color) = surface.colors.get(corners[0] as usize) else {
                continue;
            };
            let [Some(a), Some(b), Some(c)] = corners.map(|i| positions.get(i as usize).copied())
            else {
                continue;
            };
            let Some(normal) = (b - a).cross(c - a).try_normalize() else {
                continue;
            };
            patch_of.join(corners);
            bounds = [
                bounds[0].min(a).min(b).min(c),
                bounds[1].max(a).max(b).max(c),
            ];
            normals.push(normal);
            heights.push(normal.dot(a));
            triangles.push(Facet {
                corners,
                normal: normal.extend(0.0),
                color: scaled_to_bytes(*color),
                patch: 0,
            });
        }
        let patches = patch_of.number(&mut triangles);
        let planes = normals.chunks(4).zip(heights.chunks(4));
        let planes = planes.map(|(normals, heights)| FourPlanes {
            normals: lanes(normals),
            heights: Vec4::from_array(std::array::from_fn(|lane| {
                heights.get(lane).map_or(f32::INFINITY, |height| *height)
            })),
        });
        Self {
            vertices: vertices.collect(),
            places: positions.chunks(4).map(lanes).collect(),
            planes: planes.collect(),
            triangles,
            bounds,
            patches,
        }
    }
}

/// Up to four vectors, each a lane; zeros in those that are left.
fn lanes(vectors: &[Vec3]) -> FourVectors {
    let vector = |lane: usize| vectors.get(lane).map_or(Vec4::ZERO, |it| it.extend(0.0));
    FourVectors::of_each([vector(0), vector(1), vector(2), vector(3)])
}

/// A partition of vertices into groups.
struct Patches(Vec<u32>);

impl Patches {
    fn new(vertices: usize) -> Self {
        Self((0..vertices as u32).collect())
    }

    /// The least vertex of this one's group.
    fn root(&mut self, mut vertex: u32) -> u32 {
        loop {
            let parent = self.0[vertex as usize];
            if parent == vertex {
                return vertex;
            }
            self.0[vertex as usize] = self.0[parent as usize];
            vertex = parent;
        }
    }

    fn join(&mut self, corners: [u32; 3]) {
        let roots = corners.map(|corner| self.root(corner));
        let least = roots[0].min(roots[1]).min(roots[2]);
        for root in roots {
            self.0[root as usize] = least;
        }
    }

    /// Gives each triangle the number of its patch, from 0, and returns how many there are.
    fn number(&mut self, triangles: &mut [Facet]) -> u32 {
        let mut numbers = vec![u32::MAX; self.0.len()];
        let mut count = 0;
        for triangle in triangles {
            let number = &mut numbers[self.root(triangle.corners[0]) as usize];
            if *number == u32::MAX {
                *number = count;
                count += 1;
            }
            triangle.patch = *number;
        }
        count
    }
}

#[cfg(test)]
mod tests {
    use tabletop_geometry::Rgb;

    use super::*;

    fn surface(positions: &[Vec3], indices: &[[u32; 3]]) -> Facets {
        Facets::from(&Triangles {
            positions: positions.to_vec(),
            normals: vec![Vec3::Z; positions.len()],
            colors: vec![Rgb::WHITE; positions.len()],
            indices: indices.to_vec(),
        })
    }

    #[test]
    fn triangles_with_common_vertices_are_a_patch() {
        let square = [Vec3::ZERO, Vec3::X, Vec3::X + Vec3::Y, Vec3::Y];
        let twice = [square, square.map(|point| point + Vec3::Z)].concat();
        let facets = surface(&twice, &[[4, 5, 6], [0, 1, 2], [6, 7, 4], [2, 3, 0]]);
        let patches: Vec<_> = facets.triangles.iter().map(|facet| facet.patch).collect();
        assert_eq!(patches, [0, 1, 0, 1]);
        assert_eq!(facets.patches, 2);
        assert_eq!(facets.bounds, [Vec3::ZERO, Vec3::ONE]);
    }

    #[test]
    fn invalid_triangles_are_left_out() {
        let points = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::NAN, Vec3::splat(1e38)];
        let facets = surface(
            &points,
            &[[0, 0, 1], [0, 1, 9], [0, 1, 3], [0, 4, 3], [0, 1, 2]],
        );
        assert_eq!(facets.triangles.len(), 1);
        assert_eq!(facets.triangles[0].normal, Vec4::Z);
        assert_eq!(surface(&[], &[]).triangles.len(), 0);
    }
}
