//! Polyhedra: the solids of frustums, rings and meshes.

mod nearest;
mod recipe;
mod regular;
mod store;
mod surface;

pub use recipe::{MOST_SIDES, ROUND_SIDES};

use std::{
    fmt,
    sync::{
        Arc, Mutex, PoisonError,
        atomic::{AtomicUsize, Ordering},
    },
};

use bevy::prelude::*;

use crate::{
    Bounds, Pose,
    polyhedron::{recipe::Recipe, store::SharedStore},
};

/// A solid with flat faces, in its own frame. A clone is a reference, and equal solids are the same one, in the whole program.
#[derive(Clone)]
pub struct Polyhedron(Arc<PolyhedronData>);

/// The data of a polyhedron.
struct PolyhedronData {
    /// Its number among all polyhedra.
    number: usize,
    corners: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    bounds: Bounds,
    volume: f32,
    axis: Option<Vec3>,
    crease: f32,
    /// The polyhedron that was scaled to become this one.
    #[expect(
        dead_code,
        reason = "held, so that scaling it again finds this one, which is known by its number"
    )]
    source: Option<Polyhedron>,
}

/// The error of data that is no polyhedron.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PolyhedronError {
    /// It has no triangles.
    #[error("it has no triangles")]
    Empty,
    /// A coordinate is not a number, or is beyond a million units.
    #[error("a corner is not a finite location")]
    NoPlace,
    /// A triangle names a corner that does not exist.
    #[error("a triangle names a corner that does not exist")]
    NoCorner,
}

/// The polyhedra of the program by their recipes.
static KEPT: Mutex<SharedStore<Recipe, PolyhedronData>> =
    Mutex::new(SharedStore::new(PolyhedronData::size));

/// Number of the next polyhedron.
static NEXT: AtomicUsize = AtomicUsize::new(0);

/// Cosines of the angles below which neighbouring faces form one surface: a flat one, or a round one of [`ROUND_SIDES`].
const FLAT: f32 = 0.999_96;
const ROUND: f32 = 0.939;

impl Polyhedron {
    /// A polyhedron of these corners and triangles, whose corners run counterclockwise as seen from outside. It is a solid if they enclose
    /// one.
    ///
    /// # Errors
    /// There is no triangle, a coordinate is out of range, or a triangle names a corner that does not exist.
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
            .map(|corner| corner.to_array().map(f32::to_bits));
        let recipe = Recipe::Read {
            corners: bits.collect(),
            triangles: triangles.clone(),
        };
        Ok(Self::kept(recipe, || {
            PolyhedronData::new(corners, triangles, None, FLAT)
        }))
    }

    /// The polyhedron stretched along its axes from its frame's origin, by factors above 0.
    #[must_use]
    pub fn scaled(&self, by: Vec3) -> Self {
        let recipe = Recipe::Scaled {
            of: self.0.number,
            by: by.to_array().map(f32::to_bits),
        };
        Self::kept(recipe, || {
            let corners = self.0.corners.iter().map(|corner| *corner * by).collect();
            let triangles = self.0.triangles.clone();
            PolyhedronData {
                source: Some(self.clone()),
                ..PolyhedronData::new(corners, triangles, self.0.axis, self.0.crease)
            }
        })
    }

    /// A round one, with this axis, if it has enough sides.
    fn rounded(
        recipe: Recipe,
        sides: u32,
        make: impl FnOnce() -> (Vec<Vec3>, Vec<[u32; 3]>, Vec3),
    ) -> Self {
        Self::kept(recipe, || {
            let (corners, triangles, axis) = make();
            let axis = (sides >= ROUND_SIDES).then_some(axis);
            PolyhedronData::new(corners, triangles, axis, ROUND)
        })
    }

    fn kept(recipe: Recipe, make: impl FnOnce() -> PolyhedronData) -> Self {
        let mut kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
        Self(kept.get_or_make(recipe, make))
    }

    /// Its corners.
    pub fn corners(&self) -> &[Vec3] {
        &self.0.corners
    }

    /// Its surface as triangles of corners, counterclockwise as seen from outside.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.0.triangles
    }

    /// The corners of each triangle.
    pub fn faces(&self) -> impl Iterator<Item = [Vec3; 3]> {
        let place = |corner: u32| self.0.corners[corner as usize];
        self.0
            .triangles
            .iter()
            .map(move |triangle| triangle.map(place))
    }

    /// The edges of its triangles, each once, as pairs of corners.
    pub fn edges(&self) -> Vec<[usize; 2]> {
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
    pub fn bounds(&self) -> Bounds {
        self.0.bounds
    }

    /// The corner that lies farthest in a direction.
    pub fn farthest(&self, direction: Vec3) -> Vec3 {
        let corners = self.0.corners.iter().copied();
        corners
            .max_by(|a, b| a.dot(direction).total_cmp(&b.dot(direction)))
            .unwrap_or_default()
    }

    /// Radius of the ball about its frame's origin that encloses it.
    pub fn radius(&self) -> f32 {
        let distances = self.0.corners.iter().map(|corner| corner.length());
        distances.fold(0.0, f32::max)
    }

    /// Its volume in cubic units.
    pub fn volume(&self) -> f32 {
        self.0.volume
    }

    /// The axis of its round surface, if it is meant to be round.
    pub fn axis(&self) -> Option<Vec3> {
        self.0.axis
    }

    /// Its number among all polyhedra of the program. It differs from run to run.
    pub fn number(&self) -> usize {
        self.0.number
    }
}

impl PolyhedronData {
    fn new(corners: Vec<Vec3>, triangles: Vec<[u32; 3]>, axis: Option<Vec3>, crease: f32) -> Self {
        let low = corners.iter().copied().reduce(Vec3::min);
        let high = corners.iter().copied().reduce(Vec3::max);
        let six_volumes = triangles.iter().map(|triangle| {
            let [a, b, c] = triangle.map(|corner| corners[corner as usize].as_dvec3());
            a.dot(b.cross(c))
        });
        Self {
            number: NEXT.fetch_add(1, Ordering::Relaxed),
            bounds: Bounds {
                low: low.unwrap_or_default(),
                high: high.unwrap_or_default(),
            },
            volume: (six_volumes.sum::<f64>() / 6.0) as f32,
            corners,
            triangles,
            axis,
            crease,
            source: None,
        }
    }

    /// Size in bytes.
    fn size(&self) -> usize {
        size_of::<Self>() + size_of_val(&*self.corners) + size_of_val(&*self.triangles)
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
    /// The bounds of a polyhedron at a pose.
    pub fn of_polyhedron(polyhedron: &Polyhedron, at: Pose) -> Self {
        let corners = polyhedron.corners().iter().map(|corner| at * *corner);
        corners
            .map(|corner| Self::around(corner, Vec3::ZERO))
            .reduce(Self::union)
            .unwrap_or(Self::around(at.location, Vec3::ZERO))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn polyhedra_that_nobody_holds_are_forgotten_and_all_others_stay_the_same() {
        const COUNT: u16 = 20_000;
        let size = |i: u16| 1.0 + f32::from(i) / 4096.0;
        let read = |i| {
            let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z].map(|corner| corner * size(i));
            let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
            Polyhedron::new(corners.to_vec(), faces).unwrap()
        };
        let made = |i| {
            [
                Polyhedron::prism(size(i), 1.0, 32),
                Polyhedron::ring(2.0 * size(i), size(i), 0.5, 64),
                read(i),
                // Nobody holds the polyhedron that is scaled.
                Polyhedron::wedge(3.0 * size(i), size(i), 0.5, 64).scaled(Vec3::splat(2.0)),
            ]
        };
        let held = made(0);
        for i in 1..COUNT {
            made(i);
        }
        assert_eq!(made(0), held);
        let kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner).len();
        assert!(kept < 10_000, "{kept}");
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
}
