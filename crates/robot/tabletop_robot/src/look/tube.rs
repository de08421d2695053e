//! Round bars that bend.

use std::f64::consts::TAU;

use bevy::math::{Quat, Vec3};
use serde::Deserialize;

use super::{detail::Detail, hull::Hull};

/// A round bar along a line, with flat ends. Lengths in m.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Tube {
    radius: f32,
    /// Points of its middle line.
    path: Vec<Vec3>,
}

impl Tube {
    /// Its surface.
    pub fn hull(&self, detail: Detail) -> Hull {
        let points: Vec<_> = self.path.iter().map(|point| point.to_array()).collect();
        let path: Vec<_> = detail
            .thinned(&points)
            .into_iter()
            .filter_map(|i| self.path.get(i).copied())
            .collect();
        let segments = detail.segments(self.radius);
        let direction = |from: usize| {
            let step =
                |[a, b]: [usize; 2]| Some((*path.get(b)? - *path.get(a)?).normalize_or_zero());
            [step([from.wrapping_sub(1), from]), step([from, from + 1])]
        };
        let mut across = Vec3::ZERO;
        let mut rings = Vec::new();
        for (i, &point) in path.iter().enumerate() {
            let [before, after] = direction(i).map(|step| step.unwrap_or_default());
            let along = (before + after).normalize_or(Vec3::Z);
            if i == 0 {
                across = along.any_orthonormal_vector();
            }
            // The ring lies in the plane that halves the bend, so that the bar keeps its width on both sides of it.
            let side = along.cross(across).normalize_or_zero();
            across = side.cross(along);
            let bend = before.cross(after);
            let widened = 1.0 / (before.dot(along)).max(after.dot(along)).clamp(0.5, 1.0);
            let in_bend = bend.cross(along).normalize_or_zero();
            rings.push(
                (0..segments)
                    .map(|i| {
                        let turn =
                            Quat::from_axis_angle(along, (TAU * i as f64 / segments as f64) as f32);
                        let offset = turn * across * self.radius;
                        point + offset + in_bend * in_bend.dot(offset) * (widened - 1.0)
                    })
                    .collect(),
            );
        }
        Hull::through(&rings).oriented()
    }
}
