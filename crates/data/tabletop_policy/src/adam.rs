//! Adam (Kingma and Ba, Adam: A method for stochastic optimization, 2015), whose steps are shortened where gradients are much larger than they were
//! (Shazeer and Stern, Adafactor: Adaptive learning rates with sublinear memory cost, 2018): one such batch can leave a network that learns no more.

/// Part of the moments that a step keeps.
const KEPT: [f32; 2] = [0.9, 0.999];
/// Keeps steps finite where gradients vanish.
const LEAST: f32 = 1e-8;

/// The greatest root of the mean square of a step, in lengths.
const MOST: f32 = 1.0;

/// The means of gradients and of their squares, by parameter.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Adam {
    pub means: Vec<f32>,
    pub squares: Vec<f32>,
}

impl Adam {
    pub fn new(parameters: usize) -> Self {
        Self {
            means: vec![0.0; parameters],
            squares: vec![0.0; parameters],
        }
    }

    /// Step `number`, from 1, of this length.
    pub fn step(&mut self, parameters: &mut [f32], gradient: &[f32], number: usize, length: f32) {
        let [mean_part, square_part] =
            KEPT.map(|kept| 1.0 - libm::pow(f64::from(kept), number as f64) as f32);
        let moments = self.means.iter_mut().zip(&mut self.squares);
        let steps = gradient.iter().zip(moments).map(|(gradient, moments)| {
            let (mean, square) = moments;
            *mean += (1.0 - KEPT[0]) * (gradient - *mean);
            *square += (1.0 - KEPT[1]) * (gradient * gradient - *square);
            let size = (*square / square_part).sqrt() + LEAST;
            *mean / mean_part / size
        });
        let steps: Vec<_> = steps.collect();
        let squares: f32 = steps.iter().map(|step| step * step).sum();
        let most = (squares / steps.len().max(1) as f32).sqrt();
        let length = length / (most / MOST).max(1.0);
        for (parameter, step) in parameters.iter_mut().zip(steps) {
            *parameter -= length * step;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_finds_the_bottom_of_a_bowl() {
        let (mut parameters, mut adam) = (vec![3.0, -2.0], Adam::new(2));
        for number in 1..=2000 {
            let gradient = [2.0 * (parameters[0] - 1.0), 20.0 * parameters[1]];
            adam.step(&mut parameters, &gradient, number, 0.01);
        }
        assert!((parameters[0] - 1.0).abs() < 1e-3, "{parameters:?}");
        assert!(parameters[1].abs() < 1e-3, "{parameters:?}");
    }

    #[test]
    fn a_gradient_that_is_suddenly_large_makes_no_longer_step() {
        let (mut parameters, mut adam) = (vec![0.0; 3], Adam::new(3));
        for number in 1..=500 {
            let sign = if number % 2 == 0 { 1.0 } else { -1.0 };
            adam.step(&mut parameters, &[sign; 3], number, 0.01);
        }
        let before = parameters.clone();
        adam.step(&mut parameters, &[1e6; 3], 501, 0.01);
        let step = (parameters[0] - before[0]).abs();
        assert!((0.0099..0.0101).contains(&step), "{step}");
    }
}
