//! A picture in layers, for whoever draws some of its objects again and again.

use std::ops::Range;

use tabletop_core::Picture;

use crate::{
    camera::{Camera, PictureWindow, PinholeView, SampleOffset},
    raster::{
        backdrop::Backdrop,
        band::{Band, Frame},
        bounds::corners_of_solid,
        coverage::Coverage,
        face::ROWS,
        polyhedra::Polyhedra,
        resolve::{Pixels, RowResolver},
        samples::{CenterSamples, SmoothOnRow, SmoothSamples},
        transparent::TransparentSpheres,
        visible::{SurfaceExtent, VisibleSurfaces},
    },
    scene::{DrawnSolid, Scene},
};

/// A picture in three layers, kept as samples: the *ground* is drawn once, the *kept* solids over it, and the *tried* ones over both, each time
/// only within a window. A picture of the tried solids costs as much as its window, whatever else is in the scene.
///
/// The pixels are those that [`Rasterizer`](crate::Rasterizer) draws of all together, to the byte. Only where surfaces are equally near to the last
/// bit, that of the lower layer is seen.
///
/// ```
/// use bevy::math::Vec3;
/// use tabletop_camera::{Camera, DrawnSolid, PictureLayers, Scene};
/// use tabletop_core::{HeadCamera, Table};
/// use tabletop_geometry::{Pose, Rgb, Solid};
///
/// let table = Table::default();
/// let camera = Camera::of_head(&HeadCamera::default(), &table);
/// let ground = Scene {
///     solids: vec![DrawnSolid::of_table(&table, 1)],
///     ..Scene::default()
/// };
/// let mut layers = PictureLayers::of(&ground, &camera);
/// let block = DrawnSolid {
///     pose: Pose::at(Vec3::new(0.0, -3.0, 0.5)),
///     solid: Solid::Cuboid(Vec3::ONE),
///     color: Rgb::RED,
///     object: 2,
/// };
/// let window = layers.window_of([&block]).unwrap();
/// layers.keep(&[], &window);
/// let picture = layers.draw(&[block], &window);
/// let middle = (window.columns.start + window.columns.end) / 2;
/// let row = (window.rows.start + window.rows.end) / 2;
/// assert_eq!(picture.objects[picture.index(middle, row).unwrap()], 2);
/// ```
#[derive(Clone, Debug)]
pub struct PictureLayers {
    view: PinholeView,
    is_smooth: bool,
    visible: VisibleSurfaces,
    polyhedra: Polyhedra,
    ground: RasterLayer,
    kept: RasterLayer,
    tried: RasterLayer,
    ground_extent: SurfaceExtent,
    kept_extent: SurfaceExtent,
    /// The window in which the kept layer is known.
    window: PictureWindow,
    picture: Picture,
    backdrop: Backdrop,
    /// The memory for a row.
    single: CenterSamples,
}

/// The nearest surfaces at all samples of a picture.
#[derive(Clone, Debug, Default)]
struct RasterLayer {
    centers: CenterSamples,
    smooth: SmoothSamples,
}

impl PictureLayers {
    /// The view of a camera with this scene as its ground, without the scene's [markers](Scene::markers).
    pub fn of(ground: &Scene, camera: &Camera) -> Self {
        let mut layers = Self {
            view: PinholeView::of(camera),
            is_smooth: camera.antialiasing,
            visible: VisibleSurfaces::default(),
            polyhedra: Polyhedra::default(),
            ground: RasterLayer::default(),
            kept: RasterLayer::default(),
            tried: RasterLayer::default(),
            ground_extent: SurfaceExtent::default(),
            kept_extent: SurfaceExtent::default(),
            window: PictureWindow::default(),
            picture: Picture::default(),
            backdrop: Backdrop::default(),
            single: CenterSamples::default(),
        };
        layers.begin(ground, camera);
        layers
    }

    /// Begins anew with another ground or camera, in the same memory.
    pub fn begin(&mut self, ground: &Scene, camera: &Camera) {
        self.view = PinholeView::of(camera);
        self.is_smooth = camera.antialiasing;
        self.visible = VisibleSurfaces::default();
        self.visible.lighting = camera.light.into();
        let mut polyhedra = Polyhedra::default();
        polyhedra.find(&ground.solids);
        (self.visible).project(ground, polyhedra.figures(), &self.view);
        self.ground_extent = self.visible.extent();
        self.kept_extent = self.ground_extent;
        self.window = PictureWindow::default();
        self.picture.resize(camera.width, camera.height);
        for layer in [&mut self.ground, &mut self.kept, &mut self.tried] {
            layer.resize(&self.view);
        }
        self.sample_ground();
    }

    fn sample_ground(&mut self) {
        let frame = Frame {
            view: &self.view,
            visible: &self.visible,
            spheres: &TransparentSpheres::default(),
            backdrop: &self.backdrop,
            is_smooth: self.is_smooth,
        };
        let mut band = Band::default();
        let columns = 0..self.view.width as usize;
        for first_row in (0..self.view.height).step_by(ROWS) {
            let rows = first_row..(first_row + ROWS as u32).min(self.view.height);
            let (centers, smooth) = band.sample(&frame, rows.clone());
            for (i, row) in rows.enumerate() {
                let ground = &mut self.ground;
                (ground.centers).copy_columns(row as usize, columns.clone(), centers, i);
                if self.is_smooth {
                    (ground.smooth).copy_columns(row as usize, columns.clone(), smooth, i);
                }
            }
        }
    }

    /// The whole picture.
    pub fn whole(&self) -> PictureWindow {
        PictureWindow {
            columns: 0..self.view.width,
            rows: 0..self.view.height,
        }
    }

    /// The window in which solids may be seen; `None` if that is nowhere.
    pub fn window_of<'s>(
        &self,
        solids: impl IntoIterator<Item = &'s DrawnSolid>,
    ) -> Option<PictureWindow> {
        let windows = solids.into_iter().filter_map(|drawn| {
            let corners = corners_of_solid(drawn, &self.view);
            self.view.window_of(&corners)
        });
        windows.reduce(|around, own| around.joined(&own))
    }

    /// Keeps these solids over the ground, in place of those before, within a window.
    pub fn keep(&mut self, solids: &[DrawnSolid], window: &PictureWindow) {
        self.window = window.intersection(&self.whole());
        self.visible.truncate(self.ground_extent);
        self.add(solids);
        self.kept_extent = self.visible.extent();
        let window = &self.window;
        self.kept.copy(&self.ground, window, self.is_smooth);
        let drawing = LayerDrawing {
            view: &self.view,
            visible: &self.visible,
            after: self.ground_extent,
            is_smooth: self.is_smooth,
        };
        drawing.draw(window, &mut self.kept, &mut self.single);
    }

    /// Draws these solids over what is [kept](Self::keep), within a window. Of the picture, only the pixels that this window shares with that of
    /// what is kept are valid.
    pub fn draw(&mut self, solids: &[DrawnSolid], window: &PictureWindow) -> &Picture {
        let window = window.intersection(&self.window);
        if window.is_empty() {
            return &self.picture;
        }
        self.visible.truncate(self.kept_extent);
        self.add(solids);
        self.tried.copy(&self.kept, &window, self.is_smooth);
        let drawing = LayerDrawing {
            view: &self.view,
            visible: &self.visible,
            after: self.kept_extent,
            is_smooth: self.is_smooth,
        };
        drawing.draw(&window, &mut self.tried, &mut self.single);
        self.paint(&window);
        &self.picture
    }

    fn add(&mut self, solids: &[DrawnSolid]) {
        for drawn in solids {
            self.visible.add_solid(drawn, &self.view);
        }
        self.polyhedra.find(solids);
        for drawn in self.polyhedra.figures() {
            self.visible.add_passing_figure(drawn, &self.view);
        }
    }

    fn paint(&mut self, window: &PictureWindow) {
        let width = self.view.width as usize;
        let rows = Pixels::of(&mut self.picture).parts(width);
        let rows = (0..).zip(rows).skip(window.rows.start as usize);
        for (row, mut pixels) in rows.take(window.rows.len()) {
            let mut row = RowResolver {
                visible: &self.visible,
                backdrop: &self.backdrop,
                row,
                centers: self.tried.centers.center_row(row as usize),
                smooth: (self.is_smooth).then(|| self.tried.smooth.smooth_row(row as usize)),
                pixels: &mut pixels,
            };
            row.paint_samples(window.columns());
        }
    }
}

/// The surfaces of a layer that are drawn into it.
struct LayerDrawing<'a> {
    view: &'a PinholeView,
    visible: &'a VisibleSurfaces,
    /// How much there was of everything in the layers below.
    after: SurfaceExtent,
    is_smooth: bool,
}

impl LayerDrawing<'_> {
    /// Draws into the samples of a window, and perhaps into some beside it.
    fn draw(&self, window: &PictureWindow, layer: &mut RasterLayer, single: &mut CenterSamples) {
        self.draw_faces(window, layer);
        for quadric in &self.visible.quadrics[self.after.quadrics..] {
            let rows = quadric.window.intersection(window).rows;
            let smooth = self.is_smooth.then_some(&mut layer.smooth);
            quadric.draw_rows(rows, 0, &mut layer.centers, smooth, single);
        }
        for triangle in self.visible.triangles_after(self.after) {
            let rows = common(&triangle.rows, &window.rows);
            for first in rows.clone().step_by(4) {
                triangle.draw_centers(first..rows.end.min(first + 4), 0, &mut layer.centers);
            }
            if self.is_smooth {
                for row in rows {
                    triangle.draw_smooth(row, 0, &mut layer.smooth);
                }
            }
        }
    }

    fn draw_faces(&self, window: &PictureWindow, layer: &mut RasterLayer) {
        let columns = window.columns();
        for (number, face) in
            (self.after.faces as u32..).zip(&self.visible.faces[self.after.faces..])
        {
            let rows = common(&face.rows, &window.rows);
            for first_row in rows.clone().step_by(ROWS) {
                let coverage =
                    Coverage::new(number, face, first_row, self.view.width, self.is_smooth);
                for row in first_row..rows.end.min(first_row + ROWS as u32) {
                    let Some(outer) = coverage.outer_columns(row, columns.clone()) else {
                        continue;
                    };
                    let inverse_depth = &face.plane.inverse_depth;
                    let on_row = inverse_depth.on_row(row, SampleOffset::CENTER);
                    let inner = coverage.center_columns(row, outer.clone());
                    let mut centers = layer.centers.center_row(row as usize);
                    centers.put(inner, |x| (on_row.at(x), face.surface));
                    if let Some(ends) = coverage.smooth_columns(row) {
                        let on_row = SmoothOnRow::of(inverse_depth, row);
                        let mut smooth = layer.smooth.smooth_row(row as usize);
                        smooth.put(outer, ends, on_row, face.surface);
                    }
                }
            }
        }
    }
}

impl RasterLayer {
    fn resize(&mut self, view: &PinholeView) {
        let (width, height) = (view.width as usize, view.height as usize);
        self.centers.resize(width, height);
        self.smooth.resize(width, height);
    }

    /// Copies a window of another layer.
    fn copy(&mut self, other: &Self, window: &PictureWindow, is_smooth: bool) {
        let columns = window.columns();
        if window.is_empty() {
            return;
        }
        for row in window.rows.clone().map(|row| row as usize) {
            (self.centers).copy_columns(row, columns.clone(), &other.centers, row);
            if is_smooth {
                (self.smooth).copy_columns(row, columns.clone(), &other.smooth, row);
            }
        }
    }
}

fn common(one: &Range<u32>, other: &Range<u32>) -> Range<u32> {
    one.start.max(other.start)..one.end.min(other.end)
}

#[cfg(test)]
mod tests {
    use bevy::math::{Quat, Vec3};
    use proptest::prelude::*;
    use tabletop_core::{HeadCamera, Table};
    use tabletop_geometry::{Polyhedron, Pose, Rgb, Solid};

    use super::*;
    use crate::Rasterizer;

    fn solid() -> impl Strategy<Value = DrawnSolid> {
        let place = [-6.0..6.0_f32, -6.0..4.0, -0.2..4.0];
        let axis = [-3.0..3.0_f32, -3.0..3.0, -3.0..3.0];
        let size = [0.2..2.5_f32, 0.2..2.5, 0.2..2.5];
        (place, axis, size, 0..4_u8, 2..200_u32).prop_map(
            |(place, axis, [x, y, z], kind, object)| DrawnSolid {
                pose: Pose::new(place.into(), Quat::from_scaled_axis(axis.into())),
                solid: match kind {
                    0 => Solid::Cuboid(Vec3::new(x, y, z)),
                    1 => Solid::Cylinder {
                        radius: x / 2.0,
                        yspan: y,
                    },
                    2 => Solid::Ball(x / 2.0),
                    _ => Solid::Polyhedron(Polyhedron::ring(x, x / 2.0, z, 24)),
                },
                color: Rgb::new(x / 3.0, y / 3.0, z / 3.0),
                object,
            },
        )
    }

    proptest! {
        #[test]
        fn layers_show_what_is_drawn_at_once(
            ground in proptest::collection::vec(solid(), 0..3),
            kept in proptest::collection::vec(solid(), 0..4),
            before in proptest::collection::vec(solid(), 0..3),
            tried in proptest::collection::vec(solid(), 1..4),
            antialiasing in any::<bool>(),
        ) {
            let table = Table::default();
            let head = HeadCamera { antialiasing, ..HeadCamera::default() };
            let camera = Camera::of_head(&head, &table);
            let mut scene = Scene {
                solids: vec![DrawnSolid::of_table(&table, 1)],
                ..Scene::default()
            };
            scene.solids.extend(ground);
            let other = Scene { solids: before.clone(), ..Scene::default() };
            let mut layers = PictureLayers::of(&other, &Camera { width: 90, ..camera });
            layers.begin(&scene, &camera);
            // Others were tried and kept before.
            layers.keep(&before, &layers.whole());
            layers.draw(&tried, &layers.whole());
            let Some(window) = layers.window_of(&tried) else {
                return Ok(());
            };
            let wide = window.widened(3, [camera.width, camera.height]);
            layers.keep(&kept, &wide);
            layers.draw(&before, &wide);
            let drawn = layers.draw(&tried, &window).clone();

            scene.solids.extend(kept.into_iter().chain(tried));
            let mut whole = Picture::default();
            Rasterizer::alone().draw(&scene, &camera, &mut whole);
            for row in window.rows {
                for column in window.columns.clone() {
                    let i = whole.index(column, row).unwrap();
                    prop_assert_eq!(drawn.color(column, row), whole.color(column, row));
                    prop_assert_eq!(drawn.depth[i].to_bits(), whole.depth[i].to_bits());
                    prop_assert_eq!(drawn.objects[i], whole.objects[i]);
                }
            }
        }
    }
}
