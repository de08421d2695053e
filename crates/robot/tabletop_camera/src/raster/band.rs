//! Drawing of a band of rows of a picture.
//!
//! Faces come first. Most pixels see one face with all their samples; these are found as spans and need no samples. Where that is
//! not clear, and where quadrics, figures or transparent spheres may be seen, the nearest surface is found sample by sample.

use std::ops::Range;

use crate::{
    camera::{PictureWindow, PinholeView, SampleOffset},
    raster::{
        backdrop::Backdrop,
        coverage::Coverage,
        face::ROWS,
        resolve::{Pixels, RowResolver},
        samples::{CenterSamples, SmoothOnRow, SmoothSamples},
        span::{Sees, Span, SpanList},
        transparent::{Blend, TransparentSpheres},
        visible::VisibleSurfaces,
    },
};

/// The scene and camera of a picture that is being drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame<'a> {
    pub view: &'a PinholeView,
    pub visible: &'a VisibleSurfaces,
    pub spheres: &'a TransparentSpheres,
    pub backdrop: &'a Backdrop,
    pub is_smooth: bool,
}

/// The memory for drawing a band.
#[derive(Clone, Debug, Default)]
pub(crate) struct Band {
    coverages: Vec<Coverage>,
    /// The faces that the pixels of each row see.
    faces: Vec<SpanList>,
    /// The columns that may see more than faces, from the left.
    dense: Vec<Range<u32>>,
    centers: CenterSamples,
    smooth: SmoothSamples,
    /// One row of one sample a pixel.
    single: CenterSamples,
    blend: Blend,
}

impl Band {
    /// Draws these whole rows, at most [`ROWS`].
    pub fn draw(&mut self, frame: &Frame, first_row: u32, pixels: Pixels) {
        let width = frame.view.width as usize;
        let count = pixels.depth.len() / width;
        let rows = first_row..first_row + count as u32;
        self.find_faces(frame, rows.clone());
        self.find_dense(frame, &rows);
        self.sample_surfaces(frame, rows.clone());
        for (row, mut pixels) in rows.zip(pixels.parts(width)) {
            let i = (row - first_row) as usize;
            self.paint_row(frame, row, i, &mut pixels);
            self.blend_row(frame, row, i, pixels.rgb);
        }
    }

    /// Finds the nearest surface at every sample of these whole rows, at most [`ROWS`].
    pub fn sample(&mut self, frame: &Frame, rows: Range<u32>) -> (&CenterSamples, &SmoothSamples) {
        self.find_faces(frame, rows.clone());
        self.dense.clear();
        self.dense.push(0..frame.view.width);
        self.sample_surfaces(frame, rows);
        (&self.centers, &self.smooth)
    }

    /// Finds the nearest surface at each sample of these rows that has to be known.
    fn sample_surfaces(&mut self, frame: &Frame, rows: Range<u32>) {
        let width = frame.view.width as usize;
        self.centers.resize(width, ROWS);
        if frame.is_smooth {
            self.smooth.resize(width, ROWS);
        }
        for row in rows.clone() {
            self.sample_faces(frame, row, rows.start);
        }
        self.draw_quadrics(frame, rows.clone());
        self.draw_triangles(frame, rows);
    }

    /// Finds the faces that parts of the rows see.
    fn find_faces(&mut self, frame: &Frame, rows: Range<u32>) {
        let Frame { view, visible, .. } = *frame;
        self.faces.resize_with(ROWS, SpanList::default);
        self.coverages.clear();
        for (number, face) in (0..).zip(&visible.faces) {
            if face.rows.start < rows.end && rows.start < face.rows.end {
                let coverage = Coverage::new(number, face, rows.start, view.width, frame.is_smooth);
                self.coverages.push(coverage);
            }
        }
        for (row, faces) in rows.zip(&mut self.faces) {
            faces.clear(view.width);
            for added in self.coverages.iter().filter_map(|face| face.in_row(row)) {
                faces.insert(&added, row, frame.is_smooth, |face| {
                    &visible.faces[face as usize].plane
                });
            }
        }
    }

    /// Finds the columns that may see more than faces.
    fn find_dense(&mut self, frame: &Frame, rows: &Range<u32>) {
        self.dense.clear();
        let quadrics = frame.visible.quadrics.iter().map(|quadric| &quadric.window);
        let figures = frame.visible.figure_windows();
        for window in quadrics.chain(figures).chain(frame.spheres.windows()) {
            if !rows_of(window, rows).is_empty() {
                join(&mut self.dense, window.columns.clone());
            }
        }
    }

    /// Finds the nearest face at each sample that has to be known.
    fn sample_faces(&mut self, frame: &Frame, row: u32, first_row: u32) {
        let i = (row - first_row) as usize;
        let mut centers = self.centers.center_row(i);
        for span in self.faces[i].spans() {
            match span.sees {
                Sees::Face(face) => {
                    let face = &frame.visible.faces[face as usize];
                    let inverse_depth = &face.plane.inverse_depth;
                    for dense in dense_in(&self.dense, span) {
                        let columns = dense.start as usize..dense.end as usize;
                        let on_row = inverse_depth.on_row(row, SampleOffset::CENTER);
                        centers.fill(columns.clone(), on_row, face.surface);
                        if frame.is_smooth {
                            let on_row = SmoothOnRow::of(inverse_depth, row);
                            let mut smooth = self.smooth.smooth_row(i);
                            smooth.fill(columns, on_row, face.surface);
                        }
                    }
                }
                Sees::Several => {
                    let columns = span.start as usize..span.end as usize;
                    let mut smooth = frame.is_smooth.then(|| self.smooth.smooth_row(i));
                    centers.clear(columns.clone());
                    if let Some(smooth) = &mut smooth {
                        smooth.clear(columns.clone());
                    }
                    for coverage in &self.coverages {
                        let Some(columns) = coverage.outer_columns(row, columns.clone()) else {
                            continue;
                        };
                        let face = &frame.visible.faces[coverage.face as usize];
                        let inverse_depth = &face.plane.inverse_depth;
                        let on_row = inverse_depth.on_row(row, SampleOffset::CENTER);
                        let inner = coverage.center_columns(row, columns.clone());
                        centers.put(inner, |x| (on_row.at(x), face.surface));
                        if let Some(smooth) = &mut smooth
                            && let Some(ends) = coverage.smooth_columns(row)
                        {
                            let on_row = SmoothOnRow::of(inverse_depth, row);
                            smooth.put(columns, ends, on_row, face.surface);
                        }
                    }
                }
            }
        }
    }

    /// Draws balls and cylinders where they are nearer than faces.
    fn draw_quadrics(&mut self, frame: &Frame, rows: Range<u32>) {
        for quadric in &frame.visible.quadrics {
            let smooth = frame.is_smooth.then_some(&mut self.smooth);
            let own = rows_of(&quadric.window, &rows);
            quadric.draw_rows(own, rows.start, &mut self.centers, smooth, &mut self.single);
        }
    }

    /// Draws figures where they are nearer than everything else.
    fn draw_triangles(&mut self, frame: &Frame, rows: Range<u32>) {
        for triangle in frame.visible.triangles_in_band(rows.start / ROWS as u32) {
            let first = triangle.rows.start.max(rows.start);
            let end = triangle.rows.end.min(rows.end);
            let mut row = first;
            while row < end {
                let four = row..end.min(row + 4);
                triangle.draw_centers(four, rows.start, &mut self.centers);
                row += 4;
            }
            if frame.is_smooth {
                for row in first..end {
                    triangle.draw_smooth(row, rows.start, &mut self.smooth);
                }
            }
        }
    }

    /// Paints a row.
    fn paint_row(&mut self, frame: &Frame, row: u32, i: usize, pixels: &mut Pixels) {
        let mut row = RowResolver {
            visible: frame.visible,
            backdrop: frame.backdrop,
            row,
            centers: self.centers.center_row(i),
            smooth: frame.is_smooth.then(|| self.smooth.smooth_row(i)),
            pixels,
        };
        // Neighbouring pixels whose samples are known are painted together.
        let mut sampled = 0..0;
        for span in self.faces[i].spans() {
            let Sees::Face(face) = span.sees else {
                sampled.end = span.end as usize;
                continue;
            };
            let mut start = span.start;
            let rest = std::iter::once(span.end..span.end);
            for dense in dense_in(&self.dense, span).chain(rest) {
                if start < dense.start {
                    row.paint_samples(sampled);
                    row.paint_face(face, start as usize..dense.start as usize);
                    sampled = dense.start as usize..dense.start as usize;
                }
                sampled.end = dense.end as usize;
                start = dense.end;
            }
        }
        row.paint_samples(sampled);
    }

    /// Blends transparent spheres into the colours of a row.
    fn blend_row(&mut self, frame: &Frame, row: u32, i: usize, rgb: &mut [u8]) {
        let Frame { view, spheres, .. } = *frame;
        let lighting = &frame.visible.lighting;
        if frame.is_smooth {
            let samples = self.smooth.smooth_row(i);
            let nearest = |sample, column: usize| samples.inverse_depth[column][sample];
            spheres.blend(
                view,
                lighting,
                row,
                &SampleOffset::SMOOTH,
                nearest,
                &mut self.blend,
                rgb,
            );
        } else {
            let samples = self.centers.center_row(i);
            let nearest = |_, column: usize| samples.inverse_depth[column];
            spheres.blend(
                view,
                lighting,
                row,
                &[SampleOffset::CENTER],
                nearest,
                &mut self.blend,
                rgb,
            );
        }
    }
}

/// Adds a range of columns to disjoint ones.
fn join(ranges: &mut Vec<Range<u32>>, mut added: Range<u32>) {
    let first = ranges.partition_point(|range| range.end < added.start);
    let end = first + ranges[first..].partition_point(|range| range.start <= added.end);
    if let Some(touched) = ranges.get(first..end).filter(|touched| !touched.is_empty()) {
        added.start = added.start.min(touched[0].start);
        added.end = added.end.max(touched[touched.len() - 1].end);
    }
    ranges.splice(first..end, [added]);
}

/// The parts of dense columns that a span has.
fn dense_in(dense: &[Range<u32>], span: &Span) -> impl Iterator<Item = Range<u32>> {
    let parts = dense
        .iter()
        .map(|dense| dense.start.max(span.start)..dense.end.min(span.end));
    parts.filter(|part| !part.is_empty())
}

/// The rows of a window that are among these.
fn rows_of(window: &PictureWindow, rows: &Range<u32>) -> Range<u32> {
    window.rows.start.max(rows.start)..window.rows.end.min(rows.end)
}
