//! Surfaces through sections of different sizes.

use std::f64::consts::TAU;

use bevy::math::Vec3;
use serde::Deserialize;

use super::{axis::LinkAxis, detail::Detail, hull::Hull};

/// A surface through superellipses across an axis, closed flat at both ends. Lengths in m.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Loft {
    axis: LinkAxis,
    sections: Vec<Section>,
}

/// The superellipse |u|^n + |v|^n = 1 stretched to a rectangle: an ellipse for exponent 2, nearly the rectangle for 10.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Section {
    /// Its place on the axis.
    at: f32,
    /// Its extent along u.
    u: [f32; 2],
    /// Its extent along v.
    v: [f32; 2],
    exponent: f64,
}

impl Section {
    fn radius(&self) -> f32 {
        ((self.u[1] - self.u[0]) / 2.0).max((self.v[1] - self.v[0]) / 2.0)
    }

    fn middle(&self, axis: LinkAxis) -> Vec3 {
        axis.point(
            (self.u[0] + self.u[1]) / 2.0,
            (self.v[0] + self.v[1]) / 2.0,
            self.at,
        )
    }

    fn ring(&self, axis: LinkAxis, segments: usize) -> Vec<Vec3> {
        let [u_half, v_half] = [self.u, self.v].map(|[least, most]| (most - least) / 2.0);
        (0..segments)
            .map(|i| {
                let (sin, cos) = libm::sincos(TAU * i as f64 / segments as f64);
                let on_unit =
                    |part: f64| (libm::pow(part.abs(), 2.0 / self.exponent) * part.signum()) as f32;
                // Sine and cosine of right angles are not quite 0, which roots would make large.
                let [u, v] = [cos, sin].map(|part| {
                    if part.abs() < 1e-9 {
                        0.0
                    } else {
                        on_unit(part)
                    }
                });
                self.middle(axis) + axis.point(u * u_half, v * v_half, 0.0)
            })
            .collect()
    }
}

impl Loft {
    /// Its surface.
    pub fn hull(&self, detail: Detail) -> Hull {
        let largest = self
            .sections
            .iter()
            .map(Section::radius)
            .fold(0.0, f32::max);
        // A multiple of four puts points where the sections are widest.
        let segments = detail.segments(largest).next_multiple_of(4);
        let sizes: Vec<_> = self
            .sections
            .iter()
            .map(|section| {
                [
                    section.at,
                    section.u[0],
                    section.u[1],
                    section.v[0],
                    section.v[1],
                ]
            })
            .collect();
        let rings: Vec<_> = detail
            .thinned(&sizes)
            .into_iter()
            .filter_map(|i| Some(self.sections.get(i)?.ring(self.axis, segments)))
            .collect();
        Hull::through(&rings).oriented()
    }
}
