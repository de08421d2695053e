//! Transparent spheres: they are blended into the picture of everything opaque.

use bevy::math::{Vec3, Vec4};
use tabletop_core::Markers;
use tabletop_geometry::{Pose, Solid};

use crate::{
    camera::{PictureWindow, PinholeView, SampleOffset},
    color::{nearest_bytes, scaled_to_bytes},
    raster::{
        bounds::corners_of_solid,
        lighting::Lighting,
        quadric::{Curve, Ends, Quadric},
        samples::CenterSamples,
    },
    scene::DrawnSolid,
};

/// The transparent spheres that a camera can see.
#[derive(Clone, Debug, Default)]
pub(crate) struct TransparentSpheres {
    /// The spheres, the farthest first.
    spheres: Vec<Sphere>,
}

/// The memory for blending them into a row.
#[derive(Clone, Debug, Default)]
pub(crate) struct Blend {
    samples: CenterSamples,
    /// Sum of the samples' colours in each pixel of a row, and the number of samples.
    sums: Vec<Vec4>,
}

#[derive(Clone, Debug)]
struct Sphere {
    distance: f32,
    quadric: Quadric,
    /// Its lit colour, red, green and blue in 0..=255.
    color: Vec3,
}

impl TransparentSpheres {
    /// Replaces the spheres by those around these points.
    pub fn project(&mut self, markers: &[Vec3], view: &PinholeView, lighting: &Lighting) {
        self.spheres.clear();
        self.spheres.extend(
            markers
                .iter()
                .filter_map(|&center| Sphere::seen(center, view, lighting)),
        );
        self.spheres
            .sort_by(|one, other| other.distance.total_cmp(&one.distance));
    }

    /// The windows in which they may be seen.
    pub fn windows(&self) -> impl Iterator<Item = &PictureWindow> {
        self.spheres.iter().map(|sphere| &sphere.quadric.window)
    }

    /// Blends the spheres into the colours of a row, where they are nearer than everything else in these samples. `nearest` gives the inverse
    /// depth of the nearest surface at a sample and a column.
    pub fn blend(
        &self,
        view: &PinholeView,
        lighting: &Lighting,
        row: u32,
        offsets: &[SampleOffset],
        nearest: impl Fn(usize, usize) -> f32,
        memory: &mut Blend,
        rgb: &mut [u8],
    ) {
        let Blend { samples, sums } = memory;
        for sphere in self
            .spheres
            .iter()
            .filter(|sphere| sphere.quadric.window.rows.contains(&row))
        {
            let columns = &sphere.quadric.window.columns;
            sums.clear();
            sums.resize(columns.len(), Vec4::ZERO);
            samples.resize(view.width as usize, 1);
            let mut samples = samples.center_row(0);
            for (sample, &offset) in offsets.iter().enumerate() {
                samples.clear(sphere.quadric.window.columns());
                sphere.quadric.draw(row, offset, &mut samples);
                for (column, sum) in columns.clone().zip(sums.iter_mut()) {
                    let inverse_depth = samples.inverse_depth[column as usize];
                    if inverse_depth > nearest(sample, column as usize) {
                        let (x, y) = (column as f32 + offset.x, row as f32 + offset.y);
                        let curve = &sphere.quadric.curve;
                        let shown = curve.shown(sphere.color, lighting, x, y, 1.0 / inverse_depth);
                        *sum += shown.extend(1.0);
                    }
                }
            }
            let weight = Markers::OPACITY / offsets.len() as f32;
            for (column, sum) in columns.clone().zip(sums.iter()) {
                if sum.w > 0.0 {
                    let start = 3 * column as usize;
                    let pixel = &mut rgb[start..start + 3];
                    let behind = Vec3::from_slice(&[pixel[0], pixel[1], pixel[2]].map(f32::from));
                    let mixed = behind * (1.0 - weight * sum.w) + sum.truncate() * weight;
                    pixel.copy_from_slice(&nearest_bytes(mixed));
                }
            }
        }
    }
}

impl Sphere {
    fn seen(center: Vec3, view: &PinholeView, lighting: &Lighting) -> Option<Self> {
        let drawn = DrawnSolid {
            pose: Pose::at(center),
            solid: Solid::Ball(Markers::RADIUS),
            color: Markers::COLOR,
            object: 0,
        };
        let window = view.window_of(&corners_of_solid(&drawn, view))?;
        let curve = Curve::around_point(view, center - view.eye, Markers::RADIUS);
        Some(Self {
            distance: center.distance(view.eye),
            quadric: Quadric::new(curve, Ends::NONE, window, [1; 2]),
            color: lighting.lit(scaled_to_bytes(drawn.color)),
        })
    }
}
