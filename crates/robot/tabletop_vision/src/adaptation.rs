//! Adaptation: the light and the transfer in which what is known to be in a picture looks most like it.

use bevy::math::Vec3;
use tabletop_camera::{Camera, Rasterizer, Scene};
use tabletop_core::{Light, Picture};

use crate::{
    lighting::estimated,
    residual::{OUTLIER, loss},
    transfer::{BRIGHTNESS, Kernel, ToneTransfer, colors_of, spread_colors},
};

/// Least number of pixels of nothing that tell how dark black is.
const LEAST_BLACK: usize = 60;
/// The first step between spreads that are tried, in pixels, and the smallest.
const STEP: f32 = 0.2;
const LEAST_STEP: f32 = 0.03;
/// The largest spread, in pixels.
const WIDEST: f32 = 2.4;

/// What a camera adapts to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Adaptation {
    pub light: Light,
    pub transfer: ToneTransfer,
}

impl Adaptation {
    /// True if a picture tells it from another one.
    pub fn differs_from(&self, other: &Self) -> bool {
        /// The least difference of a share, of a grey level, and of a spread in pixels.
        const LEAST: [f32; 3] = [0.01, 1.0, LEAST_STEP];
        let far = |a: Vec3, b: Vec3, least: f32| (a - b).abs().max_element() > least;
        let (light, transfer) = (&self.light, &self.transfer);
        far(light.along, other.light.along, LEAST[0])
            || far(light.against, other.light.against, LEAST[0])
            || far(light.color, other.light.color, LEAST[0])
            || far(transfer.gain, other.transfer.gain, LEAST[0])
            || far(transfer.black, other.transfer.black, LEAST[1])
            || (transfer.blur - other.transfer.blur).abs() > LEAST[2]
            || (transfer.color_blur - other.transfer.color_blur).abs() > LEAST[2]
    }
}

/// The adaptation in which a scene looks most like a picture.
pub(crate) fn adapted(seen: &Picture, scene: &Scene, camera: &Camera) -> Adaptation {
    let black = black_of(seen, &drawn(scene, camera));
    let over_black = Picture {
        rgb: parts_of(seen)
            .map(|(part, value)| (value - black[part]).round().max(0.0) as u8)
            .collect(),
        ..seen.clone()
    };
    let light = estimated(&over_black, scene, camera, &Light::default());
    // What is too bright is cut off at each surface, or after the picture was taken.
    let at_surfaces = Adaptation {
        light,
        transfer: ToneTransfer {
            black,
            ..ToneTransfer::EXACT
        },
    };
    let mut comparison = Comparison::of(seen, scene, camera, at_surfaces);
    let overexposed = Comparison::of(
        seen,
        scene,
        camera,
        Adaptation {
            light: Light::default(),
            ..at_surfaces
        },
    );
    let overexposed = overexposed.overexposed();
    if overexposed.loss([0.0; 2], full) < comparison.loss([0.0; 2], full) {
        comparison = overexposed;
    }
    let blur = narrowest(0.0, |blur| comparison.loss([blur; 2], brightness));
    let compared = ToneTransfer {
        blur,
        color_blur: blur + 1.0,
        ..ToneTransfer::EXACT
    };
    comparison.seen = colors_of(&compared.compared(seen));
    let color_blur = narrowest(blur, |color_blur| {
        let own = ToneTransfer {
            color_blur,
            ..compared
        };
        comparison.loss([blur, own.compared_color_blur()], colors)
    });
    Adaptation {
        transfer: ToneTransfer {
            blur,
            color_blur,
            ..comparison.adaptation.transfer
        },
        ..comparison.adaptation
    }
}

/// The values of all parts of all pixels, each with the number of its part.
fn parts_of(picture: &Picture) -> impl Iterator<Item = (usize, f32)> {
    let parts = picture.rgb.iter().enumerate();
    parts.map(|(i, value)| (i % 3, f32::from(*value)))
}

/// What is seen where nothing is: the median.
fn black_of(seen: &Picture, drawn: &Picture) -> Vec3 {
    let width = drawn.width as usize;
    let is_nothing = |i: usize| drawn.objects.get(i).is_none_or(|object| *object == 0);
    let inner = (0..drawn.objects.len()).filter(|&i| {
        let beside = [i.wrapping_sub(1), i + 1, i.wrapping_sub(width), i + width];
        is_nothing(i) && beside.into_iter().all(is_nothing)
    });
    let mut parts: [Vec<u8>; 3] = Default::default();
    for i in inner {
        for (part, values) in parts.iter_mut().enumerate() {
            values.push(seen.rgb[3 * i + part]);
        }
    }
    if parts[0].len() < LEAST_BLACK {
        return Vec3::ZERO;
    }
    let median = |values: &mut Vec<u8>| {
        let middle = values.len() / 2;
        f32::from(*values.select_nth_unstable(middle).1)
    };
    Vec3::from_array(parts.each_mut().map(median))
}

fn drawn(scene: &Scene, camera: &Camera) -> Picture {
    let mut picture = Picture::default();
    Rasterizer::alone().draw(scene, camera, &mut picture);
    picture
}

/// The spread with the least loss, from the narrowest on: losses fall up to it, and rise beyond it.
fn narrowest(least: f32, mut loss: impl FnMut(f32) -> f64) -> f32 {
    let mut best = (least, loss(least));
    let mut step = STEP;
    while best.0 + step < WIDEST {
        let next = best.0 + step;
        let own = loss(next);
        if own >= best.1 {
            break;
        }
        best = (next, own);
    }
    while step > LEAST_STEP {
        step /= 2.0;
        for next in [best.0 + step, best.0 - step] {
            let own = if next < least {
                f64::INFINITY
            } else {
                loss(next)
            };
            if own < best.1 {
                best = (next, own);
            }
        }
    }
    best.0
}

/// A drawn picture beside a seen one.
struct Comparison {
    seen: Vec<Vec3>,
    drawn: Picture,
    adaptation: Adaptation,
}

impl Comparison {
    fn of(seen: &Picture, scene: &Scene, camera: &Camera, adaptation: Adaptation) -> Self {
        let camera = Camera {
            light: adaptation.light,
            ..*camera
        };
        Self {
            seen: colors_of(seen),
            drawn: drawn(scene, &camera),
            adaptation,
        }
    }

    /// The same with the gain, from 1 on, with the least loss.
    fn overexposed(mut self) -> Self {
        let gain = narrowest(0.0, |over| {
            self.adaptation.transfer.gain = Vec3::splat(1.0 + over);
            self.loss([0.0; 2], full)
        });
        self.adaptation.transfer.gain = Vec3::splat(1.0 + gain);
        self
    }

    /// What is drawn, exposed.
    fn exposed(&self) -> Picture {
        let ToneTransfer { gain, black, .. } = self.adaptation.transfer;
        let values = parts_of(&self.drawn);
        let values = values.map(|(part, value)| {
            (value * gain[part] + black[part]).round().clamp(0.0, 255.0) as u8
        });
        Picture {
            rgb: values.collect(),
            ..self.drawn.clone()
        }
    }

    /// The loss if brightness and colours are spread like this.
    fn loss(&self, [blur, colors]: [f32; 2], square: impl Fn(Vec3) -> f32) -> f64 {
        let kernels = [Kernel::of(blur), Kernel::of(colors)];
        let shown = spread_colors(&self.exposed(), &kernels);
        let pairs = self.seen.iter().zip(&shown);
        let losses = pairs.map(|(seen, shown)| f64::from(loss(square(*seen - *shown), OUTLIER)));
        losses.sum()
    }
}

/// The square of a difference: all of it, of brightness, and of colours.
fn full(difference: Vec3) -> f32 {
    difference.length_squared()
}

fn brightness(difference: Vec3) -> f32 {
    let own = difference.dot(BRIGHTNESS);
    3.0 * own * own
}

fn colors(difference: Vec3) -> f32 {
    (difference - difference.dot(BRIGHTNESS)).length_squared()
}
