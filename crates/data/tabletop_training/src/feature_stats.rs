//! Statistics of a feature of a dataset.

/// The quantiles, by their names.
pub const QUANTILES: [(&str, f64); 5] = [
    ("q01", 0.01),
    ("q10", 0.10),
    ("q50", 0.50),
    ("q90", 0.90),
    ("q99", 0.99),
];

/// Statistics of a feature, by its components.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FeatureStats {
    /// The least number of each component.
    pub min: Vec<f64>,
    /// The greatest.
    pub max: Vec<f64>,
    /// The mean.
    pub mean: Vec<f64>,
    /// The standard deviation.
    pub std: Vec<f64>,
    /// Number of samples: of frames, or of pictures looked at.
    pub count: u64,
    /// In the order of [`QUANTILES`].
    pub quantiles: [Vec<f64>; 5],
    /// True for the three colours of pictures, from 0 to 1, of shape (3, 1, 1).
    pub is_of_pictures: bool,
}

impl FeatureStats {
    /// Number of its components, if every list has as many.
    pub fn components(&self) -> Option<u64> {
        let count = self.min.len();
        let lists = [&self.max, &self.mean, &self.std].into_iter();
        let mut lists = lists.chain(&self.quantiles);
        lists
            .all(|list| list.len() == count)
            .then_some(count as u64)
    }

    /// Number of lists around each number besides the outermost.
    pub const fn inner_lists(&self) -> usize {
        if self.is_of_pictures { 2 } else { 0 }
    }

    /// Statistics of components, each with all its samples.
    pub fn of(mut components: Vec<Vec<f64>>) -> Self {
        let mut all = Self {
            count: components.first().map_or(0, Vec::len) as u64,
            ..Self::default()
        };
        for samples in &mut components {
            let count = samples.len().max(1) as f64;
            let mean = samples.iter().sum::<f64>() / count;
            let squares = samples.iter().map(|sample| (sample - mean).powi(2));
            all.mean.push(mean);
            all.std.push((squares.sum::<f64>() / count).sqrt());
            samples.sort_by(f64::total_cmp);
            all.min.push(samples.first().copied().unwrap_or(0.0));
            all.max.push(samples.last().copied().unwrap_or(0.0));
            for (quantiles, (_, part)) in all.quantiles.iter_mut().zip(QUANTILES) {
                quantiles.push(quantile(samples, part));
            }
        }
        all
    }

    /// The statistics of these samples and others. Quantiles become bounds: the lower ones the lowest, the upper ones the highest.
    pub fn merge(&mut self, other: &Self) {
        let (ours, theirs) = (self.count as f64, other.count as f64);
        let all = (ours + theirs).max(1.0);
        for i in 0..self.mean.len().min(other.mean.len()) {
            let mean = (self.mean[i] * ours + other.mean[i] * theirs) / all;
            let spread = |mean_of: f64, std: f64| std.powi(2) + (mean_of - mean).powi(2);
            let variance = (spread(self.mean[i], self.std[i]) * ours
                + spread(other.mean[i], other.std[i]) * theirs)
                / all;
            self.min[i] = self.min[i].min(other.min[i]);
            self.max[i] = self.max[i].max(other.max[i]);
            for (place, (_, part)) in QUANTILES.iter().enumerate() {
                let (one, two) = (self.quantiles[place][i], other.quantiles[place][i]);
                self.quantiles[place][i] = match part.total_cmp(&0.5) {
                    std::cmp::Ordering::Less => one.min(two),
                    std::cmp::Ordering::Greater => one.max(two),
                    std::cmp::Ordering::Equal => (one * ours + two * theirs) / all,
                };
            }
            self.mean[i] = mean;
            self.std[i] = variance.sqrt();
        }
        self.count = self.count.saturating_add(other.count);
    }

    /// Adds a component of which it is known how often each of 256 values occurs, from 0 to 1.
    pub fn add_histogram(&mut self, histogram: &[u64; 256]) {
        let scaled = |value: usize| value as f64 / 255.0;
        let count = histogram.iter().sum::<u64>().max(1) as f64;
        let weighted = |of: &dyn Fn(f64) -> f64| {
            let values = histogram.iter().enumerate();
            let sum: f64 = values
                .map(|(value, times)| of(scaled(value)) * *times as f64)
                .sum();
            sum / count
        };
        let mean = weighted(&|value| value);
        let occurring = || (0..256).filter(|value| histogram[*value] > 0);
        self.mean.push(mean);
        self.std
            .push(weighted(&|value| (value - mean).powi(2)).sqrt());
        self.min.push(scaled(occurring().next().unwrap_or(0)));
        self.max.push(scaled(occurring().next_back().unwrap_or(0)));
        for (quantiles, (_, part)) in self.quantiles.iter_mut().zip(QUANTILES) {
            let mut left = part * count;
            let value = (0..256).find(|value| {
                left -= histogram[*value] as f64;
                left <= 0.0
            });
            quantiles.push(scaled(value.unwrap_or(255)));
        }
    }
}

/// The quantile of sorted samples, between the two nearest.
fn quantile(sorted: &[f64], part: f64) -> f64 {
    let place = part * sorted.len().saturating_sub(1) as f64;
    let [below, above] = [place.floor(), place.ceil()].map(|place| {
        let sample = sorted.get(place as usize);
        sample.copied().unwrap_or(0.0)
    });
    below + (above - below) * place.fract()
}
