//! What JPEG does to a picture: its colours at half the resolution (4:2:0), and both in quantized waves of blocks of 8 x 8 pixels (ITU-T T.81, with the
//! tables of its annex K in the strengths of the Independent JPEG Group).

use std::f32::consts::{FRAC_1_SQRT_2, PI};

use tabletop::core::Picture;

/// Pixels along a side of a block.
const SIDE: usize = 8;

#[rustfmt::skip]
const LUMA: [f32; 64] = [
    16.0, 11.0, 10.0, 16.0, 24.0, 40.0, 51.0, 61.0,
    12.0, 12.0, 14.0, 19.0, 26.0, 58.0, 60.0, 55.0,
    14.0, 13.0, 16.0, 24.0, 40.0, 57.0, 69.0, 56.0,
    14.0, 17.0, 22.0, 29.0, 51.0, 87.0, 80.0, 62.0,
    18.0, 22.0, 37.0, 56.0, 68.0, 109.0, 103.0, 77.0,
    24.0, 35.0, 55.0, 64.0, 81.0, 104.0, 113.0, 92.0,
    49.0, 64.0, 78.0, 87.0, 103.0, 121.0, 120.0, 101.0,
    72.0, 92.0, 95.0, 98.0, 112.0, 100.0, 103.0, 99.0,
];

/// The strength of a wave's quantization in the planes of the colours.
const fn chroma_step(row: usize, column: usize) -> f32 {
    const LOW: [[f32; 4]; 4] = [
        [17.0, 18.0, 24.0, 47.0],
        [18.0, 21.0, 26.0, 66.0],
        [24.0, 26.0, 56.0, 99.0],
        [47.0, 66.0, 99.0, 99.0],
    ];
    match row < 4 && column < 4 {
        true => LOW[row][column],
        false => 99.0,
    }
}

/// One of the three parts of a picture: brightness, or the distance from grey towards blue or red.
struct Plane {
    width: usize,
    height: usize,
    values: Vec<f32>,
}

/// The picture after it went through JPEG of this quality, from 1 to 100.
pub fn through_jpeg(picture: &Picture, quality: f32) -> Picture {
    let scale = match quality < 50.0 {
        true => 50.0 / quality,
        false => 2.0 - quality / 50.0,
    };
    let step = |usual: f32| (usual * scale).round().max(1.0);
    let (width, height) = (picture.width as usize, picture.height as usize);
    let plane = |of: &dyn Fn([f32; 3]) -> f32| {
        let pixels = picture.rgb.chunks_exact(3);
        Plane {
            width,
            height,
            values: pixels
                .map(|rgb| of([rgb[0], rgb[1], rgb[2]].map(f32::from)))
                .collect(),
        }
    };
    let luma = plane(&|[r, g, b]| 0.299 * r + 0.587 * g + 0.114 * b);
    let blue = plane(&|[r, g, b]| -0.168_736 * r - 0.331_264 * g + 0.5 * b);
    let red = plane(&|[r, g, b]| 0.5 * r - 0.418_688 * g - 0.081_312 * b);
    let luma = luma.quantized(|row, column| step(LUMA[SIDE * row + column]));
    let coarse = |plane: Plane| {
        let half = plane.halved();
        half.quantized(|row, column| step(chroma_step(row, column)))
    };
    let [blue, red] = [blue, red].map(coarse);
    let mut through = picture.clone();
    for row in 0..height {
        for column in 0..width {
            let y = luma.at(row, column);
            let [cb, cr] = [&blue, &red].map(|plane| plane.smooth_at(row, column));
            let rgb = [
                y + 1.402 * cr,
                y - 0.344_136 * cb - 0.714_136 * cr,
                y + 1.772 * cb,
            ];
            let first = 3 * (row * width + column);
            for (own, part) in through.rgb[first..first + 3].iter_mut().zip(rgb) {
                *own = part.round().clamp(0.0, 255.0) as u8;
            }
        }
    }
    through
}

impl Plane {
    /// The value of a pixel; beside the plane, that at its edge.
    fn at(&self, row: usize, column: usize) -> f32 {
        self.values[row.min(self.height - 1) * self.width + column.min(self.width - 1)]
    }

    /// The means of two by two pixels.
    fn halved(&self) -> Self {
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let means = (0..height).flat_map(|row| {
            (0..width).map(move |column| {
                let four = [(0, 0), (0, 1), (1, 0), (1, 1)];
                let four = four.map(|(down, right)| self.at(2 * row + down, 2 * column + right));
                four.iter().sum::<f32>() / 4.0
            })
        });
        Self {
            width,
            height,
            values: means.collect(),
        }
    }

    /// The value at a pixel of a plane that is twice as large, between the four nearest.
    fn smooth_at(&self, row: usize, column: usize) -> f32 {
        let near = |at: usize| [at / 2, (at + at % 2 * 2).saturating_sub(1) / 2];
        let [rows, columns] = [near(row), near(column)];
        let weights = [0.75, 0.25];
        let mut sum = 0.0;
        for (row, down) in rows.into_iter().zip(weights) {
            for (column, right) in columns.into_iter().zip(weights) {
                sum += down * right * self.at(row, column);
            }
        }
        sum
    }

    /// The plane with the waves of its blocks rounded to these steps, by the rows and columns of waves.
    fn quantized(&self, step: impl Fn(usize, usize) -> f32) -> Self {
        let wave = |at: usize, wave: usize| {
            let scale = if wave == 0 { FRAC_1_SQRT_2 } else { 1.0 } / 2.0;
            scale * ((2 * at + 1) as f32 * wave as f32 * PI / 16.0).cos()
        };
        let waves: [[f32; SIDE]; SIDE] =
            std::array::from_fn(|at| std::array::from_fn(|own| wave(at, own)));
        let mut values = self.values.clone();
        for top in (0..self.height).step_by(SIDE) {
            for left in (0..self.width).step_by(SIDE) {
                let mut strengths = [[0.0_f32; SIDE]; SIDE];
                for (down, strengths) in strengths.iter_mut().enumerate() {
                    for (across, strength) in strengths.iter_mut().enumerate() {
                        let mut sum = 0.0;
                        for row in 0..SIDE {
                            for column in 0..SIDE {
                                let weight = waves[row][down] * waves[column][across];
                                sum += weight * self.at(top + row, left + column);
                            }
                        }
                        let step = step(down, across);
                        *strength = (sum / step).round() * step;
                    }
                }
                for row in top..(top + SIDE).min(self.height) {
                    for column in left..(left + SIDE).min(self.width) {
                        let mut sum = 0.0;
                        for (down, strengths) in strengths.iter().enumerate() {
                            for (across, strength) in strengths.iter().enumerate() {
                                sum += strength
                                    * waves[row - top][down]
                                    * waves[column - left][across];
                            }
                        }
                        values[row * self.width + column] = sum;
                    }
                }
            }
        }
        Self { values, ..*self }
    }
}
