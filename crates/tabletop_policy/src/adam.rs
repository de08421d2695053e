//! Adam (Kingma and Ba, Adam: A method for stochastic optimization, 2015).

/// Part of the moments that a step keeps.
const KEPT: [f32; 2] = [0.9, 0.999];
/// Keeps steps finite where gradients vanish.
const LEAST: f32 = 1e-8;

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
        for ((parameter, gradient), (mean, square)) in
            parameters.iter_mut().zip(gradient).zip(moments)
        {
            *mean += (1.0 - KEPT[0]) * (gradient - *mean);
            *square += (1.0 - KEPT[1]) * (gradient * gradient - *square);
            let size = (*square / square_part).sqrt() + LEAST;
            *parameter -= length * (*mean / mean_part) / size;
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
}
