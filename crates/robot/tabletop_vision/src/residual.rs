//! The residual: how a picture differs from one that is drawn.

use bevy::math::Vec3;
use tabletop_camera::{Camera, DrawnSolid, PictureLayers, PictureWindow};
use tabletop_core::Picture;

use crate::{
    pixels::rows,
    transfer::{ToneTransfer, TransferMemory},
};

/// The squared difference of a pixel, in squared grey levels summed over the colours, at which it counts half as much as an outlier: far above
/// noise and small displacements of edges, and below the difference between most colours.
pub(crate) const OUTLIER: f32 = 12_000.0;

/// The number of the object that is tried, in the picture drawn of it.
pub(crate) const TRIED: u32 = u32::MAX;

/// The loss of a squared difference (Geman and McClure's): it grows no further than to `outlier`.
pub(crate) fn loss(square: f32, outlier: f32) -> f32 {
    square * outlier / (square + outlier)
}

/// A picture, compared with drawn ones.
#[derive(Debug)]
pub(crate) struct Residual<'p> {
    seen: &'p Picture,
    pub camera: Camera,
    transfer: ToneTransfer,
    layers: PictureLayers,
    /// The memory of what is shown of what is drawn.
    memory: TransferMemory,
    /// Squared difference of each pixel from what is kept, known in the window.
    kept: Vec<f32>,
    window: PictureWindow,
}

/// What becomes of the residual where an object is drawn.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct TriedFit {
    /// The loss in its window, less that without it.
    pub gain: f32,
    /// Number of pixels that show it.
    pub pixels: u32,
    /// The loss in these pixels.
    pub misfit: f32,
}

impl<'p> Residual<'p> {
    /// Of a picture as it is [compared](ToneTransfer::compared), with the ground and the camera with which the layers were begun.
    pub fn new(
        seen: &'p Picture,
        layers: PictureLayers,
        camera: Camera,
        transfer: ToneTransfer,
    ) -> Self {
        Self {
            seen,
            camera,
            transfer,
            layers,
            memory: TransferMemory::default(),
            kept: vec![0.0; seen.depth.len()],
            window: PictureWindow::default(),
        }
    }

    /// The layers, for the next picture.
    pub fn into_layers(self) -> PictureLayers {
        self.layers
    }

    pub const fn seen(&self) -> &'p Picture {
        self.seen
    }

    pub const fn transfer(&self) -> &ToneTransfer {
        &self.transfer
    }

    pub fn eye(&self) -> Vec3 {
        self.camera.pose.location
    }

    pub const fn size(&self) -> [u32; 2] {
        [self.camera.width, self.camera.height]
    }

    pub fn whole(&self) -> PictureWindow {
        self.layers.whole()
    }

    /// The window in which solids change what is shown.
    pub fn window_of<'s>(
        &self,
        solids: impl IntoIterator<Item = &'s DrawnSolid>,
    ) -> Option<PictureWindow> {
        let window = self.layers.window_of(solids)?;
        Some(window.widened(self.transfer.reach(), self.size()))
    }

    /// The window in which solids are drawn.
    pub fn drawn_window_of<'s>(
        &self,
        solids: impl IntoIterator<Item = &'s DrawnSolid>,
    ) -> Option<PictureWindow> {
        self.layers.window_of(solids)
    }

    /// Keeps these solids over the ground, within a window; what is tried is compared there.
    pub fn keep(&mut self, solids: &[DrawnSolid], window: &PictureWindow) {
        let wide = window.widened(self.transfer.reach(), self.size());
        self.layers.keep(solids, &wide);
        self.window = window.intersection(&self.layers.whole());
        let (window, width, seen) = (self.window.clone(), self.seen.width, self.seen);
        let mut kept = std::mem::take(&mut self.kept);
        let shown = self.draw(&[], &window);
        for row in rows(&window, width) {
            let parts = 3 * row.start..3 * row.end;
            let seen = seen.rgb[parts.clone()].chunks_exact(3);
            let shown = shown.rgb[parts].chunks_exact(3);
            for (kept, (seen, shown)) in kept[row].iter_mut().zip(seen.zip(shown)) {
                *kept = square_of(seen, shown);
            }
        }
        self.kept = kept;
    }

    /// The squared differences of pixels from what is kept, valid in its window.
    pub fn squares(&self) -> &[f32] {
        &self.kept
    }

    /// The variance of noise in a part of a pixel of what is kept: by the median of the distances of all values from the median of those that are shown
    /// alike. So it is what the picture itself shows, whether it is lit as expected or not. White and black cannot get brighter and darker, so what does not differ
    /// does not count.
    pub fn variance(&mut self) -> f32 {
        /// The part of all that differs at least if there is noise.
        const NOISY: f32 = 0.3;
        const LEVELS: usize = 256;
        let (window, width, seen) = (self.window.clone(), self.seen.width, self.seen);
        let shown = self.draw(&[], &window);
        // By the part of the pixel, what is shown and what is seen.
        let mut counts = vec![0_u32; 3 * LEVELS * LEVELS];
        for row in rows(&window, width) {
            let parts = 3 * row.start..3 * row.end;
            let pairs = seen.rgb[parts.clone()].iter().zip(&shown.rgb[parts]);
            for (i, (seen, shown)) in pairs.enumerate() {
                counts[(i % 3 * LEVELS + usize::from(*shown)) * LEVELS + usize::from(*seen)] += 1;
            }
        }
        let mut distances = [0_u32; LEVELS];
        for counts in counts.chunks_exact(LEVELS) {
            let middle = usual(counts);
            for (value, count) in counts.iter().enumerate() {
                distances[value.abs_diff(middle)] += count;
            }
        }
        let all: u32 = distances.iter().sum();
        let differing = all - distances[0];
        if differing as f32 <= NOISY * all as f32 {
            return 0.0;
        }
        let median = median(&distances[1..]) as f32 + 1.0;
        // Half of all normally distributed numbers are within 0.6745 standard deviations.
        (median / 0.6745) * (median / 0.6745)
    }

    /// The pixels of what is kept that differ much from the next one: its edges.
    pub fn outline(&mut self) -> Vec<usize> {
        /// The least squared difference of two pixels at an edge.
        const EDGE: f32 = 10_000.0;
        let (window, width) = (self.window.clone(), self.seen.width as usize);
        let shown = self.draw(&[], &window);
        let color = |i: usize| &shown.rgb[3 * i..3 * i + 3];
        let inner = rows(&window, width as u32).flat_map(|row| row.skip(1));
        let inner = inner.filter(|&i| i >= width);
        let is_edge = |i: &usize| {
            let mut before = [i - 1, i - width].into_iter();
            before.any(|before| square_of(color(*i), color(before)) > EDGE)
        };
        inner.filter(is_edge).collect()
    }

    /// Tries solids, whose number is [`TRIED`].
    pub fn try_solids(&mut self, solids: &[DrawnSolid], outlier: f32) -> TriedFit {
        let mut trial = TriedFit::default();
        let Some(window) = self.window_of(solids) else {
            return trial;
        };
        let window = window.intersection(&self.window);
        let seen = self.seen;
        let squares = std::mem::take(&mut self.kept);
        let shown = self.draw(solids, &window);
        for row in rows(&window, seen.width) {
            let parts = 3 * row.start..3 * row.end;
            let seen = seen.rgb[parts.clone()].chunks_exact(3);
            let pixels = seen.zip(shown.rgb[parts].chunks_exact(3));
            let known = squares[row.clone()].iter().zip(&shown.objects[row]);
            for ((seen, drawn), (&kept, &object)) in pixels.zip(known) {
                let own = loss(square_of(seen, drawn), outlier);
                trial.gain += own - loss(kept, outlier);
                if object == TRIED {
                    trial.pixels += 1;
                    trial.misfit += own;
                }
            }
        }
        self.kept = squares;
        trial
    }

    /// Shows solids over what is kept. Valid in the part of the window that is kept.
    pub fn draw(&mut self, solids: &[DrawnSolid], window: &PictureWindow) -> &Picture {
        if self.transfer == ToneTransfer::EXACT {
            return self.layers.draw(solids, window);
        }
        let window = window.intersection(&self.window);
        let wide = window.widened(self.transfer.reach(), self.size());
        let drawn = self.layers.draw(solids, &wide);
        self.transfer.show(drawn, &window, &mut self.memory);
        &self.memory.shown
    }
}

/// The usual one of values that are counted: their median, unless many are the same, as white is with noise.
fn usual(counts: &[u32]) -> usize {
    let all: u32 = counts.iter().sum();
    let most = counts.iter().enumerate().max_by_key(|(_, count)| **count);
    let many = most.filter(|(_, count)| **count > all / 4);
    many.map_or_else(|| median(counts), |(value, _)| value)
}

/// The median of values that are counted.
fn median(counts: &[u32]) -> usize {
    let all: u32 = counts.iter().sum();
    let mut below = 0;
    let up_to = counts.iter().take_while(|count| {
        below += **count;
        below <= all / 2
    });
    up_to.count().min(counts.len() - 1)
}

/// The squared difference of two colours, summed over red, green and blue.
#[inline]
pub(crate) fn square_of(one: &[u8], other: &[u8]) -> f32 {
    let difference = |part: usize| i32::from(one[part]) - i32::from(other[part]);
    let [red, green, blue] = [difference(0), difference(1), difference(2)];
    (red * red + green * green + blue * blue) as f32
}
