//! Coverage: the pixels of a band of rows that faces cover.

use std::ops::Range;

use bevy::math::Vec4;

use crate::{
    camera::SampleOffset,
    raster::{
        face::{Columns, RasterFace},
        samples::column,
        span::FaceInRow,
    },
};

/// The coverage of some rows by a face.
#[derive(Clone, Debug)]
pub(crate) struct Coverage {
    pub face: u32,
    first_row: u32,
    rows: Range<u32>,
    center: Columns,
    smooth: Option<[Columns; 4]>,
    /// The pixels of each row with all samples in the face, and those with one.
    inner: Columns,
    outer: Columns,
}

impl Coverage {
    /// Of the rows from this one on.
    pub fn new(
        number: u32,
        face: &RasterFace,
        first_row: u32,
        width: u32,
        is_smooth: bool,
    ) -> Self {
        let center = face.columns(first_row, SampleOffset::CENTER, width);
        let smooth = is_smooth
            .then(|| SampleOffset::SMOOTH.map(|offset| face.columns(first_row, offset, width)));
        let (mut inner, mut outer) = (center, center);
        for sample in smooth.iter().flatten() {
            inner = Columns {
                starts: larger(inner.starts, sample.starts),
                ends: smaller(inner.ends, sample.ends),
            };
            outer = Columns {
                starts: smaller(outer.starts, sample.starts),
                ends: larger(outer.ends, sample.ends),
            };
        }
        Self {
            face: number,
            first_row,
            rows: face.rows.clone(),
            center,
            smooth,
            inner,
            outer,
        }
    }

    /// The coverage of a row, if the face may be seen in it.
    pub fn in_row(&self, row: u32) -> Option<FaceInRow> {
        let i = self.index(row)?;
        let columns =
            |columns: &Columns| column(columns.starts[i]) as u32..column(columns.ends[i]) as u32;
        Some(FaceInRow {
            face: self.face,
            inner: columns(&self.inner),
            outer: columns(&self.outer),
        })
    }

    /// Those of these pixels of a row that have a sample in the face.
    pub fn outer_columns(&self, row: u32, columns: Range<usize>) -> Option<Range<usize>> {
        let i = self.index(row)?;
        let columns = self.outer.within(i, columns);
        (columns.start < columns.end).then_some(columns)
    }

    /// Those of these pixels of a row whose centres are in the face, which may be seen in the row.
    pub fn center_columns(&self, row: u32, columns: Range<usize>) -> Range<usize> {
        let columns = self.center.within((row - self.first_row) as usize, columns);
        columns.start.min(columns.end)..columns.end
    }

    /// The first column, and the one after the last, in which the smooth samples of a row are in the face, which may be seen in the row.
    pub fn smooth_columns(&self, row: u32) -> Option<[Vec4; 2]> {
        let i = (row - self.first_row) as usize;
        let [a, b, c, d] = self.smooth.as_ref()?;
        Some([
            Vec4::new(a.starts[i], b.starts[i], c.starts[i], d.starts[i]),
            Vec4::new(a.ends[i], b.ends[i], c.ends[i], d.ends[i]),
        ])
    }

    fn index(&self, row: u32) -> Option<usize> {
        self.rows
            .contains(&row)
            .then(|| (row - self.first_row) as usize)
    }
}

impl Columns {
    /// Those of the columns of a row that are among these; none, if they end before they start.
    fn within(&self, i: usize, columns: Range<usize>) -> Range<usize> {
        let (start, end) = (column(self.starts[i]), column(self.ends[i]));
        start.max(columns.start)..end.min(columns.end)
    }
}

fn larger<const N: usize>(a: [f32; N], b: [f32; N]) -> [f32; N] {
    std::array::from_fn(|i| if a[i] > b[i] { a[i] } else { b[i] })
}

fn smaller<const N: usize>(a: [f32; N], b: [f32; N]) -> [f32; N] {
    std::array::from_fn(|i| if a[i] < b[i] { a[i] } else { b[i] })
}
