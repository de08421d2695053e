//! The network: a U-Net (Ronneberger et al., U-Net: Convolutional networks for biomedical image segmentation, 2015), with one number for the whole
//! picture beside its planes.

use std::ops::Range;

use tabletop_core::Random;

use crate::{
    convolution::{BLOCK, Convolution},
    planes::Planes,
    resampling::{doubled_before, doubled_before_backward, max_pooled, max_pooled_backward},
};

/// Planes of each level on the way down; each level is half as wide and high as the one before.
const DOWN: [usize; 6] = [16, 32, 48, 64, 64, 64];
/// Planes on the way up, from the second level on.
const UP: [usize; 4] = [32, 32, 64, 64];
const DOWN_NAMES: [&str; DOWN.len()] = ["down.0", "down.1", "down.2", "down.3", "down.4", "down.5"];
const UP_NAMES: [&str; UP.len()] = ["up.1", "up.2", "up.3", "up.4"];

/// The network's shape. Width and height of its input are multiples of 32. Its parameters are a list of numbers beside it.
#[derive(Clone, Debug)]
pub(crate) struct UNet {
    down: Vec<Convolution>,
    up: Vec<Convolution>,
    /// From the planes of the second level to the output.
    head: Convolution,
    /// From the planes of the last level to a plane whose mean is the number for the whole picture.
    whole: Convolution,
    parameters: usize,
}

/// What the network makes of an input.
pub(crate) struct Response {
    /// Planes of half the input's size.
    pub planes: Planes,
    /// A number for the whole picture.
    pub whole: f32,
    /// Inputs and outputs of the convolutions.
    down: Vec<[Planes; 2]>,
    up: Vec<[Planes; 2]>,
}

impl UNet {
    pub fn new(inputs: usize, outputs: usize) -> Self {
        let parameters = &mut Range::default();
        let mut before = inputs;
        let down = DOWN_NAMES.into_iter().zip(DOWN);
        let down = down.map(|(name, planes)| {
            let from = std::mem::replace(&mut before, planes);
            Convolution::new(name, [from, planes], 3, parameters)
        });
        let down: Vec<_> = down.collect();
        let up = (0..UP.len()).map(|level| {
            let below = UP.get(level + 1).unwrap_or(&DOWN[DOWN.len() - 1]);
            let inputs = below + DOWN[level + 1];
            Convolution::new(UP_NAMES[level], [inputs, UP[level]], 3, parameters)
        });
        let up = up.collect();
        let head = Convolution::new("head", [UP[0], outputs], 1, parameters);
        let deepest = [DOWN[DOWN.len() - 1], BLOCK];
        let whole = Convolution::new("whole", deepest, 1, parameters);
        Self {
            down,
            up,
            head,
            whole,
            parameters: parameters.end,
        }
    }

    /// The number of parameters.
    pub fn parameters(&self) -> usize {
        self.parameters
    }

    pub fn convolutions(&self) -> impl Iterator<Item = &Convolution> {
        let ends = [&self.head, &self.whole];
        self.down.iter().chain(&self.up).chain(ends)
    }

    /// Random parameters to begin with. The last convolutions begin with zeros: all places are equally likely. Where they begin with random ones, the first
    /// steps undo confident guesses, after which most units are zero everywhere and learn no more.
    pub fn drawn(&self, seed: u64) -> Vec<f32> {
        let random = &mut Random::new(seed);
        let mut parameters = vec![0.0; self.parameters];
        for convolution in self.down.iter().chain(&self.up) {
            convolution.draw(&mut parameters, random);
        }
        parameters
    }

    pub fn forward(&self, parameters: &[f32], input: Planes) -> Response {
        let rectified = |convolution: &Convolution, input: Planes| {
            let mut output = convolution.forward(parameters, &input);
            output.rectify();
            [input, output]
        };
        let mut down: Vec<[Planes; 2]> = Vec::new();
        for convolution in &self.down {
            let input = match down.last() {
                Some([_, above]) => max_pooled(above),
                None => input.clone(),
            };
            down.push(rectified(convolution, input));
        }
        let mut up: Vec<[Planes; 2]> = Vec::new();
        for (convolution, [_, beside]) in self.up.iter().zip(&down[1..]).rev() {
            let [_, below] = up.last().unwrap_or(&down[down.len() - 1]);
            let input = doubled_before(below, beside);
            up.push(rectified(convolution, input));
        }
        let [_, finest] = &up[up.len() - 1];
        let [_, coarsest] = &down[down.len() - 1];
        let whole = self.whole.forward(parameters, coarsest);
        let pixels = (whole.width() * whole.height()) as f32;
        Response {
            planes: self.head.forward(parameters, finest),
            whole: whole.pixels(0).sum::<f32>() / pixels,
            down,
            up,
        }
    }

    /// The gradient of all parameters, from those of the response's planes and of its number.
    pub fn backward(
        &self,
        parameters: &[f32],
        response: &Response,
        planes: &Planes,
        whole: f32,
    ) -> Vec<f32> {
        let mut sum = vec![0.0; self.parameters];
        let Response { down, up, .. } = response;
        let [_, finest] = &up[up.len() - 1];
        self.head.add_gradient(finest, planes, &mut sum);
        let mut gradient = self.head.backward(parameters, planes);
        let mut beside = Vec::new();
        for (convolution, [input, output]) in self.up.iter().zip(up.iter().rev()) {
            gradient.keep_where_positive(output);
            convolution.add_gradient(input, &gradient, &mut sum);
            let joined = convolution.backward(parameters, &gradient);
            let level = beside.len() + 1;
            let below = joined.count() - DOWN[level];
            let [small, other] = doubled_before_backward(&joined, below);
            beside.push(other);
            gradient = small;
        }
        let [_, coarsest] = &down[down.len() - 1];
        let mut mean = Planes::new(self.whole.outputs, coarsest.width(), coarsest.height());
        let share = whole / (mean.width() * mean.height()) as f32;
        for row in 0..mean.height() {
            mean.row_mut(0, row).fill(share);
        }
        self.whole.add_gradient(coarsest, &mean, &mut sum);
        gradient.add(&self.whole.backward(parameters, &mean));
        for (level, (convolution, [input, output])) in self.down.iter().zip(down).enumerate().rev()
        {
            if let Some(beside) = level.checked_sub(1).and_then(|level| beside.get(level)) {
                gradient.add(beside);
            }
            gradient.keep_where_positive(output);
            convolution.add_gradient(input, &gradient, &mut sum);
            if let Some(above) = level.checked_sub(1) {
                let pooled = convolution.backward(parameters, &gradient);
                gradient = max_pooled_backward(&down[above][1], &pooled);
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use bevy::math::Vec2;

    use super::*;
    use crate::label::{Heading, HeatMark, Label, LabelPlanes};

    fn mark(x: f32, y: f32, level: usize) -> HeatMark {
        HeatMark {
            at: Vec2::new(x, y),
            level,
            heading: Heading::of(&[0.3]),
        }
    }

    fn drawn_everywhere(net: &UNet) -> Vec<f32> {
        let mut parameters = net.drawn(2);
        for end in [&net.head, &net.whole] {
            end.draw(&mut parameters, &mut Random::new(3));
        }
        parameters
    }

    #[test]
    fn it_begins_without_a_guess() {
        let net = UNet::new(5, LabelPlanes { levels: 3 }.planes());
        let mut input = Planes::new(5, 64, 32);
        input.numbers_mut().fill(0.5);
        input.clear_borders();
        let response = net.forward(&net.drawn(2), input);
        assert!(response.planes.pixels(0).all(|heat| heat == 0.0));
        assert_eq!(response.whole, 0.0);
        assert!(response.up[3][1].pixels(0).any(|number| number > 0.0));
    }

    #[test]
    fn gradients_are_those_of_finite_differences() {
        let planes = LabelPlanes { levels: 3 };
        let net = UNet::new(5, planes.planes());
        let random = &mut Random::new(1);
        let mut input = Planes::new(5, 64, 32);
        for number in input.numbers_mut() {
            *number = random.between((-0.5, 0.5));
        }
        input.clear_borders();
        let (pick, place) = (mark(20.3, 11.8, 0), mark(50.0, 25.5, 2));
        for label in [Label::Move { pick, place }, Label::Done] {
            let mut parameters = drawn_everywhere(&net);
            let loss = |parameters: &[f32]| {
                let response = net.forward(parameters, input.clone());
                let (loss, of_planes, of_whole) = planes.loss(&response, &label);
                (
                    loss,
                    net.backward(parameters, &response, &of_planes, of_whole),
                )
            };
            let (_, gradient) = loss(&parameters);
            let tensors = net.convolutions().flat_map(Convolution::tensors);
            for (name, _, range) in tensors {
                // Along the gradient, where the difference is largest and rounding matters least.
                let along = gradient[range.clone()].to_vec();
                let expected: f32 = along.iter().map(|part| part * part).sum();
                let mut at = |step: f32| {
                    let before = parameters.clone();
                    for (parameter, part) in parameters[range.clone()].iter_mut().zip(&along) {
                        *parameter += step * part;
                    }
                    let (loss, _) = loss(&parameters);
                    parameters = before;
                    loss
                };
                let step = 0.003 / expected.sqrt().max(1e-3);
                let found = (at(step) - at(-step)) / (2.0 * step);
                let off = (found - expected).abs();
                assert!(
                    off <= 0.05 * expected + 1e-4,
                    "{name}: {found} is not {expected}"
                );
            }
        }
    }
}
