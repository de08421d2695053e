//! Where the mouse points.

use bevy::{prelude::*, window::PrimaryWindow};
use tabletop_core::UserCamera;

use crate::mouse::MouseSystems;

/// The line of sight through the mouse cursor, from the user's camera; none while the cursor is outside the window.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub(crate) struct Pointer(pub Option<Ray3d>);

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(RunFixedMainLoop, aim.before(MouseSystems));
}

fn aim(
    mut pointer: ResMut<Pointer>,
    windows: Query<&Window, With<PrimaryWindow>>,
    cameras: Query<(&Camera, &GlobalTransform), With<UserCamera>>,
) {
    let cursor = windows.iter().next().and_then(Window::cursor_position);
    pointer.0 = cursor
        .zip(cameras.iter().next())
        .and_then(|(cursor, (camera, place))| camera.viewport_to_world(place, cursor).ok());
}
