//! Random numbers that are the same on every machine, in every version.

/// SplitMix64: a counter, scrambled (Steele, Lea, Flood: Fast splittable pseudorandom number generators, 2014).
///
/// ```
/// use tabletop_core::Random;
///
/// let draw = |seed| Random::new(seed).between((0.0, 1.0));
/// assert_eq!(draw(7), draw(7));
/// assert_ne!(draw(7), draw(8));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Random(u64);

impl Random {
    /// The generator with this seed.
    pub const fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^ (bits >> 31)
    }

    /// A number between these two.
    pub fn between(&mut self, (low, high): (f32, f32)) -> f32 {
        let fraction = (self.bits() >> 40) as f32 / (1 << 24) as f32;
        low + (high - low) * fraction
    }

    /// One of these.
    pub fn one_of<T: Copy, const N: usize>(&mut self, choices: [T; N]) -> T {
        const { assert!(N > 0) };
        choices[(self.bits() % N as u64) as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_numbers_are_those_of_the_published_generator() {
        let mut random = Random::new(1_234_567);
        assert_eq!(
            [random.bits(), random.bits(), random.bits()],
            [
                6_457_827_717_110_365_317,
                3_203_168_211_198_807_973,
                9_817_491_932_198_370_423
            ]
        );
    }

    #[test]
    fn numbers_lie_in_their_range_and_fill_it() {
        let mut random = Random::new(0);
        let numbers: Vec<f32> = (0..1000).map(|_| random.between((-2.0, 3.0))).collect();
        assert!(numbers.iter().all(|number| (-2.0..=3.0).contains(number)));
        assert!(numbers.iter().any(|&number| number < -1.9));
        assert!(numbers.iter().any(|&number| number > 2.9));
    }

    #[test]
    fn every_choice_is_made() {
        let mut random = Random::new(0);
        let made: Vec<_> = (0..100).map(|_| random.one_of(['a', 'b', 'c'])).collect();
        assert!(['a', 'b', 'c'].iter().all(|choice| made.contains(choice)));
    }
}
