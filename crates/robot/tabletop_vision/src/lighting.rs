//! The light of a picture, from the faces of what is known in it.

use bevy::math::Vec3;
use tabletop_camera::{Camera, Rasterizer, Scene};
use tabletop_core::{Light, Picture};

use crate::{normal::LeastSquares, residual::square_of};

/// The squared difference of a pixel at which it counts half as much as an outlier.
const OUTLIER: f32 = 3_000.0;
/// Number of times that shares and colour are estimated in turn.
const ROUNDS: usize = 4;
/// Weight of the usual shares, as a number of pixels of full brightness: it decides for faces that are not seen.
const USUAL: f32 = 4.0;
/// The brightest value of a part of a pixel that is no saturated one.
const UNSATURATED: u8 = 252;
/// The largest part of a light's colour.
const BRIGHTEST: f32 = 4.0;

/// The directions of faces along which lights differ: along X and Y, and against X, Y and Z. What faces up shows its full colour.
const SIDES: usize = 5;

/// The light in which a scene looks most like a picture. `usual` decides where faces are not seen.
pub(crate) fn estimated(seen: &Picture, scene: &Scene, camera: &Camera, usual: &Light) -> Light {
    let up = shown(scene, camera, Vec3::Z, Vec3::ZERO);
    let sides = [
        shown(scene, camera, Vec3::X, Vec3::ZERO),
        shown(scene, camera, Vec3::Y, Vec3::ZERO),
        shown(scene, camera, Vec3::ZERO, Vec3::X),
        shown(scene, camera, Vec3::ZERO, Vec3::Y),
        shown(scene, camera, Vec3::ZERO, Vec3::Z),
    ];
    let is_flat = flat(&up, &sides);
    let mut estimate = Estimate {
        shares: [
            usual.along.x,
            usual.along.y,
            usual.against.x,
            usual.against.y,
            usual.against.z,
        ],
        color: color_of_bright(seen, &up).unwrap_or(usual.color),
    };
    let usual = estimate.shares;
    for _ in 0..ROUNDS {
        estimate.improve(seen, &up, &sides, &is_flat, &usual);
    }
    estimate.light()
}

/// The colour of what is drawn white and faces up: the median, since other objects may lie there.
fn color_of_bright(seen: &Picture, up: &Picture) -> Option<Vec3> {
    let white = seen.rgb.chunks_exact(3).zip(up.rgb.chunks_exact(3));
    let white = white.filter(|(_, up)| up.iter().all(|part| *part == 255));
    let mut parts: [Vec<u8>; 3] = Default::default();
    for (seen, _) in white {
        for (part, seen) in parts.iter_mut().zip(seen) {
            part.push(*seen);
        }
    }
    let median = |part: &mut Vec<u8>| {
        let middle = part.len() / 2;
        (!part.is_empty()).then(|| f32::from(*part.select_nth_unstable(middle).1) / 255.0)
    };
    let [red, green, blue] = &mut parts;
    Some(Vec3::new(median(red)?, median(green)?, median(blue)?))
}

/// The scene in a light that comes from one side only.
fn shown(scene: &Scene, camera: &Camera, along: Vec3, against: Vec3) -> Picture {
    let camera = Camera {
        light: Light {
            along,
            against,
            color: Vec3::ONE,
        },
        ..*camera
    };
    let mut picture = Picture::default();
    Rasterizer::alone().draw(scene, &camera, &mut picture);
    picture
}

/// Whether each pixel looks like those beside it in the light of every side: what is seen at edges depends on how sharp they are.
fn flat(up: &Picture, sides: &[Picture; SIDES]) -> Vec<bool> {
    let width = up.width as usize;
    let count = up.rgb.len() / 3;
    let is_alike = |i: usize, other: usize| {
        let mut pictures = [up].into_iter().chain(sides);
        other >= count
            || pictures.all(|it| it.rgb[3 * i..3 * i + 3] == it.rgb[3 * other..3 * other + 3])
    };
    let beside = |i: usize| [i + 1, i.wrapping_sub(1), i + width, i.wrapping_sub(width)];
    let all = 0..count;
    all.map(|i| beside(i).into_iter().all(|other| is_alike(i, other)))
        .collect()
}

struct Estimate {
    shares: [f32; SIDES],
    color: Vec3,
}

impl Estimate {
    fn light(&self) -> Light {
        let [x, y, against_x, against_y, against_z] = self.shares;
        Light {
            along: Vec3::new(x, y, 1.0),
            against: Vec3::new(against_x, against_y, against_z),
            color: self.color,
        }
    }

    fn improve(
        &mut self,
        seen: &Picture,
        up: &Picture,
        sides: &[Picture; SIDES],
        is_flat: &[bool],
        usual: &[f32; SIDES],
    ) {
        let mut equations = LeastSquares::<SIDES>::default();
        let mut colors = [[0.0_f64; 2]; 3];
        for (i, seen) in seen.rgb.chunks_exact(3).enumerate() {
            if !is_flat[i] {
                continue;
            }
            let parts =
                |picture: &Picture| [0, 1, 2].map(|part| f32::from(picture.rgb[3 * i + part]));
            let up = parts(up);
            let own: [[f32; 3]; SIDES] = std::array::from_fn(|side| parts(&sides[side]));
            let white: [f32; 3] = std::array::from_fn(|part| {
                let sides = self.shares.iter().zip(&own);
                up[part] + sides.map(|(share, own)| share * own[part]).sum::<f32>()
            });
            if white == [0.0; 3] {
                continue;
            }
            let lit = [0, 1, 2].map(|part| (white[part] * self.color[part]).min(255.0));
            let square = square_of(seen, &lit.map(|part| (part + 0.5) as u8));
            let weight = OUTLIER / (square + OUTLIER);
            let weight = weight * weight;
            for part in 0..3 {
                let color = self.color[part];
                if seen[part] <= UNSATURATED && white[part] > 0.0 {
                    let (weight, white) = (f64::from(weight), f64::from(white[part]));
                    colors[part][0] += weight * white * f64::from(seen[part]);
                    colors[part][1] += weight * white * white;
                }
                let derivatives: [f32; SIDES] = std::array::from_fn(|side| own[side][part] * color);
                if derivatives != [0.0; SIDES] {
                    equations.add(&derivatives, f32::from(seen[part]) - lit[part], weight);
                }
            }
        }
        for side in 0..SIDES {
            let mut derivatives = [0.0; SIDES];
            derivatives[side] = 255.0;
            let difference = 255.0 * (usual[side] - self.shares[side]);
            equations.add(&derivatives, difference, USUAL);
        }
        let step = equations.step(0.0);
        for (share, by) in self.shares.iter_mut().zip(step) {
            *share = (*share + by as f32).clamp(0.0, 1.0);
        }
        for (part, [product, square]) in colors.into_iter().enumerate() {
            // Fewer than about ten bright pixels say nothing.
            if square > 10.0 * 100.0 * 100.0 {
                self.color[part] = ((product / square) as f32).clamp(0.05, BRIGHTEST);
            }
        }
    }
}
