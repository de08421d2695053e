//! Guesses of where an object is: from the pixels of its colour, by the rays through them.

use bevy::math::Vec2;
use tabletop_camera::{DrawnSolid, PictureWindow};

use crate::{
    known::{KnownObject, Stance, StandingPose, StandingSolid},
    refine::{COARSE, FINE, Refinement, RefinementStage},
    residual::{OUTLIER, Residual, TriedFit},
    segment::Blob,
    support::{DEEP, has_room},
};

/// Largest number of blobs, and of seeds in a blob.
const MOST_BLOBS: usize = 5;
const MOST_SEEDS: usize = 16;
/// Least number of pixels of a blob.
const LEAST_BLOB: usize = 4;
/// Distance of the heights that are tried, in units.
const HEIGHT_STEP: f32 = 0.6;
/// Angle between the yaws that are tried, in rad.
const YAW_STEP: f32 = 0.4;
/// Number of those that are refined more, if none explains enough.
const FINALISTS: usize = 2;
/// Number of heights near a free one that are tried.
const SUPPORTS: usize = 3;
/// The part of what it should explain by which an object in the air has to explain more than one that stands.
const HOVERING: f32 = 0.02;
/// Number of guesses that are refined for each seed.
const REFINED: usize = 5;

/// A placement that may be right.
#[derive(Clone, Debug)]
pub(crate) struct PoseCandidate {
    pub placement: StandingPose,
    /// The part that it explains of what it should: of the loss of the pixels that may show the object, and of its own.
    pub score: f32,
    /// The loss of a pixel that shows it, on average.
    pub misfit: f32,
    /// The window in which it may be seen.
    pub window: PictureWindow,
}

/// The search for an object.
pub(crate) struct Guess<'g, 'a, 'p> {
    pub residual: &'g mut Residual<'p>,
    pub object: &'a KnownObject,
    /// The part of what it should explain above which a guess is right.
    pub enough: f32,
    /// True if it may be in the air.
    pub may_hover: bool,
    /// The pixels that may show it, with their losses.
    pub blobs: Vec<(Blob, f32)>,
    /// The other objects' solids, and the windows in which they may be seen.
    pub others: Vec<(PictureWindow, Vec<DrawnSolid>)>,
    /// Where other objects are, and the heights of this one on and below each: objects often stand straight on each other.
    pub neighbours: Vec<(StandingPose, Vec<f32>)>,
    /// What other objects take up.
    pub taken: Vec<StandingSolid>,
    /// The heights, in units, of what it may stand on, from 0 on.
    pub heights: Vec<f32>,
}

/// A point of the picture about which an object may be seen.
struct Seed {
    pixel: Vec2,
    /// The loss of the pixels that it should explain.
    open: f32,
}

impl Seed {
    /// The part that an object explains of what it should.
    fn score(&self, trial: &TriedFit) -> f32 {
        -trial.gain / (self.open + trial.misfit).max(1.0)
    }
}

impl<'p> Guess<'_, '_, 'p> {
    /// About which part of the object's pixels is seen in one piece, at most 1.
    pub fn promise(&self) -> f32 {
        let width = self.residual.seen().width as usize;
        let parts = self.blobs.iter().take(MOST_BLOBS).map(|(blob, _)| {
            let expected = self.pixels_at(middle_of(&blob.pixels, width));
            blob.pixels.len() as f32 / expected.max(LEAST_BLOB as f32)
        });
        parts.fold(0.0, f32::max).min(1.0)
    }

    /// The best candidate for the object.
    pub fn best(&mut self) -> Option<PoseCandidate> {
        let seeds = self.seeds();
        let mut tried = Vec::new();
        for (i, seed) in seeds.iter().enumerate() {
            if self.keep_about(seed).is_some() {
                let own = [self.tried(seed), self.piled(seed)].into_iter().flatten();
                tried.extend(own.map(|(placement, trial)| (i, placement, seed.score(&trial))));
            }
        }
        tried.sort_by(|a, b| b.2.total_cmp(&a.2));
        let mut picked: Vec<(usize, StandingPose)> = Vec::new();
        for (i, placement, _) in tried {
            let differs = picked.iter().all(|(_, other)| {
                let radius = self.object.stance(&placement).radius;
                other.stance != placement.stance
                    || other.location.distance(placement.location) > 0.5 * radius
                    || (other.yaw - placement.yaw).abs() > 1.5 * YAW_STEP
            });
            // Each of the pixels' parts gets its turn, however well another explains its own.
            let is_first = || picked.iter().all(|(seed, _)| *seed != i);
            if differs && (picked.len() < REFINED || is_first()) {
                picked.push((i, placement));
            }
        }
        let mut found: Vec<(usize, StandingPose, TriedFit)> = Vec::new();
        for (i, placement) in picked {
            self.keep_about(&seeds[i]);
            let Some((placement, trial)) = self.supported(&placement, 1, &COARSE) else {
                continue;
            };
            if has_room(self.object, &placement, &self.taken, DEEP) {
                found.push((i, placement, trial));
                if seeds[i].score(&trial) > self.enough {
                    return self.candidate(&seeds[i], &placement, &trial);
                }
            }
        }
        let score = |found: &(usize, StandingPose, TriedFit)| seeds[found.0].score(&found.2);
        found.sort_by(|a, b| score(b).total_cmp(&score(a)));
        let mut finalists: Vec<(usize, StandingPose, TriedFit)> = Vec::new();
        for (rank, own) in found.into_iter().enumerate() {
            // What is in the air looks worse on every support.
            let is_first = || finalists.iter().all(|other| other.0 != own.0);
            if rank < FINALISTS || self.may_hover && is_first() {
                finalists.push(own);
            }
        }
        let mut best: Option<(usize, StandingPose, TriedFit)> = None;
        for (i, placement, _) in finalists {
            self.keep_about(&seeds[i]);
            let other = match self.heights.len() > 1 {
                true => self.at_other_height(&placement),
                false => None,
            };
            let same = self.supported(&placement, 1, &FINE);
            let standing = other
                .into_iter()
                .chain(same)
                .map(|(at, trial)| (at, trial, 0.0));
            let hovering = self.may_hover.then(|| self.hovering(&placement));
            let all = standing.chain(hovering.map(|(at, trial)| (at, trial, HOVERING)));
            for (placement, trial, least) in all.collect::<Vec<_>>() {
                let own = (i, placement, trial);
                let is_better = best
                    .as_ref()
                    .is_none_or(|best| score(&own) > score(best) + least);
                if is_better && has_room(self.object, &placement, &self.taken, DEEP) {
                    best = Some(own);
                }
            }
        }
        let (i, placement, trial) = best?;
        self.candidate(&seeds[i], &placement, &trial)
    }

    /// The best placement near one at any height.
    fn hovering(&mut self, placement: &StandingPose) -> (StandingPose, TriedFit) {
        let mut refinement = self.refinement();
        let (free, _) = refinement.refined(*placement, &COARSE);
        refinement.refined(free, &FINE)
    }

    fn at_other_height(&mut self, placement: &StandingPose) -> Option<(StandingPose, TriedFit)> {
        let (free, _) = self.refinement().refined(*placement, &COARSE);
        self.supported(&free, SUPPORTS, &FINE)
    }

    fn candidate(
        &self,
        seed: &Seed,
        placement: &StandingPose,
        trial: &TriedFit,
    ) -> Option<PoseCandidate> {
        let window = self.window_at(placement)?;
        (trial.gain < 0.0).then(|| PoseCandidate {
            placement: *placement,
            score: seed.score(trial),
            misfit: trial.misfit / trial.pixels.max(1) as f32,
            window,
        })
    }

    fn highest(&self) -> f32 {
        self.heights.last().copied().unwrap_or(0.0)
    }

    fn seeds(&mut self) -> Vec<Seed> {
        let width = self.residual.seen().width as usize;
        let blobs = std::mem::take(&mut self.blobs);
        let mut seeds = Vec::new();
        for (blob, open) in blobs.iter().take(MOST_BLOBS) {
            if blob.pixels.len() < LEAST_BLOB {
                continue;
            }
            let middle = middle_of(&blob.pixels, width);
            let expected = self.pixels_at(middle).max(LEAST_BLOB as f32);
            seeds.push(Seed {
                pixel: middle,
                open: *open,
            });
            if (blob.pixels.len() as f32) < 0.8 * expected {
                // What hides a part of it is mostly above it.
                let rows = blob.pixels.iter().map(|pixel| pixel / width);
                let bottom = rows.max().unwrap_or(0) as f32;
                seeds.push(Seed {
                    pixel: Vec2::new(middle.x, bottom - self.rows_at(middle) / 2.0),
                    open: *open,
                });
            }
            if blob.pixels.len() as f32 > 1.4 * expected {
                let spacing = (0.6 * expected.sqrt()).max(2.0) as usize;
                let parts = parts_of(&blob.pixels, width, spacing);
                seeds.extend(
                    parts
                        .into_iter()
                        .take(MOST_SEEDS)
                        .map(|pixel| Seed { pixel, open: *open }),
                );
            }
        }
        // An object behind another one shows in several places.
        if blobs.len() > 1 {
            let pixels: Vec<_> = blobs
                .iter()
                .flat_map(|(blob, _)| blob.pixels.iter().copied())
                .collect();
            seeds.push(Seed {
                pixel: middle_of(&pixels, width),
                open: blobs.iter().map(|(_, open)| open).sum(),
            });
        }
        seeds
    }

    /// About how many pixels show the object if it is seen about this one.
    fn pixels_at(&self, pixel: Vec2) -> f32 {
        let solids = self.solids(&self.at(pixel, 0, 0.0, 0.0));
        let window = self.residual.drawn_window_of(&solids);
        window.map_or(0.0, |window| 0.6 * window.area() as f32)
    }

    /// The number of rows in which the object is seen there.
    fn rows_at(&self, pixel: Vec2) -> f32 {
        let solids = self.solids(&self.at(pixel, 0, 0.0, 0.0));
        let window = self.residual.drawn_window_of(&solids);
        window.map_or(0.0, |window| window.rows.len() as f32)
    }

    /// The placement whose middle is seen at a pixel, with its lowest point at this height.
    fn at(&self, pixel: Vec2, stance: usize, height: f32, yaw: f32) -> StandingPose {
        let own = &self.object.stances()[stance];
        let middle = height + (own.high - own.low) / 2.0;
        let (eye, ray) = (self.residual.eye(), self.residual.camera.ray_through(pixel));
        let down = if ray.z < -1e-3 { -ray.z } else { 1e-3 };
        let location = eye + ray * ((eye.z - middle) / down).clamp(0.0, 1e3);
        StandingPose {
            yaw,
            stance,
            ..StandingPose::at(location.truncate().extend(height - own.low))
        }
    }

    fn solids(&self, placement: &StandingPose) -> Vec<DrawnSolid> {
        let mut solids = Vec::new();
        self.object.draw(placement, 1, &mut solids);
        solids
    }

    fn window_at(&self, placement: &StandingPose) -> Option<PictureWindow> {
        self.residual.window_of(&self.solids(placement))
    }

    /// Keeps all other objects, where this one may be.
    fn keep_about(&mut self, seed: &Seed) -> Option<()> {
        let windows = (0..self.object.stances().len())
            .flat_map(|stance| [0.0, self.highest()].map(|height| (stance, height)))
            .filter_map(|(stance, height)| {
                self.window_at(&self.at(seed.pixel, stance, height, 0.4))
            });
        let around = windows.reduce(|one, other| one.joined(&other))?;
        let around = around.widened(10, self.residual.size());
        let others = self.others.iter();
        let near = others.filter(|(window, _)| !window.intersection(&around).is_empty());
        let solids: Vec<_> = near
            .flat_map(|(_, solids)| solids.iter().cloned())
            .collect();
        self.residual.keep(&solids, &around);
        Some(())
    }

    /// Placements about a seed: first on the table with all yaws, then with the best of these at other heights.
    fn tried(&mut self, seed: &Seed) -> Vec<(StandingPose, TriedFit)> {
        let mut tried = Vec::new();
        for stance in 0..self.object.stances().len() {
            let mut on_table: Vec<_> = turns(&self.object.stances()[stance])
                .map(|yaw| {
                    let placement = self.at(seed.pixel, stance, 0.0, yaw);
                    (placement, self.trial(&placement))
                })
                .collect();
            on_table.sort_by(|a, b| a.1.gain.total_cmp(&b.1.gain));
            let best: Vec<_> = on_table.iter().take(2).map(|(it, _)| it.yaw).collect();
            tried.append(&mut on_table);
            let mut height = HEIGHT_STEP;
            while height < self.highest() + HEIGHT_STEP / 2.0 {
                for &yaw in &best {
                    let placement = self.at(seed.pixel, stance, height, yaw);
                    tried.push((placement, self.trial(&placement)));
                }
                height += HEIGHT_STEP;
            }
        }
        tried
    }

    /// Placements straight above or below other objects that are seen about a seed.
    fn piled(&mut self, seed: &Seed) -> Vec<(StandingPose, TriedFit)> {
        /// Largest distance of the other object, in radii of this one.
        const NEAR: f32 = 3.0;
        let own = &self.object.stances()[0];
        let (low, radius, symmetry) = (own.low, own.radius, own.symmetry);
        let turns = turns(own);
        let mut tried = Vec::new();
        for (neighbour, heights) in self.neighbours.clone() {
            for height in heights {
                let location = neighbour.location.truncate().extend(height - low);
                let about = self.at(seed.pixel, 0, height, 0.0);
                if about.location.distance(location) >= NEAR * radius {
                    continue;
                }
                for turn in turns.clone() {
                    let placement = StandingPose {
                        yaw: symmetry.reduced(neighbour.yaw + turn),
                        ..StandingPose::at(location)
                    };
                    if has_room(self.object, &placement, &self.taken, DEEP) {
                        tried.push((placement, self.trial(&placement)));
                    }
                }
            }
        }
        tried
    }

    fn refinement(&mut self) -> Refinement<'_, 'p> {
        Refinement {
            residual: self.residual,
            object: self.object,
            is_free: !self.object.is_fixed(),
        }
    }

    fn trial(&mut self, placement: &StandingPose) -> TriedFit {
        self.refinement().try_at(placement, OUTLIER)
    }
}

impl Guess<'_, '_, '_> {
    /// The best placement near one among those at the heights at which the object may stand.
    fn supported(
        &mut self,
        free: &StandingPose,
        count: usize,
        stages: &[RefinementStage],
    ) -> Option<(StandingPose, TriedFit)> {
        let low = self.object.stance(free).low;
        let mut heights: Vec<_> = self.heights.iter().map(|height| height - low).collect();
        let distance = |height: &f32| (height - free.location.z).abs();
        heights.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
        let eye = self.residual.eye();
        let mut refinement = Refinement {
            residual: self.residual,
            object: self.object,
            is_free: false,
        };
        let near = heights.into_iter().take(count);
        let refined = near.map(|height| refinement.refined(free.at_height(height, eye), stages));
        refined.min_by(|a, b| a.1.gain.total_cmp(&b.1.gain))
    }
}

/// Turns about the vertical, in rad, after which an object looks different.
fn turns(stance: &Stance) -> impl Iterator<Item = f32> + Clone + use<> {
    let period = stance.symmetry.period();
    let count = period.map_or(1, |period| (period / YAW_STEP).ceil() as usize);
    let step = period.unwrap_or(0.0) / count as f32;
    (0..count).map(move |i| i as f32 * step)
}

fn middle_of(pixels: &[usize], width: usize) -> Vec2 {
    let sum: Vec2 = pixels
        .iter()
        .map(|pixel| Vec2::new((pixel % width) as f32, (pixel / width) as f32))
        .sum();
    sum / pixels.len().max(1) as f32
}

/// The middles of the parts of a blob in the cells of a grid, fullest first.
fn parts_of(pixels: &[usize], width: usize, spacing: usize) -> Vec<Vec2> {
    let mut cells = std::collections::BTreeMap::<(usize, usize), Vec<usize>>::new();
    for &pixel in pixels {
        let cell = (pixel / width / spacing, pixel % width / spacing);
        cells.entry(cell).or_default().push(pixel);
    }
    let mut cells: Vec<_> = cells.into_values().collect();
    cells.sort_by_key(|cell| std::cmp::Reverse(cell.len()));
    cells.iter().map(|cell| middle_of(cell, width)).collect()
}
