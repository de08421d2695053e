//! Surfaces of revolution.

use std::f64::consts::TAU;

use bevy::math::Vec3;
use serde::Deserialize;

use super::{axis::LinkAxis, detail::Detail, hull::Hull};

/// A surface of revolution: a profile turned about an axis. Lengths in m.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Lathe {
    /// A point of the axis.
    pub origin: Vec3,
    pub axis: LinkAxis,
    /// Points as radius and height above the origin. An end off the axis is closed straight to it.
    pub profile: Vec<[f32; 2]>,
}

impl Lathe {
    /// Its surface.
    pub fn hull(&self, detail: Detail) -> Hull {
        let largest = self
            .profile
            .iter()
            .map(|point| point[0])
            .fold(0.0, f32::max);
        let segments = detail.segments(largest);
        let profile = detail
            .thinned(&self.profile)
            .into_iter()
            .filter_map(|i| self.profile.get(i).copied());
        let rings: Vec<_> = profile
            .map(|[radius, height]| {
                let count = if radius > 0.0 { segments } else { 1 };
                (0..count)
                    .map(|i| {
                        let (sin, cos) = libm::sincos(TAU * i as f64 / count as f64);
                        let (u, v) = (radius * cos as f32, radius * sin as f32);
                        self.origin + self.axis.point(u, v, height)
                    })
                    .collect()
            })
            .collect();
        Hull::through(&rings).oriented()
    }
}
