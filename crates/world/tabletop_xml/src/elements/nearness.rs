//! Solids that are near each other at the start of a scene, which the physics keeps in mind as pairs.

use std::collections::BTreeMap;

use tabletop_geometry::{Bounds, PAIR_GAP};

/// Edge of a cell of the grid, in units.
const CELL: f32 = 4.0;
/// Largest number of cells of a solid in the grid; larger solids are in no cell.
const MAX_CELLS: i32 = 27;

/// The solids of a scene, and the number of pairs of different bodies that are near each other and do not both stay in place.
#[derive(Debug, Default)]
pub(crate) struct Nearness {
    pairs: usize,
    solids: Vec<BodySolid>,
    /// The small solids by cell.
    cells: BTreeMap<[i32; 3], Vec<usize>>,
    large: Vec<usize>,
}

/// A body: the bounds of its solids.
#[derive(Clone, Debug)]
pub(crate) struct BodyBounds {
    pub solids: Vec<Bounds>,
    /// True if nothing can move it.
    pub is_fixed: bool,
}

#[derive(Clone, Copy, Debug)]
struct BodySolid {
    bounds: Bounds,
    body: usize,
    is_fixed: bool,
}

impl BodySolid {
    /// True if the physics keeps the two in mind as a pair.
    fn is_paired_with(self, other: Self) -> bool {
        let is_apart = self.body != other.body && !(self.is_fixed && other.is_fixed);
        is_apart && self.bounds.is_near(other.bounds)
    }
}

/// The cells that a solid is in.
#[derive(Clone, Copy, Debug)]
struct Cells {
    low: [i32; 3],
    high: [i32; 3],
}

impl Nearness {
    /// Adds bodies; false, and nothing is added, if there would be more than `most` pairs.
    pub fn add(&mut self, bodies: &[BodyBounds], most: usize) -> bool {
        let (solids_before, pairs_before) = (self.solids.len(), self.pairs);
        let first_body = self.solids.last().map_or(0, |solid| solid.body + 1);
        for (index, body) in bodies.iter().enumerate() {
            for &bounds in &body.solids {
                let solid = BodySolid {
                    bounds,
                    body: first_body + index,
                    is_fixed: body.is_fixed,
                };
                self.pairs += self.count(solid, most - self.pairs);
                if self.pairs > most {
                    self.remove_from(solids_before);
                    self.pairs = pairs_before;
                    return false;
                }
                self.insert(solid);
            }
        }
        true
    }

    /// Number of solids with which this one is paired, at most one more than `most`.
    fn count(&self, solid: BodySolid, most: usize) -> usize {
        let is_paired = |&&other: &&usize| solid.is_paired_with(self.solids[other]);
        match Cells::around(solid.bounds) {
            None => self.count_all(solid, most),
            Some(cells) => {
                let near = cells.iter().flat_map(|cell| {
                    let others = self.cells.get(&cell).into_iter().flatten();
                    // A pair that shares several cells counts in the first of them.
                    others.filter(move |&&other| {
                        Cells::around(self.solids[other].bounds)
                            .is_some_and(|others| cells.first_shared(others) == cell)
                    })
                });
                let with_large = near.chain(&self.large);
                with_large.filter(is_paired).take(most + 1).count()
            }
        }
    }

    fn count_all(&self, solid: BodySolid, most: usize) -> usize {
        let all = self.solids.iter();
        let paired = all.filter(|other| solid.is_paired_with(**other));
        paired.take(most + 1).count()
    }

    fn insert(&mut self, solid: BodySolid) {
        let index = self.solids.len();
        self.solids.push(solid);
        match Cells::around(solid.bounds) {
            Some(cells) => {
                for cell in cells.iter() {
                    self.cells.entry(cell).or_default().push(index);
                }
            }
            None => self.large.push(index),
        }
    }

    /// Removes the solids from this one on.
    fn remove_from(&mut self, first: usize) {
        for solid in self.solids.split_off(first) {
            match Cells::around(solid.bounds) {
                Some(cells) => {
                    for cell in cells.iter() {
                        if let Some(indices) = self.cells.get_mut(&cell) {
                            indices.retain(|&index| index < first);
                        }
                    }
                }
                None => self.large.retain(|&index| index < first),
            }
        }
    }
}

impl Cells {
    /// The cells of a solid and those near it; `None` if it is large.
    fn around(bounds: Bounds) -> Option<Self> {
        let cell = |at: bevy::math::Vec3| at.to_array().map(|at| (at / CELL).floor() as i32);
        let (low, high) = (cell(bounds.low - PAIR_GAP), cell(bounds.high + PAIR_GAP));
        let extent = |axis: usize| high[axis].saturating_sub(low[axis]).saturating_add(1);
        let extents = [0, 1, 2].map(extent);
        let is_small = extents.into_iter().fold(1, i32::saturating_mul) <= MAX_CELLS;
        is_small.then_some(Self { low, high })
    }

    fn iter(self) -> impl Iterator<Item = [i32; 3]> {
        let along = move |axis: usize| self.low[axis]..=self.high[axis];
        along(0).flat_map(move |x| along(1).flat_map(move |y| along(2).map(move |z| [x, y, z])))
    }

    /// The first cell that both are in, if there is one.
    fn first_shared(self, other: Self) -> [i32; 3] {
        [0, 1, 2].map(|axis| self.low[axis].max(other.low[axis]))
    }
}

#[cfg(test)]
mod tests {
    use bevy::math::Vec3;
    use proptest::prelude::*;

    use super::*;

    fn bounds() -> impl Strategy<Value = Bounds> {
        let at = prop::array::uniform3(-10.0..10.0_f32).prop_map(Vec3::from);
        let reach = prop_oneof![0.1..2.0_f32, 5.0..30.0_f32];
        (at, reach).prop_map(|(at, reach)| Bounds::around(at, Vec3::splat(reach)))
    }

    fn body() -> impl Strategy<Value = BodyBounds> {
        let solids = prop::collection::vec(bounds(), 0..5);
        (solids, any::<bool>()).prop_map(|(solids, is_fixed)| BodyBounds { solids, is_fixed })
    }

    /// Number of pairs, counted one by one.
    fn pairs(bodies: &[BodyBounds]) -> usize {
        let mut pairs = 0;
        for (index, body) in bodies.iter().enumerate() {
            let before = bodies[..index].iter();
            let before = before.filter(|other| !(other.is_fixed && body.is_fixed));
            for other in before.flat_map(|other| &other.solids) {
                let near = body.solids.iter().filter(|solid| solid.is_near(*other));
                pairs += near.count();
            }
        }
        pairs
    }

    proptest! {
        #[test]
        fn pairs_are_counted_once(
            bodies in prop::collection::vec(body(), 0..12),
            most in 0..60_usize,
        ) {
            let mut nearness = Nearness::default();
            prop_assert!(nearness.add(&bodies, usize::MAX / 2));
            prop_assert_eq!(nearness.pairs, pairs(&bodies));

            let mut nearness = Nearness::default();
            let mut kept = Vec::new();
            for body in &bodies {
                kept.push(body.clone());
                let is_kept = nearness.add(std::slice::from_ref(body), most);
                prop_assert_eq!(is_kept, pairs(&kept) <= most);
                if !is_kept {
                    kept.pop();
                }
                prop_assert_eq!(nearness.pairs, pairs(&kept));
            }
        }
    }
}
