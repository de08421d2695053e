//! Facets: surfaces of triangles, prepared for drawing.

use bevy::math::{Vec3, Vec4};
use tabletop_geometry::Triangles;

use crate::color::scaled_to_bytes;

/// A surface of triangles, prepared for drawing. Each triangle has the colour of its first corner.
#[derive(Clone, Debug, Default)]
pub struct Facets {
    /// The vertices, four by four; behind the last one there are zeros.
    pub(crate) vertices: Vec<FourVertices>,
    pub(crate) triangles: Vec<Facet>,
    /// The least and the largest coordinates.
    pub(crate) bounds: [Vec3; 2],
    /// Number of its patches.
    pub(crate) patches: u32,
}

/// Four vertices in the frame of the figure, each a lane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FourVertices {
    /// Their locations along X, Y and Z.
    pub positions: [Vec4; 3],
    /// Their normals along X, Y and Z.
    pub normals: [Vec4; 3],
}

/// A triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Facet {
    pub corners: [u32; 3],
    /// Unit normal.
    pub normal: Vec3,
    /// Distance of its plane from the origin, along the normal.
    pub height: f32,
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
        let fours = positions.chunks(4).zip(surface.normals.chunks(4));
        let vertices = fours.map(|(positions, normals)| FourVertices {
            positions: lanes(positions),
            normals: lanes(normals),
        });
        let mut patch_of = Patches::new(count);
        let mut bounds = [Vec3::INFINITY, Vec3::NEG_INFINITY];
        let mut triangles = Vec::with_capacity(surface.indices.len());
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
            triangles.push(Facet {
                corners,
                normal,
                height: normal.dot(a),
                color: scaled_to_bytes(*color),
                patch: 0,
            });
        }
        let patches = patch_of.number(&mut triangles);
        Self {
            vertices: vertices.collect(),
            triangles,
            bounds,
            patches,
        }
    }
}

/// Up to four vectors by their parts along X, Y and Z, each a lane.
fn lanes(vectors: &[Vec3]) -> [Vec4; 3] {
    std::array::from_fn(|axis| {
        let part = |lane: usize| vectors.get(lane).map_or(0.0, |vector| vector[axis]);
        Vec4::new(part(0), part(1), part(2), part(3))
    })
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
        assert_eq!(facets.triangles[0].normal, Vec3::Z);
        assert_eq!(surface(&[], &[]).triangles.len(), 0);
    }
}
