//! The residual: how a picture differs from one that is drawn.

use std::ops::Range;

use bevy::math::Vec3;
use tabletop_camera::{Camera, DrawnSolid, PictureLayers, PictureWindow};
use tabletop_core::Picture;

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
    layers: PictureLayers,
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
    /// With the ground and the camera with which the layers were begun.
    pub fn new(seen: &'p Picture, layers: PictureLayers, camera: Camera) -> Self {
        Self {
            seen,
            camera,
            layers,
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

    pub fn eye(&self) -> Vec3 {
        self.camera.pose.location
    }

    pub const fn size(&self) -> [u32; 2] {
        [self.camera.width, self.camera.height]
    }

    pub fn whole(&self) -> PictureWindow {
        self.layers.whole()
    }

    /// The window of solids.
    pub fn window_of<'s>(
        &self,
        solids: impl IntoIterator<Item = &'s DrawnSolid>,
    ) -> Option<PictureWindow> {
        self.layers.window_of(solids)
    }

    /// Keeps these solids over the ground, within a window; what is tried is compared there.
    pub fn keep(&mut self, solids: &[DrawnSolid], window: &PictureWindow) {
        self.layers.keep(solids, window);
        self.window = window.intersection(&self.layers.whole());
        let drawn = self.layers.draw(&[], &self.window);
        for row in rows(&self.window, self.seen.width) {
            let parts = 3 * row.start..3 * row.end;
            let seen = self.seen.rgb[parts.clone()].chunks_exact(3);
            let drawn = drawn.rgb[parts].chunks_exact(3);
            for (kept, (seen, drawn)) in self.kept[row].iter_mut().zip(seen.zip(drawn)) {
                *kept = square_of(seen, drawn);
            }
        }
    }

    /// The squared differences of pixels from what is kept, valid in its window.
    pub fn squares(&self) -> &[f32] {
        &self.kept
    }

    /// The variance of noise in a part of a pixel of what is kept, from the median of all differences: most pixels show what is known. White and
    /// black cannot get brighter and darker, so what does not differ does not count.
    pub fn variance(&mut self) -> f32 {
        /// The part of all that differs at least if there is noise.
        const NOISY: f32 = 0.3;
        let window = self.window.clone();
        let drawn = self.layers.draw(&[], &window);
        let mut counts = [0_u32; 256];
        for row in rows(&window, self.seen.width) {
            let parts = 3 * row.start..3 * row.end;
            for (seen, drawn) in self.seen.rgb[parts.clone()].iter().zip(&drawn.rgb[parts]) {
                counts[usize::from(seen.abs_diff(*drawn))] += 1;
            }
        }
        let all: u32 = counts.iter().sum();
        let differing = all - counts[0];
        if differing as f32 <= NOISY * all as f32 {
            return 0.0;
        }
        let mut below = 0;
        let median = counts.iter().skip(1).take_while(|count| {
            below += **count;
            below <= differing / 2
        });
        let median = median.count() as f32 + 1.0;
        // Half of all normally distributed numbers are within 0.6745 standard deviations.
        (median / 0.6745) * (median / 0.6745)
    }

    /// Tries solids, whose number is [`TRIED`].
    pub fn try_solids(&mut self, solids: &[DrawnSolid], outlier: f32) -> TriedFit {
        let mut trial = TriedFit::default();
        let Some(window) = self.layers.window_of(solids) else {
            return trial;
        };
        let window = window.intersection(&self.window);
        let drawn = self.layers.draw(solids, &window);
        for row in rows(&window, self.seen.width) {
            let parts = 3 * row.start..3 * row.end;
            let seen = self.seen.rgb[parts.clone()].chunks_exact(3);
            let pixels = seen.zip(drawn.rgb[parts].chunks_exact(3));
            let known = self.kept[row.clone()].iter().zip(&drawn.objects[row]);
            for ((seen, drawn), (&kept, &object)) in pixels.zip(known) {
                let own = loss(square_of(seen, drawn), outlier);
                trial.gain += own - loss(kept, outlier);
                if object == TRIED {
                    trial.pixels += 1;
                    trial.misfit += own;
                }
            }
        }
        trial
    }

    /// Draws solids over what is kept. Valid in the part of the window that is kept.
    pub fn draw(&mut self, solids: &[DrawnSolid], window: &PictureWindow) -> &Picture {
        self.layers.draw(solids, window)
    }
}

/// The indices of the pixels of a window, row by row.
pub(crate) fn rows(
    window: &PictureWindow,
    width: u32,
) -> impl Iterator<Item = Range<usize>> + use<> {
    let columns = window.columns.clone();
    window.rows.clone().map(move |row| {
        let first = row as usize * width as usize;
        first + columns.start as usize..first + columns.end as usize
    })
}

/// The squared difference of two colours, summed over red, green and blue.
#[inline]
pub(crate) fn square_of(one: &[u8], other: &[u8]) -> f32 {
    let difference = |part: usize| i32::from(one[part]) - i32::from(other[part]);
    let [red, green, blue] = [difference(0), difference(1), difference(2)];
    (red * red + green * green + blue * blue) as f32
}
