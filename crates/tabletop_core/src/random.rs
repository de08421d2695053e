//! Random numbers that are the same everywhere and for ever.

/// SplitMix64: a counter, scrambled (Steele, Lea, Flood: Fast splittable pseudorandom number generators, 2014).
#[derive(Clone, Debug)]
pub(crate) struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn bits(&mut self) -> u64 {
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
}
