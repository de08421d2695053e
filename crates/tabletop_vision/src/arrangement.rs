//! The arrangement of all objects that explains a picture best: found object by object, best explained first, and then settled together.

use bevy::math::Vec3;
use tabletop_camera::{DrawnSolid, PictureWindow};

use crate::{
    guess::{Guess, PoseCandidate},
    known::{KnownObject, StandingPose},
    refine::{FINE, Refinement, RefinementStage, TRACKING},
    residual::{OUTLIER, Residual, TriedFit, loss, rows},
    segment::{Blob, NO_COLOR, Palette, blobs},
    support,
};

/// The part of what an object should explain that it has to explain at least.
const LEAST_SCORE: f32 = 0.12;
/// Squared difference of a pixel above which it is not explained, without noise.
const UNEXPLAINED: f32 = 600.0;
/// The loss that a support may add, as a part of what the object explains, where it was not known before, and where it was.
const SUPPORTED: f32 = 0.05;
/// The same, when everything else is about in its place.
const FINALLY_SUPPORTED: f32 = 0.3;
const STILL_SUPPORTED: f32 = 0.003;
/// The loss of a pixel, on average, above which an object is explained badly, without noise.
const BAD: f32 = 400.0;
/// The largest height, in units, on which objects that nothing is known about are looked for.
const HIGHEST: f32 = 4.0;
/// The part of what it should explain above which an object is placed without a look at other places, at first and when that was not good.
const GOOD_SCORE: f32 = 0.85;
const THOROUGH: f32 = 0.98;
/// The loss of a pixel, on average, below which an object is explained well, without noise.
const GOOD: f32 = 25.0;
/// Largest number of attempts to find a better arrangement.
const ATTEMPTS: usize = 4;

/// The placements of all objects, compared with a picture.
pub(crate) struct ObjectArrangement<'a, 'p> {
    pub objects: &'a [KnownObject],
    pub residual: Residual<'p>,
    /// The placement of each object, if it is known, and the window in which it may be seen.
    pub placements: Vec<Option<StandingPose>>,
    windows: Vec<Option<PictureWindow>>,
    /// The known colour that each pixel shows, and that of each object.
    classes: Vec<u8>,
    colors: Vec<u8>,
    /// Squared difference of each pixel from the arrangement.
    squares: Vec<f32>,
    /// Variance of a part of a pixel.
    pub noise: f32,
    /// The loss that a support may add, as a part of what the object explains: else it is in the air.
    allowance: f32,
    /// The part of what it should explain above which an object is placed without a look at other places.
    enough: f32,
}

/// The placements, to come back to.
#[derive(Clone)]
struct Remembered {
    placements: Vec<Option<StandingPose>>,
    loss: f64,
}

impl<'a, 'p> ObjectArrangement<'a, 'p> {
    /// Without any object.
    pub fn empty(objects: &'a [KnownObject], residual: Residual<'p>) -> Self {
        let palette = Palette::of(objects.iter().flat_map(KnownObject::colors));
        let classes = palette.classes(residual.seen(), residual.camera.light.color);
        let colors = objects.iter().map(|it| palette.number(it.color()));
        let mut arrangement = Self {
            objects,
            placements: vec![None; objects.len()],
            windows: vec![None; objects.len()],
            classes,
            colors: colors.collect(),
            squares: vec![0.0; residual.seen().depth.len()],
            noise: 0.0,
            allowance: SUPPORTED,
            enough: GOOD_SCORE,
            residual,
        };
        arrangement.compare(&arrangement.residual.whole());
        arrangement.noise = arrangement.residual.variance();
        arrangement
    }

    /// Squared difference of a pixel above which it is not explained.
    pub fn unexplained(&self) -> f32 {
        // One pixel of a thousand is noisier (chi-squared, three degrees of freedom).
        UNEXPLAINED.max(16.3 * self.noise)
    }

    pub fn square(&self, pixel: usize) -> f32 {
        self.squares[pixel]
    }

    /// The solids of the placed objects that may be seen in a window, but for one.
    pub fn others(&self, but: Option<usize>, window: &PictureWindow) -> Vec<DrawnSolid> {
        let mut solids = Vec::new();
        for (i, placement) in self.placements.iter().enumerate() {
            let (Some(placement), Some(own)) = (placement, &self.windows[i]) else {
                continue;
            };
            if but != Some(i) && !own.intersection(window).is_empty() {
                self.objects[i].draw(placement, i as u32 + 1, &mut solids);
            }
        }
        solids
    }

    /// Compares the arrangement with the picture in a window.
    pub fn compare(&mut self, window: &PictureWindow) {
        let solids = self.others(None, window);
        self.residual.keep(&solids, window);
        for row in rows(window, self.residual.seen().width) {
            self.squares[row.clone()].copy_from_slice(&self.residual.squares()[row]);
        }
    }

    /// Keeps everything but one object, within a window.
    pub fn keep_others(&mut self, object: usize, window: &PictureWindow) {
        let solids = self.others(Some(object), window);
        self.residual.keep(&solids, window);
    }

    pub fn window_at(&self, object: usize, placement: &StandingPose) -> Option<PictureWindow> {
        let mut solids = Vec::new();
        self.objects[object].draw(placement, 1, &mut solids);
        let window = self.residual.window_of(&solids)?;
        Some(window.widened(1, self.residual.size()))
    }

    /// Places an object, or takes it away.
    pub fn place(&mut self, object: usize, placement: Option<StandingPose>) {
        let before = self.windows[object].take();
        self.placements[object] = placement;
        let now = placement.and_then(|placement| self.window_at(object, &placement));
        self.windows[object].clone_from(&now);
        for window in before.into_iter().chain(now) {
            self.compare(&window);
        }
    }

    pub fn window(&self, object: usize) -> Option<&PictureWindow> {
        self.windows[object].as_ref()
    }

    /// The loss of the whole picture.
    pub fn loss(&self) -> f64 {
        let losses = self.squares.iter().map(|&it| f64::from(loss(it, OUTLIER)));
        losses.sum()
    }

    /// The connected pixels that may show an object, and that nothing explains.
    pub fn open_blobs(&self, object: usize) -> Vec<Blob> {
        let (color, least) = (self.colors[object], self.unexplained());
        if color == NO_COLOR {
            return Vec::new();
        }
        let [width, height] = self.residual.size().map(|side| side as usize);
        blobs(width, height, |i| {
            self.classes[i] == color && self.squares[i] > least
        })
    }

    /// Finds all objects, if it is known of none where it was before; else follows those.
    pub fn begin(&mut self, before: &[Option<StandingPose>]) {
        if before.iter().all(Option::is_none) {
            self.arrange(&mut || 1.0);
        } else {
            self.follow(before);
        }
    }

    /// Begins with objects where they were found in another light.
    pub fn begin_again(&mut self, found: &[Option<StandingPose>]) {
        for (i, placement) in found.iter().enumerate() {
            self.place(i, *placement);
        }
        self.arrange(&mut || 1.0);
    }

    /// The solids of all objects.
    pub fn solids(&self) -> Vec<DrawnSolid> {
        self.others(None, &self.residual.whole())
    }

    /// Begins with objects where they were, follows those that have moved, and finds those that are elsewhere.
    fn follow(&mut self, before: &[Option<StandingPose>]) {
        self.allowance = STILL_SUPPORTED;
        for (i, placement) in before.iter().enumerate() {
            self.place(i, *placement);
        }
        let good = self.good();
        for i in 0..self.objects.len() {
            let fit = self.fit(i);
            if fit.misfit > good * fit.pixels as f32 {
                self.settle(i, &TRACKING, true);
            }
        }
        let lost: Vec<_> = (0..self.objects.len())
            .filter(|&i| self.is_bad(i))
            .collect();
        for &i in &lost {
            self.place(i, None);
        }
        if self.placements.contains(&None) {
            self.arrange(&mut || 1.0);
        }
    }

    /// Finds all objects without a placement, and settles all.
    fn arrange(&mut self, chance: &mut impl FnMut() -> f32) {
        self.find_all(chance);
        self.settle_all(1, false);
        if self.placements.contains(&None) {
            // There may be more room for them now.
            self.find_all(chance);
            self.settle_all(1, false);
        }
        if self.allowance == SUPPORTED {
            self.allowance = FINALLY_SUPPORTED;
            self.settle_all(2, true);
            self.allowance = SUPPORTED;
        } else {
            self.settle_all(2, true);
        }
    }

    /// Finds all objects without a placement, the one that explains most of its pixels first.
    fn find_all(&mut self, chance: &mut impl FnMut() -> f32) {
        let mut candidates: Vec<Option<Option<PoseCandidate>>> = vec![None; self.objects.len()];
        while let Some((object, placement)) = self.next_found(&mut candidates, chance) {
            self.place(object, Some(placement));
            let window = self.windows[object].clone().unwrap_or_default();
            let wide = window.widened(4, self.residual.size());
            for (i, candidate) in candidates.iter_mut().enumerate() {
                let is_stale = candidate.as_ref().is_some_and(|candidate| {
                    self.colors[i] == self.colors[object]
                        || candidate.as_ref().is_none_or(|candidate| {
                            !candidate.window.intersection(&wide).is_empty()
                        })
                });
                if is_stale {
                    *candidate = None;
                }
            }
        }
    }

    /// The object to be placed next: the first one that is well explained, beginning with those of which most is seen; else the best.
    fn next_found(
        &mut self,
        candidates: &mut [Option<Option<PoseCandidate>>],
        chance: &mut impl FnMut() -> f32,
    ) -> Option<(usize, StandingPose)> {
        let open = (0..self.objects.len()).filter(|&i| {
            // Of objects that look the same, the first one is looked for.
            let is_alike = |j: usize| self.objects[j] == self.objects[i];
            self.placements[i].is_none()
                && !(0..i).any(|j| self.placements[j].is_none() && is_alike(j))
        });
        let open: Vec<_> = open.collect();
        let mut order: Vec<_> = open
            .into_iter()
            .filter_map(|i| Some((i, self.guess(i)?.promise() * chance())))
            .collect();
        order.sort_by(|a, b| b.1.total_cmp(&a.1));
        let mut best: Option<(usize, StandingPose, f32)> = None;
        for (i, _) in order {
            if candidates[i].is_none() {
                candidates[i] = Some(self.guess(i).and_then(|mut guess| guess.best()));
            }
            let Some(candidate) = candidates[i].as_ref().and_then(Option::as_ref) else {
                continue;
            };
            if candidate.score > self.enough {
                return Some((i, candidate.placement));
            }
            let score = candidate.score * chance();
            if score > LEAST_SCORE && best.is_none_or(|best| score > best.2) {
                best = Some((i, candidate.placement, score));
            }
        }
        best.map(|(object, placement, _)| (object, placement))
    }

    /// The search for an object among those that are placed; `None` if no pixel may show it.
    fn guess(&mut self, object: usize) -> Option<Guess<'_, 'a, 'p>> {
        let blobs = self.open_blobs(object).into_iter().map(|blob| {
            let losses = blob.pixels.iter().map(|&i| loss(self.squares[i], OUTLIER));
            let open = losses.sum();
            (blob, open)
        });
        let blobs: Vec<_> = blobs.collect();
        if blobs.is_empty() {
            return None;
        }
        let others = (0..self.objects.len()).filter(|&i| i != object);
        let placed = others.clone().filter_map(|i| {
            let (placement, window) = (self.placements[i]?, self.windows[i].clone()?);
            let mut solids = Vec::new();
            self.objects[i].draw(&placement, i as u32 + 1, &mut solids);
            Some((window, solids))
        });
        let taken = others.clone().filter_map(|i| {
            let placement = self.placements[i]?;
            Some(self.objects[i].touched(&placement))
        });
        let taken = taken.flatten();
        let known = &self.objects[object];
        let own_seats = known.seats();
        let neighbours = others.clone().filter_map(|i| {
            let placement = self.placements[i]?;
            let foot = placement.location.z + self.objects[i].stance(&placement).low;
            let above = self.objects[i].seats().into_iter().map(|seat| foot + seat);
            let below = own_seats.iter().map(|seat| foot - seat);
            let heights = above.chain(below).filter(|height| *height > -0.05);
            Some((placement, heights.map(|height| height.max(0.0)).collect()))
        });
        Some(Guess {
            enough: self.enough,
            others: placed.collect(),
            neighbours: match known.is_fixed() {
                true => Vec::new(),
                false => neighbours.collect(),
            },
            taken: taken.collect(),
            heights: match known.is_fixed() {
                true => vec![0.0],
                false => support::pile_heights(others.map(|i| &self.objects[i]), HIGHEST),
            },
            residual: &mut self.residual,
            object: known,
            blobs,
        })
    }

    /// Refines an object among the others: on what it stands on, or in the air. Returns by how much, in units, it moved.
    fn settle(&mut self, object: usize, stages: &[RefinementStage], is_last: bool) -> f32 {
        let Some(before) = self.placements[object] else {
            return 0.0;
        };
        let Some(window) = self.window_at(object, &before) else {
            return 0.0;
        };
        self.keep_others(object, &window.widened(6, self.residual.size()));
        let known = &self.objects[object];
        let eye = self.residual.eye();
        let good = self.good();
        let mut refinement = Refinement {
            residual: &mut self.residual,
            object: known,
            is_free: !known.is_fixed(),
        };
        let others = (self.objects.iter().zip(&self.placements).enumerate())
            .filter(|(i, _)| *i != object)
            .filter_map(|(_, (other, placement))| Some((other, placement.as_ref()?)));
        refinement.is_free = false;
        let (mut settled, trial) = refinement.refined(before, stages);
        let heights = support::heights(known, &settled, others.clone());
        let stands = heights
            .iter()
            .any(|height| (height - settled.location.z).abs() < 1e-3);
        if !known.is_fixed() && (!stands || trial.misfit > good * trial.pixels as f32) {
            let here = settled;
            refinement.is_free = true;
            let (free, free_trial) = refinement.refined(here, &FINE);
            refinement.is_free = false;
            let mut heights = support::heights(known, &free, others);
            heights.sort_by(|a, b| {
                let [a, b] = [a, b].map(|height| (height - free.location.z).abs());
                a.total_cmp(&b)
            });
            let near = heights.into_iter().take(3);
            let standing =
                near.map(|height| refinement.refined(free.at_height(height, eye), &FINE));
            let best = standing.min_by(|a, b| a.1.gain.total_cmp(&b.1.gain));
            // What it stands on may not be in its place yet.
            let (hovering, gain) = match !is_last
                && trial.gain < free_trial.gain + self.allowance * trial.gain.abs()
            {
                true => (here, trial.gain),
                false => (free, free_trial.gain),
            };
            let allowance = self.allowance * gain.abs() + 20.0 * self.noise.max(1.0);
            settled = match best {
                Some((placement, standing)) if standing.gain <= gain + allowance => placement,
                _ => {
                    refinement.is_free = true;
                    hovering
                }
            };
        }
        if is_last {
            let trial = refinement.try_at(&settled, OUTLIER);
            let is_good = trial.misfit <= good * trial.pixels as f32;
            if !is_good {
                settled = refinement.shaken(settled).0;
            }
            settled = refinement.polished(settled, 0.004).0;
        }
        self.place(object, Some(settled));
        settled.location.distance(before.location) + (settled.yaw - before.yaw).abs()
    }

    /// Settles all objects, in turn.
    fn settle_all(&mut self, rounds: usize, is_end: bool) {
        let mut has_moved = vec![true; self.objects.len()];
        for round in 0..rounds {
            let is_last = is_end && round + 1 == rounds;
            // What stands on others comes after them.
            let mut order: Vec<_> = (0..self.objects.len()).collect();
            let lowest = |i: usize| {
                let placement = self.placements[i]?;
                Some(placement.location.z + self.objects[i].stance(&placement).low)
            };
            let height = |i: usize| lowest(i).unwrap_or(f32::INFINITY);
            order.sort_by(|&a, &b| height(a).total_cmp(&height(b)));
            for i in order {
                let is_touched = (0..self.objects.len()).any(|j| {
                    let near = self.windows[i].as_ref().zip(self.windows[j].as_ref());
                    has_moved[j]
                        && near.is_some_and(|(own, other)| !own.intersection(other).is_empty())
                });
                if is_touched || is_last {
                    let stages = match (is_end, round) {
                        (false, _) => &FINE[..1],
                        (true, 0) => &FINE[..],
                        (true, _) => &FINE[1..],
                    };
                    has_moved[i] = self.settle(i, stages, is_last) > 1e-3;
                }
            }
        }
    }

    /// How well an object explains the pixels that show it: the loss of each, on average, and their number.
    pub fn fit(&mut self, object: usize) -> TriedFit {
        let Some((placement, window)) = self.placements[object].zip(self.windows[object].clone())
        else {
            return TriedFit::default();
        };
        self.keep_others(object, &window);
        let known = &self.objects[object];
        let mut refinement = Refinement {
            residual: &mut self.residual,
            object: known,
            is_free: false,
        };
        refinement.try_at(&placement, OUTLIER)
    }

    /// True if an object explains the pixels that show it badly, or cannot be found though there are pixels that may show it.
    pub fn is_bad(&mut self, object: usize) -> bool {
        let open: usize = self
            .open_blobs(object)
            .iter()
            .map(|it| it.pixels.len())
            .sum();
        if self.placements[object].is_none() {
            return open > 8;
        }
        let fit = self.fit(object);
        fit.pixels == 0 && open > 8
            || fit.misfit > self.bad() * fit.pixels as f32
            || open as f32 > 8.0 + 0.15 * fit.pixels as f32
    }

    /// The loss of a pixel, on average, below which an object is explained well.
    fn good(&self) -> f32 {
        GOOD + 3.3 * self.noise
    }

    /// The loss of a pixel, on average, above which an object is explained badly.
    pub fn bad(&self) -> f32 {
        BAD + 6.0 * self.noise
    }

    fn remember(&self) -> Remembered {
        Remembered {
            placements: self.placements.clone(),
            loss: self.loss(),
        }
    }

    fn restore(&mut self, remembered: &Remembered) {
        for i in 0..self.objects.len() {
            if self.placements[i] != remembered.placements[i] {
                self.place(i, remembered.placements[i]);
            }
        }
    }

    /// Tries other arrangements as long as objects are explained badly: takes away those, and others that may be in their place, and
    /// finds them again in another order.
    pub fn reconsider(&mut self) {
        let mut random = tabletop_core::Random::new(1);
        for attempt in 0..ATTEMPTS {
            let bad: Vec<_> = (0..self.objects.len())
                .filter(|&i| self.is_bad(i))
                .collect();
            if bad.is_empty() {
                return;
            }
            let before = self.remember();
            let is_near = |one: usize, other: usize| {
                let windows = self.windows[one].as_ref().zip(self.windows[other].as_ref());
                windows.is_some_and(|(own, other)| !own.intersection(other).is_empty())
            };
            let away: Vec<_> = (0..self.objects.len())
                .filter(|&i| {
                    bad.iter().any(|&bad| {
                        bad == i
                            || self.colors[bad] == self.colors[i]
                            || attempt % 2 == 1 && is_near(bad, i)
                    })
                })
                .collect();
            for &i in &away {
                self.place(i, None);
            }
            self.enough = THOROUGH;
            self.arrange(&mut || match attempt {
                0 => 1.0,
                _ => random.between((0.4, 1.0)),
            });
            if self.loss() >= before.loss - 1.0 {
                self.restore(&before);
            }
        }
    }

    /// The direction of the ray on which an object lies.
    pub fn ray_to(&self, location: Vec3) -> Vec3 {
        (location - self.residual.eye()).normalize_or(Vec3::NEG_Z)
    }
}
