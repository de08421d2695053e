//! The residual: how a picture differs from one that is drawn.

use bevy::math::Vec3;
use tabletop_camera::{Camera, DrawnSolid, PictureLayers, PictureWindow, Scene};
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
pub(crate) struct Trial {
    /// The loss in its window, less that without it.
    pub gain: f32,
    /// Number of pixels that show it.
    pub pixels: u32,
    /// The loss in these pixels.
    pub misfit: f32,
}

impl<'p> Residual<'p> {
    pub fn new(seen: &'p Picture, ground: &Scene, camera: Camera) -> Self {
        Self {
            seen,
            camera,
            layers: PictureLayers::of(ground, &camera),
            kept: vec![0.0; seen.depth.len()],
            window: PictureWindow::default(),
        }
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
        for_pixels(&self.window, self.seen.width, |i| {
            self.kept[i] = square(self.seen, drawn, i);
        });
    }

    /// The squared difference of a pixel from what is kept.
    pub fn square(&self, pixel: usize) -> f32 {
        self.kept[pixel]
    }

    /// The picture of what is kept, valid in its window.
    pub fn kept_picture(&mut self) -> &Picture {
        let window = self.window.clone();
        self.layers.draw(&[], &window)
    }

    /// Tries solids, whose number is [`TRIED`].
    pub fn try_solids(&mut self, solids: &[DrawnSolid], outlier: f32) -> Trial {
        let mut trial = Trial::default();
        let Some(window) = self.layers.window_of(solids) else {
            return trial;
        };
        let window = window.intersection(&self.window);
        let drawn = self.layers.draw(solids, &window);
        for_pixels(&window, self.seen.width, |i| {
            let own = loss(square(self.seen, drawn, i), outlier);
            trial.gain += own - loss(self.kept[i], outlier);
            if drawn.objects[i] == TRIED {
                trial.pixels += 1;
                trial.misfit += own;
            }
        });
        trial
    }

    /// Draws solids over what is kept. Valid in the part of the window that is kept.
    pub fn draw(&mut self, solids: &[DrawnSolid], window: &PictureWindow) -> &Picture {
        self.layers.draw(solids, window)
    }
}

/// The indices of the pixels of a window, row by row.
pub(crate) fn for_pixels(window: &PictureWindow, width: u32, mut see: impl FnMut(usize)) {
    for row in window.rows.clone() {
        let first = row as usize * width as usize;
        for column in window.columns.clone() {
            see(first + column as usize);
        }
    }
}

/// The squared difference of a pixel of two pictures, summed over red, green and blue.
#[inline]
pub(crate) fn square(one: &Picture, other: &Picture, i: usize) -> f32 {
    let [one, other] = [one, other].map(|picture| &picture.rgb[3 * i..3 * i + 3]);
    let parts = one.iter().zip(other);
    let square: i32 = parts
        .map(|(&a, &b)| {
            let difference = i32::from(a) - i32::from(b);
            difference * difference
        })
        .sum();
    square as f32
}
