//! Polyhedra: the solids of frustums, rings and meshes.

mod nearest;
mod recipe;
mod regular;
mod surface;

pub use recipe::{MOST_SIDES, ROUND_SIDES};

use std::{
    collections::{BTreeMap, HashMap},
    fmt,
    sync::{Mutex, PoisonError},
};

use bevy::prelude::*;

use crate::{Bounds, Pose, polyhedron::recipe::Recipe};

/// A solid with flat faces, in its own frame. Each one is stored once for as long as the program runs: a copy is a reference, and equal
/// solids are the same one.
#[derive(Clone, Copy)]
pub struct Polyhedron(&'static PolyhedronData);

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

/// All polyhedra of the program.
#[derive(Default)]
struct PolyhedronStore {
    count: usize,
    /// The polyhedra by their recipes.
    made: BTreeMap<Recipe, Polyhedron>,
    read: HashMap<(Vec<[u32; 3]>, Vec<[u32; 3]>), Polyhedron>,
}

static KEPT: Mutex<Option<PolyhedronStore>> = Mutex::new(None);

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

    /// The polyhedron stretched along its axes from its frame's origin, by factors above 0.
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

    /// Its surface as triangles of corners, counterclockwise as seen from outside.
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

    /// Radius of the ball about its frame's origin that encloses it.
    pub fn radius(self) -> f32 {
        let distances = self.0.corners.iter().map(|corner| corner.length());
        distances.fold(0.0, f32::max)
    }

    /// Its volume in cubic units.
    pub fn volume(self) -> f32 {
        self.0.volume
    }

    /// The axis of its round surface, if it is meant to be round.
    pub fn axis(self) -> Option<Vec3> {
        self.0.axis
    }

    /// Its number among all polyhedra of the program. It differs from run to run.
    pub fn number(self) -> usize {
        self.0.number
    }
}

fn with_kept<T>(act: impl FnOnce(&mut PolyhedronStore) -> T) -> T {
    let mut kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    act(kept.get_or_insert_default())
}

impl PolyhedronStore {
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
        Polyhedron(Box::leak(Box::new(PolyhedronData {
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
    /// The bounds of a polyhedron at a pose.
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
