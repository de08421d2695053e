//! Refinement of a placement by least squares on differences of pixels (Levenberg and Marquardt's), with derivatives from pictures a small step
//! away to both sides: smooth edges make that exact to a small part of a pixel.

use bevy::math::Vec3;
use tabletop_camera::{DrawnSolid, PictureWindow};
use tabletop_core::Picture;

use crate::{
    known::{KnownObject, StandingPose},
    normal::LeastSquares,
    pixels::rows,
    residual::{OUTLIER, Residual, TRIED, TriedFit, square_of},
    symmetry::YawSymmetry,
};

/// The parameters: along X and Y, along the ray from the eye, and about the vertical.
const PARAMETERS: usize = 4;
pub(crate) type PoseEquations = LeastSquares<PARAMETERS>;

/// A stage of a refinement.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RefinementStage {
    /// Step of the derivatives, in units.
    step: f32,
    /// True if it goes to both sides.
    is_central: bool,
    outlier: f32,
    /// Largest number of steps.
    most: u32,
}

/// Damping of steps, as a part of the curvature.
const DAMPING: f64 = 1e-3;

/// From a rough guess, some pixels off. A pixel is about 0.1 units.
pub(crate) const COARSE: [RefinementStage; 2] = [
    RefinementStage {
        step: 0.2,
        is_central: false,
        outlier: 300_000.0,
        most: 5,
    },
    RefinementStage {
        step: 0.08,
        is_central: true,
        outlier: 60_000.0,
        most: 4,
    },
];

/// From a guess less than a pixel off.
pub(crate) const FINE: [RefinementStage; 2] = [
    RefinementStage {
        step: 0.06,
        is_central: true,
        outlier: 3.0 * OUTLIER,
        most: 4,
    },
    RefinementStage {
        step: 0.02,
        is_central: true,
        outlier: OUTLIER,
        most: 4,
    },
];

/// From where the object was in the last picture.
pub(crate) const TRACKING: [RefinementStage; 4] = [COARSE[0], COARSE[1], FINE[0], FINE[1]];

/// An object that is moved over what is kept.
pub(crate) struct Refinement<'a, 'p> {
    pub residual: &'a mut Residual<'p>,
    pub object: &'a KnownObject,
    /// True if its height is estimated, too.
    pub is_free: bool,
}

impl Refinement<'_, '_> {
    /// The solids of the object at a placement.
    fn solids(&self, placement: &StandingPose) -> Vec<DrawnSolid> {
        let mut solids = Vec::new();
        self.object.draw(placement, TRIED, &mut solids);
        solids
    }

    /// Tries a placement.
    pub fn try_at(&mut self, placement: &StandingPose, outlier: f32) -> TriedFit {
        let solids = self.solids(placement);
        self.residual.try_solids(&solids, outlier)
    }

    /// The best placement near one.
    pub fn refined(
        &mut self,
        mut placement: StandingPose,
        stages: &[RefinementStage],
    ) -> (StandingPose, TriedFit) {
        for stage in stages {
            let mut best = self.try_at(&placement, stage.outlier).gain;
            for _ in 0..stage.most {
                let equations =
                    self.equations(&placement, stage.step, stage.is_central, stage.outlier);
                let step = equations.step(DAMPING);
                let mut part_of_step = |part: f64| {
                    let next = self.stepped(&placement, &step.map(|by| by * part), stage.step);
                    (next, self.try_at(&next, stage.outlier).gain)
                };
                let mut better = None;
                for part in [1.0, 0.4, 0.15] {
                    let (next, gain) = part_of_step(part);
                    if gain < best {
                        better = Some((next, gain));
                        break;
                    }
                }
                if let Some((_, gain)) = better {
                    // Outliers weigh little, so steps are rather too short.
                    let farther = part_of_step(2.5);
                    if farther.1 < gain {
                        better = Some(farther);
                    }
                }
                let Some((next, gain)) = better else {
                    break;
                };
                let moved = next.location.distance(placement.location)
                    + (next.yaw - placement.yaw).abs() * self.object.stance(&placement).radius;
                (placement, best) = (next, gain);
                if moved < 0.02 * stage.step {
                    break;
                }
            }
        }
        let stance = self.object.stance(&placement);
        placement.yaw = stance.symmetry.reduced(placement.yaw);
        let trial = self.try_at(&placement, OUTLIER);
        (placement, trial)
    }

    /// The best of the placements that are refined from near one: out of a local minimum.
    pub fn shaken(&mut self, placement: StandingPose) -> (StandingPose, TriedFit) {
        /// The displacement, in units.
        const SHAKEN: f32 = 0.08;
        let mut best = (placement, self.try_at(&placement, OUTLIER));
        for parameter in self.parameters(&placement) {
            for side in [-SHAKEN, SHAKEN] {
                let start = self.moved(&placement, parameter, side);
                let refined = self.refined(start, &FINE);
                if refined.1.gain < best.1.gain {
                    best = refined;
                }
            }
        }
        best
    }

    /// Steps along axes and about the vertical, smaller and smaller, as long as they reduce the loss: what derivatives over finite steps leave.
    pub fn polished(
        &mut self,
        mut placement: StandingPose,
        largest: f32,
    ) -> (StandingPose, TriedFit) {
        /// The smallest step, in units.
        const LEAST: f32 = 0.000_4;
        let mut best = self.try_at(&placement, OUTLIER);
        let mut size = largest;
        while size > LEAST {
            let mut is_better = false;
            for parameter in self.parameters(&placement) {
                for side in [-1.0, 1.0] {
                    let next = self.moved(&placement, parameter, side * size);
                    let trial = self.try_at(&next, OUTLIER);
                    if trial.gain < best.gain {
                        (placement, best, is_better) = (next, trial, true);
                        break;
                    }
                }
            }
            if !is_better {
                size *= 0.5;
            }
        }
        let stance = self.object.stance(&placement);
        placement.yaw = stance.symmetry.reduced(placement.yaw);
        (placement, best)
    }

    /// The normal equations at a placement, with derivatives over a step to both sides, or to one only.
    pub fn equations(
        &mut self,
        placement: &StandingPose,
        step: f32,
        is_central: bool,
        outlier: f32,
    ) -> PoseEquations {
        let mut equations = PoseEquations::default();
        let solids = self.solids(placement);
        let Some(window) = self.residual.window_of(&solids) else {
            return equations;
        };
        let margin = (step * PIXELS_PER_UNIT) as u32 + 1;
        let window = window.widened(margin, self.residual.size());
        let width = self.residual.seen().width;
        let here = drawn_in(self.residual.draw(&solids, &window), &window);
        let mut derivatives = vec![[0.0_f32; PARAMETERS]; here.len()];
        for parameter in self.parameters(placement) {
            let mut add = |side: f32, factor: f32| {
                let solids = self.solids(&self.moved(placement, parameter, side * step));
                let drawn = self.residual.draw(&solids, &window);
                let (mut own, mut here) = (derivatives.iter_mut(), here.iter());
                for row in rows(&window, width) {
                    let parts = &drawn.rgb[3 * row.start..3 * row.end];
                    for ((part, derivative), here) in parts.iter().zip(&mut own).zip(&mut here) {
                        let change = f32::from(*part) - f32::from(*here);
                        derivative[parameter] += change * factor;
                    }
                }
            };
            if is_central {
                add(1.0, 0.5 / step);
                add(-1.0, -0.5 / step);
            } else {
                add(1.0, 1.0 / step);
            }
        }
        let seen = self.residual.seen();
        let (mut own, mut here) = (derivatives.chunks_exact(3), here.chunks_exact(3));
        for row in rows(&window, width) {
            let seen = seen.rgb[3 * row.start..3 * row.end].chunks_exact(3);
            for ((seen, here), derivatives) in seen.zip(&mut here).zip(&mut own) {
                if derivatives.iter().all(|own| *own == [0.0; PARAMETERS]) {
                    continue;
                }
                let weight = outlier / (square_of(seen, here) + outlier);
                for (part, derivatives) in derivatives.iter().enumerate() {
                    let difference = f32::from(seen[part]) - f32::from(here[part]);
                    equations.add(derivatives, difference, weight * weight);
                }
            }
        }
        equations
    }

    /// The parameters that are estimated.
    fn parameters(&self, placement: &StandingPose) -> impl Iterator<Item = usize> + use<> {
        let is_free = self.is_free;
        let is_round = self.object.stance(placement).symmetry == YawSymmetry::Any;
        (0..PARAMETERS).filter(move |&parameter| match parameter {
            2 => is_free,
            3 => !is_round,
            _ => true,
        })
    }

    /// The placement after a change of one parameter that moves the object by about this length.
    fn moved(&self, placement: &StandingPose, parameter: usize, by: f32) -> StandingPose {
        let mut change = [0.0; PARAMETERS];
        change[parameter] = by;
        self.changed(placement, &change)
    }

    /// The placement after a change of all parameters, as lengths.
    fn changed(&self, placement: &StandingPose, by: &[f32; PARAMETERS]) -> StandingPose {
        let ray = (placement.location - self.residual.eye()).normalize_or(Vec3::NEG_Z);
        let radius = self.object.stance(placement).radius;
        StandingPose {
            location: placement.location + Vec3::new(by[0], by[1], 0.0) + ray * by[2] * ALONG_RAY,
            yaw: placement.yaw + by[3] / radius,
            ..*placement
        }
    }

    /// The placement after a step of all parameters, none longer than a few of the derivatives' steps.
    fn stepped(
        &self,
        placement: &StandingPose,
        step: &[f64; PARAMETERS],
        size: f32,
    ) -> StandingPose {
        let most = 3.0 * size;
        self.changed(placement, &step.map(|by| (by as f32).clamp(-most, most)))
    }
}

/// About how many pixels show a unit.
const PIXELS_PER_UNIT: f32 = 10.0;

/// The colours in a window of a picture, row by row.
fn drawn_in(drawn: &Picture, window: &PictureWindow) -> Vec<u8> {
    let mut colors = Vec::with_capacity(3 * window.area());
    for row in rows(window, drawn.width) {
        colors.extend_from_slice(&drawn.rgb[3 * row.start..3 * row.end]);
    }
    colors
}

/// Motion along the ray, in units, that changes the picture about as much as a unit across it: distances are about ten times an object's size.
const ALONG_RAY: f32 = 5.0;

/// Standard deviations of X, Y, Z in units and of yaw in rad, from the equations at a placement and the variance of a pixel.
pub(crate) fn deviations(
    equations: &PoseEquations,
    variance: f32,
    ray: Vec3,
    radius: f32,
) -> [f32; PARAMETERS] {
    let [x, y, along, yaw] = equations.variances().map(|it| (it as f32) * variance);
    let along = along * ALONG_RAY * ALONG_RAY;
    let part = |axis: f32| {
        if along.is_finite() {
            axis * axis * along
        } else {
            0.0
        }
    };
    [
        (x + part(ray.x)).sqrt(),
        (y + part(ray.y)).sqrt(),
        part(ray.z).sqrt(),
        if yaw.is_finite() {
            yaw.sqrt() / radius
        } else {
            0.0
        },
    ]
}
