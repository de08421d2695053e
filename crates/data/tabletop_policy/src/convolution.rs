//! Convolutions, forward and backward.
//!
//! Each output number has an accumulator of its own, to which products are added one after the other, in the order of the inputs. Neighbouring
//! accumulators are vectors, as wide as the processor has them, and nothing is fused, so the bits are those of the plain loop on every processor.

use std::ops::Range;

use fearless_simd::{Level, Simd, SimdBase, dispatch};
use tabletop_core::Random;

use crate::planes::Planes;

/// Outputs of a convolution are a multiple of this.
pub(crate) const BLOCK: usize = 16;
/// Pixels over which a weight's gradient is summed at a time, so that they stay in the nearest cache.
const CHUNK: usize = 256;

/// A convolution, 3×3 or 1×1, with a bias. Its weights and biases are a part of the network's parameters.
#[derive(Clone, Debug)]
pub(crate) struct Convolution {
    name: &'static str,
    inputs: usize,
    pub outputs: usize,
    /// Width and height of the kernel: 3 or 1.
    side: usize,
    /// The first of its parameters: weights by output, input, row and column, then biases.
    first: usize,
}

impl Convolution {
    pub fn new(
        name: &'static str,
        [inputs, outputs]: [usize; 2],
        side: usize,
        parameters: &mut Range<usize>,
    ) -> Self {
        debug_assert!(outputs.is_multiple_of(BLOCK) && (side == 1 || side == 3));
        let first = parameters.end;
        let new = Self {
            name,
            inputs,
            outputs,
            side,
            first,
        };
        parameters.end = new.biases().end;
        new
    }

    fn taps(&self) -> usize {
        self.side * self.side
    }

    fn weights(&self) -> Range<usize> {
        self.first..self.first + self.outputs * self.inputs * self.taps()
    }

    fn biases(&self) -> Range<usize> {
        let first = self.weights().end;
        first..first + self.outputs
    }

    /// Its tensors in a file: their names, shapes and parameters.
    pub fn tensors(&self) -> [(String, Vec<usize>, Range<usize>); 2] {
        let kernel = vec![self.outputs, self.inputs, self.side, self.side];
        [
            (format!("{}.weight", self.name), kernel, self.weights()),
            (
                format!("{}.bias", self.name),
                vec![self.outputs],
                self.biases(),
            ),
        ]
    }

    /// Draws weights that keep the size of numbers from a layer to the next (He et al., Delving deep into rectifiers, 2015).
    pub fn draw(&self, parameters: &mut [f32], random: &mut Random) {
        let most = (6.0 / (self.inputs * self.taps()) as f32).sqrt();
        for weight in &mut parameters[self.weights()] {
            *weight = random.between((-most, most));
        }
    }

    pub fn forward(&self, parameters: &[f32], input: &Planes) -> Planes {
        let packed = self.packed_forward(parameters);
        let mut output = Planes::new(self.outputs, input.width(), input.height());
        self.convolve(&packed, &parameters[self.biases()], input, &mut output);
        output
    }

    fn packed_forward(&self, parameters: &[f32]) -> Vec<f32> {
        let weights = &parameters[self.weights()];
        let terms = self.inputs * self.taps();
        let weight = |output: usize, input: usize, tap: usize| {
            weights[output * terms + input * self.taps() + tap]
        };
        self.packed([self.inputs, self.outputs], weight)
    }

    /// The gradient of the input, from that of the output.
    pub fn backward(&self, parameters: &[f32], gradient: &Planes) -> Planes {
        let weights = &parameters[self.weights()];
        let terms = self.inputs * self.taps();
        // Input and output change places, and the kernel is turned by 180°.
        let weight = |input: usize, output: usize, tap: usize| {
            weights[output * terms + input * self.taps() + self.taps() - 1 - tap]
        };
        let packed = self.packed([self.outputs, self.inputs], weight);
        let mut input = Planes::new(self.inputs, gradient.width(), gradient.height());
        self.convolve(&packed, &vec![0.0; self.inputs], gradient, &mut input);
        input
    }

    /// Weights in the order in which they are used: by block of outputs, input, tap and output.
    fn packed(
        &self,
        [inputs, outputs]: [usize; 2],
        weight: impl Fn(usize, usize, usize) -> f32,
    ) -> Vec<f32> {
        let mut packed = Vec::with_capacity(inputs * outputs * self.taps());
        for block in (0..outputs).step_by(BLOCK) {
            for input in 0..inputs {
                for tap in 0..self.taps() {
                    packed.extend((block..block + BLOCK).map(|output| weight(output, input, tap)));
                }
            }
        }
        packed
    }

    fn convolve(&self, packed: &[f32], biases: &[f32], input: &Planes, output: &mut Planes) {
        let level = Level::new();
        match self.side {
            1 => dispatch!(level, simd => convolve::<1, _>(simd, packed, biases, input, output)),
            _ => dispatch!(level, simd => convolve::<3, _>(simd, packed, biases, input, output)),
        }
        output.clear_borders();
    }

    /// Adds the gradient of weights and biases to `sum`, which is that of all parameters.
    pub fn add_gradient(&self, input: &Planes, gradient: &Planes, sum: &mut [f32]) {
        for (bias, plane) in sum[self.biases()].iter_mut().zip(gradient.each()) {
            *bias += plane.iter().sum::<f32>();
        }
        let weights = &mut sum[self.weights()];
        let level = Level::new();
        match self.side {
            1 => dispatch!(level, simd => add_gradient::<1, _>(simd, input, gradient, weights)),
            _ => dispatch!(level, simd => add_gradient::<3, _>(simd, input, gradient, weights)),
        }
    }
}

/// Sums as many neighbouring pixels at once as leave a processor with sixteen vectors room for the weights.
#[inline(always)]
fn convolve<const SIDE: usize, S: Simd>(
    simd: S,
    packed: &[f32],
    biases: &[f32],
    input: &Planes,
    output: &mut Planes,
) {
    if S::f32s::N < 8 {
        convolve_pixels::<SIDE, 2, S>(simd, packed, biases, input, output);
    } else {
        convolve_pixels::<SIDE, 3, S>(simd, packed, biases, input, output);
    }
}

#[inline(always)]
fn convolve_pixels<const SIDE: usize, const PIXELS: usize, S: Simd>(
    simd: S,
    packed: &[f32],
    biases: &[f32],
    input: &Planes,
    output: &mut Planes,
) {
    let (stride, first, pitch) = (output.stride(), output.first(), output.pitch());
    let corner = (first - 1 - pitch) + (3 - SIDE) / 2 * (pitch + 1);
    let in_block = packed.len() / biases.len() * BLOCK;
    let blocks = packed
        .chunks_exact(in_block)
        .zip(biases.as_chunks::<BLOCK>().0);
    let span = output.span();
    let numbers = output.numbers_mut();
    for pixel in (0..span).step_by(PIXELS) {
        for (block, (weights, biases)) in blocks.clone().enumerate() {
            let mut sums = [simd.load_array_f32x16(*biases); PIXELS];
            let mut weights = weights.as_chunks::<BLOCK>().0.iter();
            for plane in input.each() {
                for row in 0..SIDE {
                    let from = corner + pixel + row * pitch;
                    let taps = &plane[from..from + PIXELS + SIDE - 1];
                    for (shifted, weights) in taps.array_windows::<PIXELS>().zip(&mut weights) {
                        let weights = simd.load_array_ref_f32x16(weights);
                        for (sum, number) in sums.iter_mut().zip(shifted) {
                            *sum += weights * *number;
                        }
                    }
                }
            }
            let sums = sums.map(|sum| simd.as_array_f32x16(sum));
            let columns: [[f32; PIXELS]; BLOCK] =
                std::array::from_fn(|output| sums.map(|sums| sums[output]));
            for (output, column) in columns.iter().enumerate() {
                let at = (block * BLOCK + output) * stride + first + pixel;
                numbers[at..at + PIXELS].copy_from_slice(column);
            }
        }
    }
}

#[inline(always)]
fn add_gradient<const SIDE: usize, S: Simd>(
    simd: S,
    input: &Planes,
    gradient: &Planes,
    sum: &mut [f32],
) {
    let (first, pitch, span) = (input.first(), input.pitch(), input.span());
    let corner = (first - 1 - pitch) + (3 - SIDE) / 2 * (pitch + 1);
    let terms = input.count() * SIDE * SIDE;
    let planes: Vec<_> = gradient.each().collect();
    let mut turned = [[0.0; BLOCK]; CHUNK];
    for (block, planes) in planes.chunks_exact(BLOCK).enumerate() {
        // By term and output, so that vectors run along the outputs.
        let mut sums = vec![[0.0_f32; BLOCK]; terms];
        for from in (0..span).step_by(CHUNK) {
            let count = CHUNK.min(span - from);
            for (output, plane) in planes.iter().enumerate() {
                let pixels = &plane[first + from..first + from + count];
                for (turned, number) in turned.iter_mut().zip(pixels) {
                    turned[output] = *number;
                }
            }
            let mut rows = sums.as_chunks_mut::<SIDE>().0.iter_mut();
            for plane in input.each() {
                for (row, sums) in (0..SIDE).zip(&mut rows) {
                    let at = corner + from + row * pitch;
                    let taps = plane[at..at + count + SIDE - 1].array_windows::<SIDE>();
                    let mut now = sums.map(|sum| simd.load_array_f32x16(sum));
                    for (gradients, taps) in turned.iter().zip(taps) {
                        let gradients = simd.load_array_ref_f32x16(gradients);
                        for (sum, tap) in now.iter_mut().zip(taps) {
                            *sum += gradients * *tap;
                        }
                    }
                    *sums = now.map(|sum| simd.as_array_f32x16(sum));
                }
            }
        }
        for (term, sums) in sums.iter().enumerate() {
            for (output, number) in sums.iter().enumerate() {
                sum[(block * BLOCK + output) * terms + term] += number;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn random_planes(count: usize, [width, height]: [usize; 2], seed: u64) -> Planes {
        let random = &mut Random::new(seed);
        let mut planes = Planes::new(count, width, height);
        for number in planes.numbers_mut() {
            *number = random.between((-1.0, 1.0));
        }
        planes.clear_borders();
        planes
    }

    /// The number of a plane at a pixel; zero beside the plane.
    fn at(
        planes: &Planes,
        plane: usize,
        column: usize,
        row: usize,
        tap: usize,
        side: usize,
    ) -> f32 {
        let (x, y) = (column + tap % side, row + tap / side);
        let (x, y) = (x.checked_sub(side / 2), y.checked_sub(side / 2));
        let inside = x
            .zip(y)
            .filter(|&(x, y)| x < planes.width() && y < planes.height());
        inside.map_or(0.0, |(x, y)| planes.get(plane, x, y))
    }

    /// As [`Convolution::forward`] does on a processor with short vectors.
    fn forward_in_short_vectors(
        convolution: &Convolution,
        parameters: &[f32],
        input: &Planes,
    ) -> Planes {
        let packed = &convolution.packed_forward(parameters);
        let biases = &parameters[convolution.biases()];
        let mut output = Planes::new(convolution.outputs, input.width(), input.height());
        let to = &mut output;
        let level = Level::baseline();
        match convolution.side {
            1 => {
                dispatch!(level, simd => convolve_pixels::<1, 2, _>(simd, packed, biases, input, to))
            }
            _ => {
                dispatch!(level, simd => convolve_pixels::<3, 2, _>(simd, packed, biases, input, to))
            }
        }
        output.clear_borders();
        output
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(16))]

        #[test]
        fn the_bits_are_those_of_plain_loops(
            inputs in 1..6_usize,
            width in 1..40_usize,
            height in 1..20_usize,
            side in prop::sample::select(vec![1, 3]),
            seed: u64,
        ) {
            let convolution = Convolution::new("c", [inputs, BLOCK], side, &mut Range::default());
            let mut parameters = vec![0.1; convolution.biases().end];
            convolution.draw(&mut parameters, &mut Random::new(seed));
            let input = random_planes(inputs, [width, height], seed ^ 1);
            let output = convolution.forward(&parameters, &input);
            prop_assert!(output == forward_in_short_vectors(&convolution, &parameters, &input));
            let taps = side * side;
            for (plane, row, column) in [(0, 0, 0), (5, height / 2, width / 2), (15, height - 1, width - 1)] {
                let mut sum = 0.1;
                for term in 0..inputs * taps {
                    let number = at(&input, term / taps, column, row, term % taps, side);
                    sum += parameters[plane * inputs * taps + term] * number;
                }
                prop_assert_eq!(output.get(plane, column, row).to_bits(), sum.to_bits());
            }
        }

        #[test]
        fn backward_is_the_transpose_of_forward(
            width in 1..40_usize,
            height in 1..20_usize,
            side in prop::sample::select(vec![1, 3]),
            seed: u64,
        ) {
            let convolution = Convolution::new("c", [BLOCK, BLOCK], side, &mut Range::default());
            let mut parameters = vec![0.0; convolution.biases().end];
            convolution.draw(&mut parameters, &mut Random::new(seed));
            let input = random_planes(BLOCK, [width, height], seed ^ 1);
            let gradient = random_planes(BLOCK, [width, height], seed ^ 2);
            let product = |one: &Planes, other: &Planes| -> f64 {
                let pairs = one.each().flatten().zip(other.each().flatten());
                pairs.map(|(one, other)| f64::from(one * other)).sum()
            };
            let output = product(&convolution.forward(&parameters, &input), &gradient);
            let before = product(&convolution.backward(&parameters, &gradient), &input);
            let mut sum = vec![0.0; parameters.len()];
            convolution.add_gradient(&input, &gradient, &mut sum);
            let pairs = sum.iter().zip(&parameters);
            let of_weights: f64 = pairs.map(|(part, weight)| f64::from(part * weight)).sum();
            prop_assert!((output - before).abs() < 1e-2, "{} {}", output, before);
            prop_assert!((output - of_weights).abs() < 1e-2, "{} {}", output, of_weights);
        }
    }
}
