//! Spans: parts of a row of pixels that see one face with all their samples.

use std::ops::Range;

use crate::camera::{Linear, SampleOffset};

/// Neighbouring pixels of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Span {
    pub start: u32,
    pub end: u32,
    pub sees: Sees,
}

/// The faces that pixels see.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sees {
    /// One face, with all samples.
    Face(u32),
    /// Perhaps several faces.
    Several,
}

/// The plane of a face: one over the depth where the rays meet it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DepthPlane {
    pub inverse_depth: Linear,
    /// Largest error, anywhere in the picture, of a number computed from it.
    pub rounding: f32,
}

/// A face in a row of pixels.
#[derive(Clone, Debug)]
pub(crate) struct FaceInRow {
    pub face: u32,
    /// The pixels with all samples in it.
    pub inner: Range<u32>,
    /// The pixels with a sample in it.
    pub outer: Range<u32>,
}

/// The order of two faces in some pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Order {
    Nearer,
    Farther,
    Unclear,
}

/// A row of pixels, divided into spans.
#[derive(Clone, Debug, Default)]
pub(crate) struct SpanList {
    spans: Vec<Span>,
    before: Vec<Span>,
}

impl DepthPlane {
    /// Infinitely far away.
    pub const NOTHING: Self = Self {
        inverse_depth: Linear::constant(0.0),
        rounding: 0.0,
    };

    /// The plane in a picture of this size.
    pub fn new(inverse_depth: Linear, width: u32, height: u32) -> Self {
        /// About eight times a rounding error.
        const ROUNDING: f32 = 1e-6;
        let Linear { first, right, down } = inverse_depth;
        let largest = first.abs() + right.abs() * width as f32 + down.abs() * height as f32;
        Self {
            inverse_depth,
            rounding: ROUNDING * largest,
        }
    }

    /// Its order to another plane in all samples of some pixels of a row. The samples are at most `reach` from the pixels' centres.
    fn order(&self, other: &Self, row: f32, columns: Range<u32>, reach: f32) -> Order {
        let (one, two) = (&self.inverse_depth, &other.inverse_depth);
        let (right, down) = (one.right - two.right, one.down - two.down);
        let first = one.first - two.first + down * row;
        let ends = [columns.start, columns.end - 1].map(|x| first + right * x as i32 as f32);
        let slack = reach * (right.abs() + down.abs()) + self.rounding + other.rounding;
        if ends[0] > slack && ends[1] > slack {
            Order::Nearer
        } else if ends[0] < -slack && ends[1] < -slack {
            Order::Farther
        } else {
            Order::Unclear
        }
    }
}

impl SpanList {
    /// Clears the row, which then sees nothing.
    pub fn clear(&mut self, width: u32) {
        self.spans.clear();
        self.spans.push(Span {
            start: 0,
            end: width,
            sees: Sees::Face(0),
        });
    }

    pub fn spans(&self) -> &[Span] {
        &self.spans
    }

    /// Adds a face. `plane_of` knows the planes of all.
    pub fn insert<'a>(
        &mut self,
        added: &FaceInRow,
        row: u32,
        is_smooth: bool,
        plane_of: impl Fn(u32) -> &'a DepthPlane,
    ) {
        let Range { start, end } = added.outer;
        if start >= end {
            return;
        }
        let reach = if is_smooth { SampleOffset::REACH } else { 0.0 };
        let row = row as f32;
        let plane = plane_of(added.face);
        // Empty, if no pixel has all its samples in it.
        let inner_start = added.inner.start.clamp(start, end);
        let inner_end = added.inner.end.clamp(inner_start, end);
        let parts = [
            (start..inner_start, Sees::Several),
            (inner_start..inner_end, Sees::Face(added.face)),
            (inner_end..end, Sees::Several),
        ];
        let first = self.spans.iter().take_while(|span| span.end <= start);
        let first = first.count();
        // Usually all of it is before or behind one face.
        let around = self.spans[first];
        if let Sees::Face(seen) = around.sees
            && around.end >= end
        {
            match plane.order(plane_of(seen), row, start..end, reach) {
                Order::Farther => return,
                Order::Nearer => {
                    self.replace(first, around, parts);
                    return;
                }
                Order::Unclear => {}
            }
        }
        std::mem::swap(&mut self.spans, &mut self.before);
        let before = &self.before;
        self.spans.clear();
        self.spans.extend_from_slice(&before[..first]);
        let mut rest = before.len();
        for (i, span) in before.iter().enumerate().skip(first) {
            if span.start >= end {
                rest = i;
                break;
            }
            push(&mut self.spans, span.start..span.end.min(start), span.sees);
            for (part, sees) in &parts {
                let columns = part.start.max(span.start)..part.end.min(span.end);
                if columns.is_empty() {
                    continue;
                }
                let sees = match span.sees {
                    Sees::Several => Sees::Several,
                    Sees::Face(seen) => {
                        match plane.order(plane_of(seen), row, columns.clone(), reach) {
                            Order::Nearer => *sees,
                            Order::Farther => span.sees,
                            Order::Unclear => Sees::Several,
                        }
                    }
                };
                push(&mut self.spans, columns, sees);
            }
            push(&mut self.spans, span.start.max(end)..span.end, span.sees);
        }
        self.spans.extend_from_slice(&before[rest..]);
    }

    /// Puts parts of a span in its place.
    fn replace(&mut self, i: usize, span: Span, [left, middle, right]: [(Range<u32>, Sees); 3]) {
        let (start, end) = (left.0.start, right.0.end);
        let parts = [
            (span.start..start, span.sees),
            left,
            middle,
            right,
            (end..span.end, span.sees),
        ];
        let mut spans = [span; 5];
        let mut count = 0;
        for (Range { start, end }, sees) in parts {
            if start < end {
                spans[count] = Span { start, end, sees };
                count += 1;
            }
        }
        let length = self.spans.len();
        self.spans.resize(length + count - 1, span);
        self.spans.copy_within(i + 1..length, i + count);
        self.spans[i..i + count].copy_from_slice(&spans[..count]);
    }
}

/// Adds pixels to the right end of a row.
fn push(spans: &mut Vec<Span>, columns: Range<u32>, sees: Sees) {
    let Range { start, end } = columns;
    if start >= end {
        return;
    }
    match spans.last_mut() {
        Some(last) if last.sees == sees => last.end = end,
        _ => spans.push(Span { start, end, sees }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Planes parallel to the picture at these inverse depths.
    fn planes(inverse_depths: &[f32]) -> Vec<DepthPlane> {
        let plane = |&near| DepthPlane::new(Linear::constant(near), 20, 1);
        inverse_depths.iter().map(plane).collect()
    }

    fn spans(planes: &[DepthPlane], faces: &[(u32, Range<u32>)]) -> Vec<(u32, u32, Sees)> {
        let mut list = SpanList::default();
        list.clear(20);
        for (face, outer) in faces {
            let added = FaceInRow {
                face: *face,
                inner: outer.start + 1..outer.end - 1,
                outer: outer.clone(),
            };
            list.insert(&added, 0, true, |face| &planes[face as usize]);
        }
        let spans = list.spans().iter();
        spans
            .map(|span| (span.start, span.end, span.sees))
            .collect()
    }

    #[test]
    fn the_rim_of_the_nearer_face_sees_several_faces() {
        use Sees::{Face, Several};
        let planes = planes(&[0.0, 0.1, 0.2]);
        assert_eq!(
            spans(&planes, &[(1, 0..20), (2, 4..10)]),
            [
                (0, 1, Several),
                (1, 4, Face(1)),
                (4, 5, Several),
                (5, 9, Face(2)),
                (9, 10, Several),
                (10, 19, Face(1)),
                (19, 20, Several),
            ]
        );
    }

    #[test]
    fn a_farther_face_changes_nothing() {
        let planes = planes(&[0.0, 0.1, 0.2]);
        let near = (2, 0..20);
        assert_eq!(
            spans(&planes, &[near.clone(), (1, 4..10)]),
            spans(&planes, &[near])
        );
    }

    #[test]
    fn a_span_of_equally_near_faces_sees_several() {
        let planes = planes(&[0.0, 0.1, 0.1]);
        let seen = spans(&planes, &[(1, 0..20), (2, 4..10)]);
        assert!(seen.contains(&(4, 10, Sees::Several)));
    }
}
