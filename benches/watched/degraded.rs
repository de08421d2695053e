//! Pictures that have become worse on their way, or show more than the eyes are told.

use tabletop::core::{Picture, Random};

use crate::jpeg::through_jpeg;

/// What happened to pictures on their way.
#[derive(Clone, Copy, Debug)]
pub enum Degradation {
    None,
    /// JPEG of this quality, from 1 to 100, with its colours at half the resolution.
    Jpeg(f32),
    /// Blur of this standard deviation, in pixels.
    Blur(f32),
    /// Each part of a pixel times a gain, plus an offset in grey levels.
    Brightness(f32, f32),
    /// Noise of this standard deviation, in grey levels.
    Noise(f32),
    /// Twice the size, and back: what a film in more pixels makes of them.
    Rescaled,
}

impl Degradation {
    /// The picture after it. The number decides the noise.
    pub fn of(self, picture: &Picture, number: u64) -> Picture {
        match self {
            Self::None => picture.clone(),
            Self::Jpeg(quality) => through_jpeg(picture, quality),
            Self::Blur(deviation) => blurred(picture, deviation),
            Self::Brightness(gain, offset) => {
                changed(picture, |part| f32::from(part) * gain + offset)
            }
            Self::Noise(deviation) => {
                let mut random = Random::new(number);
                changed(picture, |part| {
                    f32::from(part) + deviation * normal(&mut random)
                })
            }
            Self::Rescaled => blurred(&through_jpeg(&blurred(picture, 0.4), 85.0), 0.3),
        }
    }
}

fn changed(picture: &Picture, mut change: impl FnMut(u8) -> f32) -> Picture {
    let parts = picture.rgb.iter();
    Picture {
        rgb: parts
            .map(|part| change(*part).round().clamp(0.0, 255.0) as u8)
            .collect(),
        ..picture.clone()
    }
}

/// A normally distributed number, nearly: the sum of twelve even ones.
fn normal(random: &mut Random) -> f32 {
    (0..12).map(|_| random.between((0.0, 1.0))).sum::<f32>() - 6.0
}

fn blurred(picture: &Picture, deviation: f32) -> Picture {
    let reach = (3.0 * deviation).ceil() as i32;
    let weight = |by: i32| (-(by * by) as f32 / (2.0 * deviation * deviation)).exp();
    let sum: f32 = (-reach..=reach).map(weight).sum();
    let sides = [picture.width, picture.height].map(|side| side as i32 - 1);
    let mut values: Vec<f32> = picture.rgb.iter().copied().map(f32::from).collect();
    for axis in 0..2 {
        let before = values.clone();
        for row in 0..=sides[1] {
            for column in 0..=sides[0] {
                for part in 0..3 {
                    let at = |by: i32| {
                        let mut place = [column, row];
                        place[axis] = (place[axis] + by).clamp(0, sides[axis]);
                        let pixel = place[1] * (sides[0] + 1) + place[0];
                        before[3 * pixel as usize + part]
                    };
                    let spread: f32 = (-reach..=reach).map(|by| weight(by) * at(by)).sum();
                    values[3 * (row * (sides[0] + 1) + column) as usize + part] = spread / sum;
                }
            }
        }
    }
    let mut parts = values.into_iter();
    changed(picture, |_| parts.next().unwrap_or_default())
}
