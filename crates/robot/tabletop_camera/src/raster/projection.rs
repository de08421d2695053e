//! The triangles of a figure that a camera may see, four at a time.

use std::ops::Range;

use bevy::math::{Mat3, Vec3, Vec4};

use crate::{
    camera::{FourVectors, PictureWindow, PinholeView, SampleOffset, transposed},
    raster::{
        face::EDGE_ON,
        samples::{column, first_columns},
    },
    scene::{DrawnFigure, Facets, FourPlanes},
};

/// The triangles of a figure that a camera may see, and the memory for finding them.
#[derive(Clone, Debug, Default)]
pub(crate) struct FigureProjection {
    /// The columns and rows of the vertices; NaN for those that are not in front of the camera.
    pixels: Vec<[Vec4; 4]>,
    /// The triangles that face the eye.
    facing: Vec<u32>,
    seen: Vec<SeenFacet>,
}

/// A triangle that may be seen.
#[derive(Clone, Debug)]
pub(crate) struct SeenFacet {
    /// Its number in the figure.
    pub facet: u32,
    /// The rows in which it may be seen.
    pub rows: Range<u32>,
    /// The first row that it would have with smooth edges: triangles are drawn in this order.
    pub comes_up: u32,
}

impl FigureProjection {
    /// Finds the triangles of a figure, in their order, that may be seen. Returns the window around them.
    pub fn find(&mut self, drawn: &DrawnFigure, view: &PinholeView) -> Option<PictureWindow> {
        let facets = &*drawn.facets;
        let pixels_of = view.pixels_of(drawn.pose);
        self.pixels.clear();
        self.pixels.extend(facets.places.iter().map(|&places| {
            let [columns, rows] = pixels_of(places);
            transposed([columns, rows, columns, rows])
        }));
        self.find_facing(facets, drawn.pose.inverse() * view.eye);
        self.find_seen(drawn, view)
    }

    /// The triangles that were found.
    pub fn seen(&self) -> &[SeenFacet] {
        &self.seen
    }

    fn find_facing(&mut self, facets: &Facets, eye: Vec3) {
        self.facing.clear();
        for (planes, first) in facets.planes.iter().zip((0..).step_by(4)) {
            let mut lanes = planes.facing(eye);
            while lanes != 0 {
                self.facing.push(first + lanes.trailing_zeros());
                lanes &= lanes - 1;
            }
        }
    }

    fn find_seen(&mut self, drawn: &DrawnFigure, view: &PinholeView) -> Option<PictureWindow> {
        /// Room for rounding, in pixels.
        const ROUNDING: f32 = 0.01;
        /// The same without smooth edges.
        const ROUNDING_OF_CENTERS: f32 = 0.1;
        let smooth_reach = Vec4::splat(SampleOffset::REACH + ROUNDING);
        let reach = match view.reach > 0.0 {
            true => smooth_reach,
            false => Vec4::splat(ROUNDING_OF_CENTERS),
        };
        let triangles = &drawn.facets.triangles;
        let pixels = self.pixels.as_flattened();
        let [width, height] = [view.width, view.height].map(|count| Vec4::splat(count as f32));
        self.seen.clear();
        let mut around: Option<PictureWindow> = None;
        for four in self.facing.chunks(4) {
            let corners = lanes_of(four, |&facet| triangles[facet as usize].corners);
            let corner = |number: usize| {
                let [columns, rows, ..] = transposed([
                    pixels[corners[0][number] as usize],
                    pixels[corners[1][number] as usize],
                    pixels[corners[2][number] as usize],
                    pixels[corners[3][number] as usize],
                ]);
                (columns, rows)
            };
            let ((ax, ay), (bx, by), (cx, cy)) = (corner(0), corner(1), corner(2));
            let (least_x, least_y) = (ax.min(bx).min(cx), ay.min(by).min(cy));
            let (most_x, most_y) = (ax.max(bx).max(cx), ay.max(by).max(cy));
            let columns = [
                first_columns(least_x - reach, width),
                first_columns(most_x + reach, width),
            ];
            let rows = [
                first_columns(least_y - reach, height),
                first_columns(most_y + reach, height),
            ];
            let comes_up = first_columns(least_y - smooth_reach, height).to_array();
            let is_behind = (ax.is_nan_mask() | bx.is_nan_mask() | cx.is_nan_mask()).bitmask();
            let is_seen = columns[0].cmplt(columns[1]) & rows[0].cmplt(rows[1]);
            let mut lanes = (is_seen.bitmask() | is_behind) & ((1 << four.len()) - 1);
            let columns = [columns[0].to_array(), columns[1].to_array()];
            let rows = [rows[0].to_array(), rows[1].to_array()];
            while lanes != 0 {
                let lane = lanes.trailing_zeros() as usize;
                lanes &= lanes - 1;
                let (own, comes_up) = if is_behind >> lane & 1 == 1 {
                    if is_beside(drawn, view, corners[lane]) {
                        continue;
                    }
                    let all = PictureWindow {
                        columns: 0..view.width,
                        rows: 0..view.height,
                    };
                    (all, 0)
                } else {
                    let range = |ends: &[[f32; 4]; 2]| {
                        column(ends[0][lane]) as u32..column(ends[1][lane]) as u32
                    };
                    let columns = range(&columns);
                    let own = PictureWindow {
                        // A column more on both sides, for rounding errors.
                        columns: columns.start.saturating_sub(1)..(columns.end + 1).min(view.width),
                        rows: range(&rows),
                    };
                    (own, column(comes_up[lane]) as u32)
                };
                self.seen.push(SeenFacet {
                    facet: four[lane],
                    rows: own.rows.clone(),
                    comes_up,
                });
                around = Some(around.map_or(own.clone(), |around| around.joined(&own)));
            }
        }
        around
    }
}

impl FourPlanes {
    /// A bit for each lane, set if the eye, given in the frame of the figure, is on the outer side.
    #[inline]
    fn facing(&self, eye: Vec3) -> u32 {
        let outside = self.normals.dot(FourVectors::splat(eye)) - self.heights;
        outside.cmpge(Vec4::splat(EDGE_ON)).bitmask()
    }
}

/// Something of each of up to four, and that of the last one in the lanes that are left.
#[inline]
pub(crate) fn lanes_of<'a, T, U>(few: &'a [T], of: impl Fn(&'a T) -> U) -> [U; 4] {
    let last = few.len() - 1;
    [
        of(&few[0]),
        of(&few[last.min(1)]),
        of(&few[last.min(2)]),
        of(&few[last.min(3)]),
    ]
}

/// True if a triangle with these corners is beside the view.
fn is_beside(drawn: &DrawnFigure, view: &PinholeView, corners: [u32; 3]) -> bool {
    let axes = Mat3::from_quat(drawn.pose.rotation);
    view.is_beside(&corners.map(|corner| {
        let place = drawn.facets.vertices[corner as usize].place.truncate();
        axes * place + drawn.pose.location - view.eye
    }))
}
