//! The arrangement of all objects that explains a picture best: found object by object, best explained first, and then settled together.

use bevy::math::Vec3;
use tabletop_camera::{DrawnSolid, PictureWindow};

use crate::{
    guess::{Candidate, Guess},
    known::{KnownObject, Placement},
    refine::{FINE, Refinement, Stage},
    residual::{OUTLIER, Residual, Trial, for_pixels, loss},
    segment::{Blob, NO_COLOR, Palette, blobs},
    support,
};

/// The part of what an object should explain that it has to explain at least.
const LEAST_SCORE: f32 = 0.12;
/// Squared difference of a pixel above which it is not explained, without noise.
const UNEXPLAINED: f32 = 600.0;
/// The loss that a support may add, as a part of what the object explains: else it is in the air.
const SUPPORTED: f32 = 0.05;
/// The loss of a pixel, on average, above which an object is explained badly, without noise.
const BAD: f32 = 150.0;
/// The largest height, in units, on which objects that nothing is known about are looked for.
const HIGHEST: f32 = 4.0;
/// Largest number of attempts to find a better arrangement.
const ATTEMPTS: usize = 4;

/// The placements of all objects, compared with a picture.
pub(crate) struct Arrangement<'a, 'p> {
    pub objects: &'a [KnownObject],
    pub residual: Residual<'p>,
    /// The placement of each object, if it is known, and the window in which it may be seen.
    pub placements: Vec<Option<Placement>>,
    windows: Vec<Option<PictureWindow>>,
    /// The known colour that each pixel shows, and that of each object.
    classes: Vec<u8>,
    colors: Vec<u8>,
    /// Squared difference of each pixel from the arrangement.
    squares: Vec<f32>,
    /// Variance of a part of a pixel.
    pub noise: f32,
}

/// The placements, to come back to.
#[derive(Clone)]
struct Remembered {
    placements: Vec<Option<Placement>>,
    loss: f64,
}

impl<'a, 'p> Arrangement<'a, 'p> {
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
            residual,
        };
        arrangement.compare(&arrangement.residual.whole());
        arrangement.noise = arrangement.median_variance();
        arrangement
    }

    /// The variance of a part of a pixel, from the median of all: most pixels show what is known.
    fn median_variance(&self) -> f32 {
        let mut squares = self.squares.clone();
        if squares.is_empty() {
            return 0.0;
        }
        let middle = squares.len() / 2;
        let (_, median, _) = squares.select_nth_unstable_by(middle, f32::total_cmp);
        // The median of the chi-squared distribution of three degrees of freedom.
        *median / 2.366
    }

    /// Squared difference of a pixel above which it is not explained.
    pub fn unexplained(&self) -> f32 {
        // One pixel of a thousand is noisier (chi-squared, three degrees of freedom).
        UNEXPLAINED.max(16.3 * self.noise)
    }

    pub fn square(&self, pixel: usize) -> f32 {
        self.squares[pixel]
    }

    pub fn class(&self, pixel: usize) -> u8 {
        self.classes[pixel]
    }

    pub fn color(&self, object: usize) -> u8 {
        self.colors[object]
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
        let residual = &self.residual;
        let squares = &mut self.squares;
        for_pixels(window, residual.seen().width, |i| {
            squares[i] = residual.square(i);
        });
    }

    /// Keeps everything but one object, within a window.
    pub fn keep_others(&mut self, object: usize, window: &PictureWindow) {
        let solids = self.others(Some(object), window);
        self.residual.keep(&solids, window);
    }

    pub fn window_at(&self, object: usize, placement: &Placement) -> Option<PictureWindow> {
        let mut solids = Vec::new();
        self.objects[object].draw(placement, 1, &mut solids);
        let window = self.residual.window_of(&solids)?;
        Some(window.widened(1, self.residual.size()))
    }

    /// Places an object, or takes it away.
    pub fn place(&mut self, object: usize, placement: Option<Placement>) {
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

    /// Finds all objects without a placement, the one that explains most of its pixels first.
    pub fn find_all(&mut self, chance: &mut impl FnMut() -> f32) {
        let mut candidates: Vec<Option<Option<Candidate>>> = vec![None; self.objects.len()];
        loop {
            for i in 0..self.objects.len() {
                if self.placements[i].is_some() || candidates[i].is_some() {
                    continue;
                }
                // Of objects that look the same, the first one is looked for.
                let twin = (0..i).find(|&j| {
                    self.placements[j].is_none() && self.objects[j].looks_like(&self.objects[i])
                });
                if twin.is_none() {
                    candidates[i] = Some(self.guess(i));
                }
            }
            let best = (0..self.objects.len())
                .filter_map(|i| Some((i, candidates[i].as_ref()?.as_ref()?)))
                .map(|(i, candidate)| (i, candidate.placement, candidate.score * chance()))
                .reduce(|best, next| if next.2 > best.2 { next } else { best });
            let Some((object, placement, _)) = best.filter(|best| best.2 > LEAST_SCORE) else {
                return;
            };
            if std::env::var("DBG").is_ok() {
                for (i, c) in candidates.iter().enumerate() {
                    eprintln!(
                        "  cand {i} {:?}",
                        c.as_ref().map(|c| c.as_ref().map(|c| (
                            c.placement.location,
                            c.placement.yaw,
                            c.score
                        )))
                    );
                }
                eprintln!("place {object} {placement:?}");
            }
            self.place(object, Some(placement));
            let window = self.windows[object].clone().unwrap_or_default();
            let wide = window.widened(4, self.residual.size());
            for i in 0..self.objects.len() {
                let is_stale = candidates[i].as_ref().is_some_and(|candidate| {
                    candidate.as_ref().is_some_and(|candidate| {
                        self.colors[i] == self.colors[object]
                            || !candidate.window.intersection(&wide).is_empty()
                    })
                });
                if i == object || is_stale {
                    candidates[i] = None;
                }
            }
        }
    }

    /// The best candidate for an object among those that are placed.
    fn guess(&mut self, object: usize) -> Option<Candidate> {
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
        let known = &self.objects[object];
        let mut guess = Guess {
            others: placed.collect(),
            heights: match known.is_fixed() {
                true => vec![0.0],
                false => support::pile_heights(others.map(|i| &self.objects[i]), HIGHEST),
            },
            residual: &mut self.residual,
            object: known,
            blobs,
        };
        guess.best()
    }

    /// Refines an object among the others: on what it stands on, or in the air. Returns by how much, in units, it moved.
    pub fn settle(&mut self, object: usize, stages: &[Stage], is_last: bool) -> f32 {
        let Some(before) = self.placements[object] else {
            return 0.0;
        };
        let Some(window) = self.window_at(object, &before) else {
            return 0.0;
        };
        self.keep_others(object, &window.widened(6, self.residual.size()));
        let known = &self.objects[object];
        let eye = self.residual.eye();
        let mut refinement = Refinement {
            residual: &mut self.residual,
            object: known,
            is_free: !known.is_fixed(),
        };
        let (free, trial) = refinement.refined(before, stages);
        let others = (self.objects.iter().zip(&self.placements).enumerate())
            .filter(|(i, _)| *i != object)
            .filter_map(|(_, (other, placement))| Some((other, placement.as_ref()?)));
        let mut heights = support::heights(known, &free, others);
        if !is_last && !heights.contains(&before.location.z) {
            // What it stands on may not be in its place yet.
            heights.push(before.location.z);
        }
        heights.sort_by(|a, b| {
            let [a, b] = [a, b].map(|height| (height - free.location.z).abs());
            a.total_cmp(&b)
        });
        refinement.is_free = false;
        let mut best: Option<(Placement, Trial)> = None;
        for height in heights.into_iter().take(3) {
            let (placement, trial) = refinement.refined(free.at_height(height, eye), stages);
            if best.is_none_or(|(_, best)| trial.gain < best.gain) {
                best = Some((placement, trial));
            }
        }
        let allowance = SUPPORTED * trial.gain.abs() + 20.0 * self.noise.max(1.0);
        let mut settled = match best {
            Some((placement, supported)) if supported.gain <= trial.gain + allowance => placement,
            _ => {
                refinement.is_free = true;
                free
            }
        };
        if is_last {
            settled = refinement.polished(settled, 0.004).0;
        }
        if std::env::var("DBG").is_ok() {
            eprintln!(
                "settle {object} free {:?} {} -> {:?} best {:?}",
                free.location,
                trial.gain,
                settled.location,
                best.map(|b| b.1.gain)
            );
        }
        self.place(object, Some(settled));
        settled.location.distance(before.location) + (settled.yaw - before.yaw).abs()
    }

    /// Settles all objects, in turn.
    pub fn settle_all(&mut self, rounds: usize) {
        let mut has_moved = vec![true; self.objects.len()];
        for round in 0..rounds {
            let is_last = round + 1 == rounds;
            for i in 0..self.objects.len() {
                let is_touched = (0..self.objects.len()).any(|j| {
                    let near = self.windows[i].as_ref().zip(self.windows[j].as_ref());
                    has_moved[j]
                        && near.is_some_and(|(own, other)| !own.intersection(other).is_empty())
                });
                if is_touched || is_last {
                    let stages = if round == 0 { &FINE[..] } else { &FINE[1..] };
                    has_moved[i] = self.settle(i, stages, is_last) > 1e-3;
                }
            }
        }
    }

    /// How well an object explains the pixels that show it: the loss of each, on average, and their number.
    pub fn fit(&mut self, object: usize) -> Trial {
        let Some((placement, window)) = self.placements[object].zip(self.windows[object].clone())
        else {
            return Trial::default();
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
            self.find_all(&mut || match attempt {
                0 => 1.0,
                _ => random.between((0.4, 1.0)),
            });
            self.settle_all(2);
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
