//! The points between which the user measures, and the lines that join them.

use bevy::prelude::*;
use tabletop_user::Measuring;

/// Radius of a point, in units.
const POINT: f32 = 0.08;

/// Width of the lines, in pixels.
const WIDTH: f32 = 3.0;

const COLOR: Color = Color::srgb(1.0, 0.3, 0.8);

/// Lines that nothing hides.
#[derive(Default, Reflect, GizmoConfigGroup)]
pub(crate) struct MeasuredLines;

pub(crate) fn plugin(app: &mut App) {
    let config = GizmoConfig {
        line: GizmoLineConfig {
            width: WIDTH,
            ..default()
        },
        depth_bias: -1.0,
        ..default()
    };
    app.insert_gizmo_config(MeasuredLines, config)
        .add_systems(Update, draw);
}

fn draw(mut gizmos: Gizmos<MeasuredLines>, measuring: Res<Measuring>) {
    for &point in measuring.points() {
        gizmos.sphere(point, POINT, COLOR);
    }
    gizmos.linestrip(measuring.points().iter().copied(), COLOR);
}
