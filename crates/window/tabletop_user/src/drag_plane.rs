//! The plane in which the mouse drags.

use std::f32::consts::FRAC_PI_2;

use bevy::prelude::*;

use tabletop_core::Table;

/// The plane through the held object of the selected hand, in which the mouse drags it: upright (report section 4, figure 8g), or level if
/// the user has [chosen](crate::Dragging) that.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[reflect(Resource)]
pub struct DragPlane {
    /// Angle of the plane about Z, in radians. At 0 it lies along X and faces a viewer who looks along Y.
    pub heading: f32,
    /// True while the perpendicular plane stands in for it.
    pub is_perpendicular: bool,
    /// True if it lies level.
    pub is_level: bool,
}

impl DragPlane {
    /// The plane that a viewer with this direction of view sees from the front.
    pub fn facing(direction_of_view: Vec3) -> Self {
        Self {
            heading: libm::atan2f(-direction_of_view.x, direction_of_view.y),
            is_perpendicular: false,
            is_level: false,
        }
    }

    /// The rotation from the plane of X and Z to the shown plane.
    pub fn rotation(self) -> Quat {
        let quarter = if self.is_perpendicular {
            FRAC_PI_2
        } else {
            0.0
        };
        let upright = Quat::from_rotation_z(self.heading + quarter);
        match self.is_level {
            true => upright * Quat::from_rotation_x(FRAC_PI_2),
            false => upright,
        }
    }

    /// Its normal, which points away from the viewer, or up.
    pub fn normal(self) -> Vec3 {
        self.rotation() * Vec3::Y
    }

    /// Side length of the plane's square, in units.
    pub fn side(table: &Table) -> f32 {
        4.0 * table.xspan
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_plane_faces_the_viewer_whether_or_not_he_looks_down() {
        for (view, normal) in [
            (Vec3::new(0.0, 1.0, -1.0), Vec3::Y),
            (Vec3::new(-2.0, 0.0, 0.3), Vec3::NEG_X),
            (Vec3::new(1.0, 1.0, 0.0), Vec3::new(1.0, 1.0, 0.0)),
        ] {
            let plane = DragPlane::facing(view);
            assert!((plane.normal() - normal.normalize()).length() < 1e-6);
        }
    }

    #[test]
    fn the_perpendicular_plane_is_a_quarter_turn_away() {
        let plane = DragPlane {
            heading: 0.3,
            is_perpendicular: true,
            is_level: false,
        };
        let shown = DragPlane {
            heading: 0.3 + FRAC_PI_2,
            is_perpendicular: false,
            is_level: false,
        };
        assert!((plane.normal() - shown.normal()).length() < 1e-6);
    }

    #[test]
    fn a_level_plane_has_an_upright_normal_whatever_its_heading() {
        for heading in [0.0, 0.3, -2.0] {
            let plane = DragPlane {
                heading,
                is_perpendicular: heading > 0.0,
                is_level: true,
            };
            assert!((plane.normal() - Vec3::Z).length() < 1e-6);
        }
    }
}
