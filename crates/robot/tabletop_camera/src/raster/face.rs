//! Flat faces with straight edges.
//!
//! A face is a cone of rays from the eye, bounded by the planes through the eye and its edges, and cut off at the near
//! plane by one more. On each plane a linear function of the picture's coordinates changes its sign, so no corner is ever
//! projected and nothing has to be clipped, wherever the corners are. One over the depth is a linear function, too.

use std::ops::Range;

use bevy::math::Vec3;

use crate::{
    camera::{Linear, NEAR, PinholeView, SampleOffset},
    raster::{span::DepthPlane, surface::FlatLook},
};

/// Largest distance of the eye from the plane of a face that is seen edge-on, in units: such faces are thinner than a pixel.
pub(crate) const EDGE_ON: f32 = 1e-4;

/// The corners of each face of a cuboid, counterclockwise as seen from outside. A corner's number has a bit for each
/// axis, X the lowest, which is set on the positive side. Faces come in pairs: negative and positive side of X,
/// Y and Z.
pub(crate) const CUBOID: [[usize; 4]; 6] = [
    [0, 4, 6, 2],
    [1, 3, 7, 5],
    [0, 1, 5, 4],
    [3, 2, 6, 7],
    [0, 2, 3, 1],
    [4, 5, 7, 6],
];

/// The outward normal of each face of a cuboid.
pub(crate) const CUBOID_NORMALS: [Vec3; 6] = [
    Vec3::NEG_X,
    Vec3::X,
    Vec3::NEG_Y,
    Vec3::Y,
    Vec3::NEG_Z,
    Vec3::Z,
];

/// Number of rows that are computed together.
pub(crate) const ROWS: usize = 8;

/// A face in the picture.
#[derive(Clone, Debug)]
pub(crate) struct RasterFace {
    /// The rows in which it may be seen.
    pub rows: Range<u32>,
    pub surface: u32,
    pub plane: DepthPlane,
    pub look: FlatLook,
    edges: [Edge; 5],
}

/// For each of some rows, the first column of a face's samples and the one after the last, as whole numbers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Columns {
    pub starts: [f32; ROWS],
    pub ends: [f32; ROWS],
}

/// The condition for a row's samples to lie on the inner side of an edge. For the two faces that share an edge the conditions
/// are complementary to the last bit, so every sample lies in exactly one of them.
#[derive(Clone, Copy, Debug)]
enum Edge {
    /// Not left of `slope * y + offset`.
    From { slope: f32, offset: f32 },
    /// Left of `slope * y + offset`.
    Before { slope: f32, offset: f32 },
    /// For a level edge: rows in which this is positive lie inside as a whole.
    Level { first: f32, down: f32 },
}

impl RasterFace {
    /// The background, behind everything else.
    pub const NOTHING: Self = Self {
        rows: 0..0,
        surface: 0,
        plane: DepthPlane::NOTHING,
        look: FlatLook::NOTHING,
        edges: [Edge::Level {
            first: 0.0,
            down: 0.0,
        }; 5],
    };

    /// The face with these corners, given relative to the eye and counterclockwise as seen from outside, and with this
    /// unit normal; `None` if it is not seen from outside.
    pub fn seen(
        view: &PinholeView,
        corners: [Vec3; 4],
        normal: Vec3,
        rows: Range<u32>,
        surface: u32,
        look: impl FnOnce() -> FlatLook,
    ) -> Option<Self> {
        let distance = -normal.dot(corners[0]);
        if distance < EDGE_ON {
            return None;
        }
        let inverse_depth = view.rays.dot(normal / -distance);
        let behind_near_plane = Linear {
            first: 1.0 / NEAR - inverse_depth.first,
            right: -inverse_depth.right,
            down: -inverse_depth.down,
        };
        let [a, b, c, d] = corners;
        let edge = |from: Vec3, to: Vec3| Edge::from(view.rays.dot(to.cross(from)));
        Some(Self {
            rows,
            surface,
            look: look(),
            plane: DepthPlane::new(inverse_depth, view.width, view.height),
            edges: [
                edge(a, b),
                edge(b, c),
                edge(c, d),
                edge(d, a),
                Edge::from(behind_near_plane),
            ],
        })
    }

    /// The samples of some rows, starting at `first_row`, that lie inside all edges.
    pub fn columns(&self, first_row: u32, offset: SampleOffset, width: u32) -> Columns {
        let mut columns = Columns {
            starts: [0.0; ROWS],
            ends: [width as f32; ROWS],
        };
        let y: [f32; ROWS] =
            std::array::from_fn(|i| (first_row as i32 + i as i32) as f32 + offset.y);
        for edge in &self.edges {
            edge.bound(&y, offset.x, &mut columns);
        }
        for ends in [&mut columns.starts, &mut columns.ends] {
            for column in ends {
                *column = not_left_of(*column, width as f32);
            }
        }
        columns
    }
}

impl Edge {
    // Simple comparisons let the compiler do several rows at once. NaN counts as 0.
    fn bound(&self, y: &[f32; ROWS], x_offset: f32, columns: &mut Columns) {
        match *self {
            Self::From { slope, offset } => {
                for (start, y) in columns.starts.iter_mut().zip(y) {
                    let x = slope * y + offset - x_offset;
                    *start = if x > *start { x } else { *start };
                }
            }
            Self::Before { slope, offset } => {
                for (end, y) in columns.ends.iter_mut().zip(y) {
                    let x = slope * y + offset - x_offset;
                    let x = if x > 0.0 { x } else { 0.0 };
                    *end = if x < *end { x } else { *end };
                }
            }
            Self::Level { first, down } => {
                for (end, y) in columns.ends.iter_mut().zip(y) {
                    let value = first + down * y;
                    let is_out = (value < 0.0) | ((value == 0.0) & (down < 0.0));
                    *end = if is_out { 0.0 } else { *end };
                }
            }
        }
    }
}

/// The first column that is not left of x, from 0 to the width.
#[inline]
fn not_left_of(x: f32, width: f32) -> f32 {
    // From 2^23 on there are only whole numbers.
    const WHOLE: f32 = 8_388_608.0;
    let x = if x < width { x } else { width };
    let nearest = x + WHOLE - WHOLE;
    nearest + if x > nearest { 1.0 } else { 0.0 }
}

impl From<Linear> for Edge {
    /// The edge of the side on which this is positive.
    fn from(Linear { first, right, down }: Linear) -> Self {
        if right == 0.0 {
            return Self::Level { first, down };
        }
        let (slope, offset) = (-down / right, -first / right);
        if right > 0.0 {
            Self::From { slope, offset }
        } else {
            Self::Before { slope, offset }
        }
    }
}

#[cfg(test)]
mod tests {
    use bevy::math::Quat;
    use proptest::prelude::*;
    use tabletop_geometry::Pose;

    use super::*;
    use crate::Camera;

    const WIDTH: u32 = 33;
    const HEIGHT: u32 = 25;

    fn view() -> PinholeView {
        PinholeView::of(&Camera {
            pose: Pose::IDENTITY,
            vertical_fov: 1.0,
            square_fov: false,
            width: WIDTH,
            height: HEIGHT,
            antialiasing: false,
            light: tabletop_core::LIGHT,
        })
    }

    fn corners(pose: Pose, span: Vec3) -> [Vec3; 8] {
        std::array::from_fn(|corner| {
            let side = |axis: usize| (corner >> axis & 1) as f32 - 0.5;
            pose * (span * Vec3::new(side(0), side(1), side(2)))
        })
    }

    fn columns_in(face: &RasterFace, row: u32, offset: SampleOffset) -> Range<usize> {
        let columns = face.columns(row, offset, WIDTH);
        let (start, end) = (columns.starts[0] as usize, columns.ends[0] as usize);
        start.min(end)..end
    }

    /// Number of a cuboid's faces that cover each sample.
    fn coverage(pose: Pose, span: Vec3, offset: SampleOffset) -> Vec<u32> {
        let corners = corners(pose, span);
        let mut coverage = vec![0; (WIDTH * HEIGHT) as usize];
        for (face, normal) in CUBOID.into_iter().zip(CUBOID_NORMALS) {
            let corners = face.map(|corner| corners[corner]);
            let normal = pose.rotation * normal;
            let Some(face) =
                RasterFace::seen(&view(), corners, normal, 0..HEIGHT, 1, || FlatLook::NOTHING)
            else {
                continue;
            };
            for (row, covered) in (0..HEIGHT).zip(coverage.chunks_mut(WIDTH as usize)) {
                for covered in &mut covered[columns_in(&face, row, offset)] {
                    *covered += 1;
                }
            }
        }
        coverage
    }

    fn is_hit(pose: Pose, span: Vec3, offset: SampleOffset, sample: usize) -> bool {
        let (column, row) = (sample as u32 % WIDTH, sample as u32 / WIDTH);
        let ray = view()
            .rays
            .through(column as f32 + offset.x, row as f32 + offset.y);
        let (origin, ray) = (pose.inverse() * Vec3::ZERO, pose.rotation.inverse() * ray);
        let [one, other] = [-0.5, 0.5].map(|side| (span * side - origin) / ray);
        let (enter, leave) = (one.min(other).max_element(), one.max(other).min_element());
        enter < leave && enter > 0.0
    }

    fn assert_covered_once(pose: Pose, span: Vec3, offset: SampleOffset) {
        for (sample, faces) in coverage(pose, span, offset).into_iter().enumerate() {
            assert!(faces <= 1, "sample {sample} lies in {faces} faces");
            if is_hit(pose, span * 0.999, offset, sample) {
                assert_eq!(faces, 1, "sample {sample} lies in no face");
            }
            if !is_hit(pose, span * 1.001, offset, sample) {
                assert_eq!(faces, 0, "sample {sample} lies outside");
            }
        }
    }

    /// The samples of a face, each 1 if it lies in it.
    fn samples_in(corners: [Vec3; 4]) -> Vec<u32> {
        let normal = (corners[1] - corners[0]).cross(corners[3] - corners[0]);
        let normal = normal.normalize();
        let face = RasterFace::seen(&view(), corners, normal, 0..HEIGHT, 1, || FlatLook::NOTHING)
            .expect("it faces the eye");
        let row = |row| {
            let mut samples = [0; WIDTH as usize];
            samples[columns_in(&face, row, SampleOffset::CENTER)].fill(1);
            samples
        };
        (0..HEIGHT).flat_map(row).collect()
    }

    #[test]
    fn samples_on_an_edge_lie_in_one_of_its_faces() {
        // Two slopes of a roof, whose ridge is seen exactly through the middle row or column of samples.
        for turn in [
            |point: Vec3| point,
            |point: Vec3| Vec3::new(-point.y, point.x, point.z),
        ] {
            let [left, right] = [-1.0, 1.0].map(|x| turn(Vec3::new(x, 0.0, -4.0)));
            let [low, high] = [-1.0, 1.0].map(|y| [-1.0, 1.0].map(|x| turn(Vec3::new(x, y, -5.0))));
            let upper = samples_in([left, right, high[1], high[0]]);
            let lower = samples_in([right, left, low[0], low[1]]);
            let both: Vec<_> = upper.iter().zip(&lower).map(|(a, b)| a + b).collect();
            assert!(both.iter().all(|&faces| faces <= 1));
            let middle = (HEIGHT / 2 * WIDTH + WIDTH / 2) as usize;
            assert_eq!(both[middle], 1);
            assert!([&upper, &lower].map(|face| face.iter().sum::<u32>() > 30) == [true; 2]);
        }
    }

    proptest! {
        #[test]
        fn every_sample_on_a_solid_lies_in_exactly_one_face(
            location in [-3.0..3.0_f32, -3.0..3.0, -12.0..-4.0],
            axis in [-3.0..3.0_f32, -3.0..3.0, -3.0..3.0],
            span in [0.3..3.0_f32, 0.3..3.0, 0.3..3.0],
            which in 0..4_usize,
        ) {
            let pose = Pose::new(location.into(), Quat::from_scaled_axis(axis.into()));
            assert_covered_once(pose, span.into(), SampleOffset::CENTER);
            assert_covered_once(pose, span.into(), SampleOffset::SMOOTH[which]);
        }
    }
}
