//! The arrangement of all objects that explains a picture best: found object by object, best explained first, and then settled together.

mod carried;
mod finding;
mod guided;
mod settling;
mod tracking;

use bevy::math::Vec3;
use tabletop_camera::{DrawnSolid, PictureWindow};

use crate::{
    known::{KnownObject, StandingPose},
    pixels::rows,
    refine::Refinement,
    residual::{OUTLIER, Residual, TriedFit, loss},
    segment::{Blob, NO_COLOR, Palette, blobs},
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
/// The loss by which another arrangement has to be better at least.
const BETTER: f64 = 1.0;
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
    /// True for what is fixed, and stays where it was in the last picture.
    is_anchored: Vec<bool>,
    /// The known colour that each pixel shows, and that of each object.
    classes: Vec<u8>,
    colors: Vec<u8>,
    /// Squared difference of each pixel from the arrangement.
    squares: Vec<f32>,
    /// Variance of a part of a pixel.
    pub noise: f32,
    /// The loss of a pixel, on average, that the way in which the picture shows things leaves where they are in their places.
    pub rest: f32,
    /// The loss that a support may add, as a part of what the object explains: else it is in the air.
    allowance: f32,
    /// The part of what it should explain above which an object is placed without a look at other places.
    enough: f32,
    /// Number of pixels that nothing explained in the last picture after all attempts, if objects were explained badly then.
    pub given_up: Option<usize>,
    /// True if objects were seen before, and may be in the air by now.
    is_following: bool,
    /// The pixels at the edges of the ground.
    outline: Vec<usize>,
    /// Whether open pixels may show an object in the place of those where it is, as far as that is known.
    rivals: Vec<Option<bool>>,
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
        let classes = palette.classes(
            residual.seen(),
            residual.camera.light.color,
            residual.transfer(),
        );
        let colors = objects.iter().map(|it| palette.number(it.color()));
        let mut arrangement = Self {
            objects,
            placements: vec![None; objects.len()],
            windows: vec![None; objects.len()],
            is_anchored: vec![false; objects.len()],
            classes,
            colors: colors.collect(),
            squares: vec![0.0; residual.seen().depth.len()],
            noise: 0.0,
            rest: 0.0,
            allowance: SUPPORTED,
            enough: GOOD_SCORE,
            given_up: None,
            is_following: false,
            outline: Vec::new(),
            rivals: vec![None; objects.len()],
            residual,
        };
        let whole = arrangement.residual.whole();
        arrangement.compare(&whole);
        arrangement.noise = arrangement.residual.variance();
        arrangement.outline = arrangement.residual.outline();
        arrangement
    }

    /// Squared difference of a pixel above which it is not explained.
    pub fn unexplained(&self) -> f32 {
        // One pixel of a thousand is noisier (chi-squared, three degrees of freedom).
        UNEXPLAINED.max(16.3 * self.noise) + 4.0 * self.rest
    }

    pub fn square(&self, pixel: usize) -> f32 {
        self.squares[pixel]
    }

    /// The solids of the placed objects that may be seen in a window, but for some.
    fn all_but(&self, but: impl Fn(usize) -> bool, window: &PictureWindow) -> Vec<DrawnSolid> {
        let mut solids = Vec::new();
        for (i, placement) in self.placements.iter().enumerate() {
            let (Some(placement), Some(own)) = (placement, &self.windows[i]) else {
                continue;
            };
            if !but(i) && !own.intersection(window).is_empty() {
                self.objects[i].draw(placement, i as u32 + 1, &mut solids);
            }
        }
        solids
    }

    /// Compares the arrangement with the picture in a window.
    pub fn compare(&mut self, window: &PictureWindow) {
        let solids = self.all_but(|_| false, window);
        self.residual.keep(&solids, window);
        for row in rows(window, self.residual.seen().width) {
            self.squares[row.clone()].copy_from_slice(&self.residual.squares()[row]);
        }
    }

    /// Keeps everything but one object, within a window.
    pub fn keep_others(&mut self, object: usize, window: &PictureWindow) {
        self.keep_all_but(|i| i == object, window);
    }

    fn keep_all_but(&mut self, but: impl Fn(usize) -> bool, window: &PictureWindow) {
        let solids = self.all_but(but, window);
        self.residual.keep(&solids, window);
    }

    pub fn window_at(&self, object: usize, placement: &StandingPose) -> Option<PictureWindow> {
        let mut solids = Vec::new();
        self.objects[object].draw(placement, 1, &mut solids);
        let window = self.residual.window_of(&solids)?;
        Some(window.widened(1, self.residual.size()))
    }

    /// Places an object, or takes it away, and with it what it guides.
    pub fn place(&mut self, object: usize, placement: Option<StandingPose>) {
        if placement.is_none() {
            for (part, _) in self.parts(object) {
                self.place(part, None);
            }
        }
        self.rivals.fill(None);
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
        self.all_but(|_| false, &self.residual.whole())
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
        fit.misfit > self.bad() * fit.pixels as f32
            || open as f32 > 8.0 + 0.15 * fit.pixels as f32 && self.has_rival(object, &fit)
    }

    /// True if an object would explain open pixels of its colour about as well as those that it explains like this: which of them show it, and which something that is
    /// not known, no picture tells.
    fn has_rival(&mut self, object: usize, fit: &TriedFit) -> bool {
        if let Some(has_rival) = self.rivals[object] {
            return has_rival;
        }
        let as_well = 2.0 * self.good().max(fit.misfit / fit.pixels.max(1) as f32);
        let is_guided = self.objects[object].guide().is_some();
        let rival = match is_guided {
            true => None,
            false => self.guess(object).and_then(|mut guess| guess.best()),
        };
        let has_rival = rival.is_some_and(|rival| rival.misfit <= as_well);
        self.rivals[object] = Some(has_rival);
        has_rival
    }

    /// True if most of the picture is explained.
    pub fn is_mostly_explained(&self) -> bool {
        let good = self.good();
        let poor = self.squares.iter().filter(|square| **square > good);
        2 * poor.count() < self.squares.len()
    }

    /// The loss of a pixel, on average, of most of the things that are seen, the ground among them: the median. If it is not good, that is no matter of places,
    /// but of how the picture shows things.
    pub fn usual_misfit(&mut self) -> f32 {
        let fits: Vec<_> = (0..self.objects.len()).map(|i| self.fit(i)).collect();
        let seen = fits.into_iter().filter(|fit| fit.pixels > 0);
        let misfits = seen.map(|fit| fit.misfit / fit.pixels as f32);
        let mut misfits: Vec<_> = misfits.chain([self.outline_misfit()]).collect();
        misfits.sort_by(f32::total_cmp);
        misfits[misfits.len() / 2]
    }

    /// True if the edges of the ground are where they are seen, to a small part of a pixel.
    pub fn is_outline_explained(&self) -> bool {
        self.outline_misfit() < OUTLIER / 4.0 + 6.0 * self.noise
    }

    /// The loss of a pixel at the edges of the ground, on average.
    fn outline_misfit(&self) -> f32 {
        let losses = self.outline.iter().map(|&i| loss(self.squares[i], OUTLIER));
        losses.sum::<f32>() / self.outline.len().max(1) as f32
    }

    /// The objects that are explained badly, and that another place may explain better.
    fn explained_badly(&mut self) -> Vec<usize> {
        let free = (0..self.objects.len()).filter(|&i| !self.is_anchored[i]);
        let free: Vec<_> = free.collect();
        free.into_iter().filter(|&i| self.is_bad(i)).collect()
    }

    /// True if pixels of one object could show another.
    pub fn share_color(&self, one: usize, other: usize) -> bool {
        self.colors[one] == self.colors[other] && self.colors[one] != NO_COLOR
    }

    /// True if two objects have places that overlap in the picture.
    pub fn overlap(&self, one: usize, other: usize) -> bool {
        let windows = self.windows[one].as_ref().zip(self.windows[other].as_ref());
        windows.is_some_and(|(one, other)| !one.intersection(other).is_empty())
    }

    /// The loss of a pixel, on average, below which an object is explained well.
    pub fn good(&self) -> f32 {
        GOOD + 3.3 * self.noise + 1.5 * self.rest
    }

    /// The loss of a pixel, on average, above which an object is explained badly.
    pub fn bad(&self) -> f32 {
        BAD + 6.0 * self.noise + 2.0 * self.rest
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
    ///
    /// False if some still are.
    pub fn reconsider(&mut self) -> bool {
        let attempts = if self.has_given_up() { 0 } else { ATTEMPTS };
        let mut random = tabletop_core::Random::new(1);
        for attempt in 0..attempts {
            let bad = self.explained_badly();
            if bad.is_empty() {
                return true;
            }
            let before = self.remember();
            let away: Vec<_> = (0..self.objects.len())
                .filter(|&i| !self.is_anchored[i])
                .filter(|&i| {
                    bad.iter().any(|&bad| {
                        bad == i
                            || self.colors[bad] == self.colors[i]
                            || attempt % 2 == 1 && self.overlap(bad, i)
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
            if self.loss() >= before.loss - BETTER {
                self.restore(&before);
            }
        }
        self.explained_badly().is_empty()
    }

    /// True if about as much is unexplained as in the last picture, in which nothing has explained it: to look for it again is no use.
    fn has_given_up(&self) -> bool {
        /// The part of it by which it differs without a reason.
        const ALIKE: f32 = 0.05;
        let open = self.unexplained_pixels() as f32;
        let alike = |before: usize| (open - before as f32).abs() <= ALIKE * open;
        self.given_up.is_some_and(alike)
    }

    /// Number of pixels that nothing explains.
    pub fn unexplained_pixels(&self) -> usize {
        let least = self.unexplained();
        self.squares
            .iter()
            .filter(|square| **square > least)
            .count()
    }

    /// The direction of the ray on which an object lies.
    pub fn ray_to(&self, location: Vec3) -> Vec3 {
        (location - self.residual.eye()).normalize_or(Vec3::NEG_Z)
    }
}
