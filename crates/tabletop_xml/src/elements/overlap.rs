//! Solids that overlap at the start of a scene.

use std::collections::BTreeMap;

use tabletop_core::Bounds;

/// Largest depth of solids inside each other that is not an overlap: a standing object may enter its support by a rounding error.
const TOUCHING: f32 = 0.01;
/// Edge of a cell of the grid over the table, in units.
const CELL: f32 = 4.0;
/// Largest number of cells of a solid in the grid; larger solids are in no cell.
const MAX_CELLS: i32 = 9;

/// The solids of a scene, and the number of overlapping pairs of different bodies, judged by their bounds.
#[derive(Debug, Default)]
pub(crate) struct Overlaps {
    pairs: usize,
    solids: Vec<BodySolid>,
    /// The small solids by cell.
    cells: BTreeMap<[i32; 2], Vec<usize>>,
    large: Vec<usize>,
}

#[derive(Clone, Copy, Debug)]
struct BodySolid {
    bounds: Bounds,
    body: usize,
}

/// The cells that a solid is in.
#[derive(Clone, Copy, Debug)]
struct Cells {
    low: [i32; 2],
    high: [i32; 2],
}

impl Overlaps {
    /// Adds bodies; false, and nothing is added, if more than `most` pairs would overlap.
    pub fn add(&mut self, bodies: &[Vec<Bounds>], most: usize) -> bool {
        let (solids_before, pairs_before) = (self.solids.len(), self.pairs);
        let first_body = self.solids.last().map_or(0, |solid| solid.body + 1);
        for (index, body) in bodies.iter().enumerate() {
            for &bounds in body {
                let body = first_body + index;
                self.pairs += self.count(BodySolid { bounds, body }, most - self.pairs);
                if self.pairs > most {
                    self.remove_from(solids_before);
                    self.pairs = pairs_before;
                    return false;
                }
                self.insert(BodySolid { bounds, body });
            }
        }
        true
    }

    /// Number of solids of other bodies that overlap with this one, at most one more than `most`.
    fn count(&self, solid: BodySolid, most: usize) -> usize {
        let is_overlapping = |&&other: &&usize| {
            let other = self.solids[other];
            other.body != solid.body && other.bounds.overlaps(solid.bounds, TOUCHING)
        };
        match Cells::of(solid.bounds) {
            None => self.all_overlapping(solid, most),
            Some(cells) => {
                let near = cells.iter().flat_map(|cell| {
                    let others = self.cells.get(&cell).into_iter().flatten();
                    // A pair that shares several cells counts in the first of them.
                    others.filter(move |&&other| {
                        Cells::of(self.solids[other].bounds)
                            .is_some_and(|others| cells.first_shared(others) == cell)
                    })
                });
                let with_large = near.chain(&self.large);
                with_large.filter(is_overlapping).take(most + 1).count()
            }
        }
    }

    fn all_overlapping(&self, solid: BodySolid, most: usize) -> usize {
        let is_overlapping = |other: &&BodySolid| {
            other.body != solid.body && other.bounds.overlaps(solid.bounds, TOUCHING)
        };
        self.solids
            .iter()
            .filter(is_overlapping)
            .take(most + 1)
            .count()
    }

    fn insert(&mut self, solid: BodySolid) {
        let index = self.solids.len();
        self.solids.push(solid);
        match Cells::of(solid.bounds) {
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
            match Cells::of(solid.bounds) {
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
    /// The cells of a solid; `None` if it is large.
    fn of(bounds: Bounds) -> Option<Self> {
        let cell = |at: bevy::math::Vec3| [at.x, at.y].map(|at| (at / CELL).floor() as i32);
        let (low, high) = (cell(bounds.low), cell(bounds.high));
        let extent = |axis: usize| high[axis].saturating_sub(low[axis]).saturating_add(1);
        let is_small = extent(0).saturating_mul(extent(1)) <= MAX_CELLS;
        is_small.then_some(Self { low, high })
    }

    fn iter(self) -> impl Iterator<Item = [i32; 2]> {
        let [low_x, low_y] = self.low;
        let [high_x, high_y] = self.high;
        (low_x..=high_x).flat_map(move |x| (low_y..=high_y).map(move |y| [x, y]))
    }

    /// The first cell that both are in, if there is one.
    fn first_shared(self, other: Self) -> [i32; 2] {
        [0, 1].map(|axis| self.low[axis].max(other.low[axis]))
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

    /// Number of overlapping pairs of different bodies, counted one by one.
    fn pairs(bodies: &[Vec<Bounds>]) -> usize {
        let mut pairs = 0;
        for (index, body) in bodies.iter().enumerate() {
            for solid in body {
                let before = bodies[..index].iter().flatten();
                pairs += before
                    .filter(|other| solid.overlaps(**other, TOUCHING))
                    .count();
            }
        }
        pairs
    }

    proptest! {
        #[test]
        fn pairs_are_counted_once(
            bodies in prop::collection::vec(prop::collection::vec(bounds(), 0..5), 0..12),
            most in 0..60_usize,
        ) {
            let mut overlaps = Overlaps::default();
            prop_assert!(overlaps.add(&bodies, usize::MAX / 2));
            prop_assert_eq!(overlaps.pairs, pairs(&bodies));

            let mut overlaps = Overlaps::default();
            let mut kept = Vec::new();
            for body in &bodies {
                kept.push(body.clone());
                let is_kept = overlaps.add(std::slice::from_ref(body), most);
                prop_assert_eq!(is_kept, pairs(&kept) <= most);
                if !is_kept {
                    kept.pop();
                }
                prop_assert_eq!(overlaps.pairs, pairs(&kept));
            }
        }
    }
}
