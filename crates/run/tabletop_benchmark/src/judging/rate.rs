//! Rates of success.

/// How far from the mean, in standard deviations, a normal distribution is in 95 of 100 cases at most.
const DEVIATIONS: f64 = 1.959_963_984_540_054;

/// How often something was done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SuccessRate {
    /// Number of times that it was done.
    pub done: u64,
    /// Number of times that it was tried.
    pub tried: u64,
}

impl SuccessRate {
    /// That of these outcomes.
    pub fn of(outcomes: impl IntoIterator<Item = bool>) -> Self {
        outcomes
            .into_iter()
            .fold(Self::default(), |rate, done| Self {
                done: rate.done + u64::from(done),
                tried: rate.tried + 1,
            })
    }

    /// The share that was done, from 0 to 1.
    pub fn share(self) -> f64 {
        self.done as f64 / self.tried.max(1) as f64
    }

    /// The interval in which the true rate is with 95 % confidence (Wilson: Probable inference, the law of succession, and statistical inference, 1927).
    pub fn interval(self) -> [f64; 2] {
        if self.tried == 0 {
            return [0.0, 1.0];
        }
        let (share, tried) = (self.share(), self.tried as f64);
        let square = DEVIATIONS * DEVIATIONS / tried;
        let middle = (share + square / 2.0) / (1.0 + square);
        let spread = share * (1.0 - share) / tried + square / (4.0 * tried);
        let half = DEVIATIONS * spread.sqrt() / (1.0 + square);
        // Where all or none were done, the ends are exact.
        let low = if self.done == 0 { 0.0 } else { middle - half };
        let high = if self.done == self.tried {
            1.0
        } else {
            middle + half
        };
        [low, high]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers of `statsmodels.stats.proportion.proportion_confint(done, tried, method="wilson")`.
    #[test]
    fn intervals_are_wilsons() {
        for (done, tried, low, high) in [
            (10, 10, 0.722_467_2, 1.0),
            (0, 10, 0.0, 0.277_532_8),
            (8, 10, 0.490_162_5, 0.943_317_8),
            (45, 50, 0.786_397_3, 0.956_523_8),
        ] {
            let [least, most] = SuccessRate { done, tried }.interval();
            assert!((least - low).abs() < 1e-6, "{done} of {tried}: {least}");
            assert!((most - high).abs() < 1e-6, "{done} of {tried}: {most}");
        }
        assert_eq!(SuccessRate::default().interval(), [0.0, 1.0]);
        let rate = SuccessRate::of([true, false, true]);
        assert_eq!((rate.done, rate.tried), (2, 3));
    }
}
