//! Depths of bodies in stacks.

/// The number of bodies from each body down to its final support, itself included.
#[derive(Debug, Default)]
pub(crate) struct Depths(Vec<u32>);

const UNSUPPORTED: u32 = u32::MAX;

impl Depths {
    /// Depths of bodies, by their numbers. `supported` touch something that does not move by itself; `touching` pairs touch each other.
    pub fn new(supported: &[u32], touching: &[(u32, u32)]) -> Self {
        let pairs = touching.iter().flat_map(|&(a, b)| [a, b]);
        let count = pairs.chain(supported.iter().copied()).max();
        let mut depths = Self(vec![UNSUPPORTED; count.map_or(0, |last| last as usize + 1)]);
        for &body in supported {
            depths.0[body as usize] = 1;
        }
        while touching.iter().fold(false, |changed, &(a, b)| {
            depths.lower(a, b) | depths.lower(b, a) | changed
        }) {}
        depths
    }

    /// The depth of a body, if it has a support.
    pub fn of(&self, body: u32) -> Option<u32> {
        let depth = self.0.get(body as usize).copied();
        depth.filter(|depth| *depth != UNSUPPORTED)
    }

    /// True if a body is less deep than known before, because it touches this other one.
    fn lower(&mut self, body: u32, other: u32) -> bool {
        let by_other = self.0[other as usize].saturating_add(1);
        let depth = &mut self.0[body as usize];
        let is_lower = by_other < *depth;
        *depth = by_other.min(*depth);
        is_lower
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn a_tower_counts_from_the_ground() {
        let depths = Depths::new(&[3], &[(0, 1), (3, 2), (1, 2)]);
        assert_eq!(
            [3, 2, 1, 0].map(|body| depths.of(body)),
            [1, 2, 3, 4].map(Some)
        );
    }

    #[test]
    fn unsupported_bodies_have_no_depth() {
        let depths = Depths::new(&[0], &[(2, 3)]);
        assert_eq!([1, 2, 3, 7].map(|body| depths.of(body)), [None; 4]);
    }

    proptest! {
        #[test]
        fn neighbours_differ_by_one_at_most(
            supported in proptest::collection::vec(0u32..12, 0..4),
            touching in proptest::collection::vec((0u32..12, 0u32..12), 0..30),
        ) {
            let depths = Depths::new(&supported, &touching);
            for body in &supported {
                prop_assert_eq!(depths.of(*body), Some(1));
            }
            for (a, b) in touching {
                match (depths.of(a), depths.of(b)) {
                    (Some(a), Some(b)) => prop_assert!(a.abs_diff(b) <= 1),
                    (a, b) => prop_assert_eq!(a, b),
                }
            }
        }
    }
}
