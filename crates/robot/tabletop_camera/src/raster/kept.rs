//! Bands of rows that stay the same from one picture to the next: they are copied.

use std::{ops::Range, sync::Arc};

use bevy::math::Vec3;
use tabletop_core::Picture;

use crate::{
    camera::PinholeView,
    raster::{face::ROWS, resolve::Pixels, visible::VisibleSurfaces},
    scene::{DrawnFigure, DrawnSolid, Facets, Scene},
};

/// The last picture, as far as it repeats the one before it.
#[derive(Clone, Debug, Default)]
pub(crate) struct KeptBands {
    shown: PictureContent,
    /// True for each band that repeats the previous picture.
    stays: Vec<bool>,
    is_kept: Vec<bool>,
    picture: Picture,
}

/// The content of a picture.
#[derive(Clone, Debug, Default)]
struct PictureContent {
    view: Option<[u32; 12]>,
    solids: Vec<(DrawnSolid, Range<u32>)>,
    figures: Vec<(FigureKey, Range<u32>)>,
    markers: Vec<Vec3>,
}

/// The identity of a figure.
#[derive(Clone, Debug)]
struct FigureKey {
    facets: Arc<Facets>,
    pose: [u32; 7],
    object: u32,
}

/// A band of the kept picture.
pub(crate) struct KeptBand<'a> {
    stays: bool,
    is_kept: &'a mut bool,
    pixels: Pixels<'a>,
}

impl KeptBands {
    /// Finds the bands in which a picture repeats the last one.
    pub fn compare(&mut self, scene: &Scene, visible: &VisibleSurfaces, view: &PinholeView) {
        let bands = (view.height as usize).div_ceil(ROWS);
        self.picture.resize(view.width, view.height);
        self.is_kept.resize(bands, false);
        self.stays.clear();
        let shown = &mut self.shown;
        let view = Some(view.bits());
        let is_same_room = shown.view == view
            && shown.solids.len() == scene.solids.len()
            && shown.figures.len() == scene.figures.len()
            && is_same_place(&shown.markers, &scene.markers);
        if !is_same_room {
            shown.view = view;
            shown.markers.clone_from(&scene.markers);
            let solids = scene.solids.iter().cloned();
            shown.solids = solids.zip(visible.solid_rows()).collect();
            let figures = scene.figures.iter().map(FigureKey::of);
            shown.figures = figures.zip(visible.figure_rows()).collect();
            self.stays.resize(bands, false);
            return;
        }
        self.stays.resize(bands, true);
        let mut change = |rows: &Range<u32>| {
            // A row more on both sides, for rounding errors.
            let first = rows.start.saturating_sub(1) as usize / ROWS;
            let end = (rows.end as usize + 1).div_ceil(ROWS).min(bands);
            if rows.start < rows.end && first < end {
                self.stays[first..end].fill(false);
            }
        };
        let solids = scene.solids.iter().zip(visible.solid_rows());
        for (before, (now, rows)) in shown.solids.iter_mut().zip(solids) {
            if !is_same_solid(&before.0, now) {
                change(&before.1);
                change(&rows);
                *before = (now.clone(), rows);
            }
        }
        let figures = scene.figures.iter().zip(visible.figure_rows());
        for (before, (now, rows)) in shown.figures.iter_mut().zip(figures) {
            if !before.0.is_of(now) {
                change(&before.1);
                change(&rows);
                *before = (FigureKey::of(now), rows);
            }
        }
    }

    /// True if the whole picture is known.
    pub fn is_whole(&self) -> bool {
        let mut bands = self.stays.iter().zip(&self.is_kept);
        bands.all(|(&stays, &is_kept)| stays && is_kept)
    }

    /// Copies the picture, if [all of it](Self::is_whole) is known.
    pub fn copy_to(&self, picture: &mut Picture) {
        picture.rgb.clone_from(&self.picture.rgb);
        picture.depth.clone_from(&self.picture.depth);
        picture.objects.clone_from(&self.picture.objects);
    }

    /// The bands, from the first one on.
    pub fn bands(&mut self) -> impl Iterator<Item = KeptBand<'_>> {
        let pixels = ROWS * self.picture.width as usize;
        let parts = Pixels::of(&mut self.picture).parts(pixels);
        let flags = self.stays.iter().zip(&mut self.is_kept);
        parts
            .zip(flags)
            .map(|(pixels, (&stays, is_kept))| KeptBand {
                stays,
                is_kept,
                pixels,
            })
    }
}

impl KeptBand<'_> {
    /// Draws the band, or copies it where nothing has changed. It is kept once it has stayed the same for the first time: a band that has changed
    /// will mostly go on changing.
    pub fn draw_into(&mut self, mut pixels: Pixels, draw: impl FnOnce(Pixels)) {
        if self.stays && *self.is_kept {
            pixels.copy_from(&self.pixels);
            return;
        }
        draw(pixels.reborrow());
        *self.is_kept = self.stays;
        if self.stays {
            self.pixels.copy_from(&pixels);
        }
    }
}

impl FigureKey {
    fn of(drawn: &DrawnFigure) -> Self {
        Self {
            facets: Arc::clone(&drawn.facets),
            pose: drawn.pose_bits(),
            object: drawn.object,
        }
    }

    fn is_of(&self, drawn: &DrawnFigure) -> bool {
        Arc::ptr_eq(&self.facets, &drawn.facets)
            && self.pose == drawn.pose_bits()
            && self.object == drawn.object
    }
}

fn is_same_solid(before: &DrawnSolid, now: &DrawnSolid) -> bool {
    before == now && before.pose_bits() == now.pose_bits()
}

fn is_same_place(before: &[Vec3], now: &[Vec3]) -> bool {
    let bits = |points: &[Vec3]| {
        let points = points
            .iter()
            .map(|point| point.to_array().map(f32::to_bits));
        points.collect::<Vec<_>>()
    };
    before.len() == now.len() && (now.is_empty() || bits(before) == bits(now))
}
