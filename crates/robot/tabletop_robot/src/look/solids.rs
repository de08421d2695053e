//! Solids that descriptions of robots can name.

use std::f64::consts::PI;

use bevy::math::Vec3;
use tabletop_core::Figure;
use tabletop_geometry::{Rgb, Triangles};
use tabletop_kinematics::Geometry;

use super::{axis::LinkAxis, boxes::Cuboid, detail::Detail, hull::Hull, lathe::Lathe};

/// The figure of a solid, in its own frame, in units. For a mesh it is empty.
pub(super) fn figure(solid: &Geometry, color: Rgb) -> Figure {
    let surface = |detail| -> Triangles { hull(solid, detail).shaded(color) };
    Figure {
        fine: surface(Detail::Fine).into(),
        coarse: surface(Detail::Coarse).into(),
    }
}

/// Its surface in m.
fn hull(solid: &Geometry, detail: Detail) -> Hull {
    match solid {
        Geometry::Box { size } => Cuboid {
            center: Vec3::ZERO,
            size: size.as_vec3(),
            rotation: Vec3::ZERO,
        }
        .hull(),
        Geometry::Cylinder { radius, length } => {
            let (radius, half) = (*radius as f32, *length as f32 / 2.0);
            turned(
                vec![[0.0, -half], [radius, -half], [radius, half], [0.0, half]],
                detail,
            )
        }
        Geometry::Sphere { radius } => {
            let radius = *radius as f32;
            let rings = detail.segments(radius) / 2;
            let at = |ring: usize| {
                let (sin, cos) = libm::sincos(PI * ring as f64 / rings as f64);
                [radius * sin as f32, -radius * cos as f32]
            };
            let mut profile: Vec<_> = (0..=rings).map(at).collect();
            (profile[0][0], profile[rings][0]) = (0.0, 0.0);
            turned(profile, detail)
        }
        Geometry::Mesh { .. } => Hull::default(),
    }
}

fn turned(profile: Vec<[f32; 2]>, detail: Detail) -> Hull {
    let lathe = Lathe {
        origin: Vec3::ZERO,
        axis: LinkAxis::Z,
        profile,
    };
    lathe.hull(detail)
}

#[cfg(test)]
mod tests {
    use bevy::math::DVec3;

    use super::*;

    #[test]
    fn solids_have_their_volume_and_their_extents() {
        let [radius, length] = [0.1, 0.5];
        let round = std::f32::consts::PI * 0.1_f32.powi(2);
        for (solid, volume, extents) in [
            (
                Geometry::Box {
                    size: DVec3::new(0.1, 0.2, 0.3),
                },
                0.006,
                Vec3::new(0.1, 0.2, 0.3),
            ),
            (
                Geometry::Cylinder { radius, length },
                round * 0.5,
                Vec3::new(0.2, 0.2, 0.5),
            ),
            (
                Geometry::Sphere { radius },
                round * 0.4 / 3.0,
                Vec3::splat(0.2),
            ),
        ] {
            for (detail, tolerance) in [(Detail::Fine, 0.02), (Detail::Coarse, 0.35)] {
                let hull = hull(&solid, detail);
                let own = hull.volume() / volume;
                assert!((1.0 - tolerance..=1.001).contains(&own), "{solid:?}: {own}");
                let [least, most] = hull.bounds();
                let missed = (most - least - extents).abs().max_element();
                assert!(missed <= 4.0 * detail.tolerance(), "{solid:?}: {missed}");
            }
        }
    }
}
