//! The mouse pointer.

use bevy::{prelude::*, window::PrimaryWindow};
use bevy_egui::{EguiContext, PrimaryEguiContext, egui, input::EguiWantsInput};
use tabletop_user::UserCamera;

/// So far, in pixels, the cursor may move while a button is down, and it is still a click.
pub(crate) const SLACK: f32 = 4.0;

/// Reading the mouse, once a frame before its ticks.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct MouseSystems;

/// The mouse cursor; it is nowhere while it is outside the window.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub(crate) struct Pointer {
    /// The line of sight through it, from the user's camera.
    pub ray: Option<Ray3d>,
    /// Its place in the window, in logical pixels from the upper left corner.
    pub cursor: Option<Vec2>,
    /// True if a press is for the panels.
    pub is_panels: bool,
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<EguiWantsInput>()
        .add_systems(RunFixedMainLoop, aim.before(MouseSystems));
}

pub(crate) fn aim(
    mut pointer: ResMut<Pointer>,
    windows: Query<&Window, With<PrimaryWindow>>,
    cameras: Query<(&Camera, &GlobalTransform), With<UserCamera>>,
    mut panels: Query<&mut EguiContext, With<PrimaryEguiContext>>,
    wanted: Res<EguiWantsInput>,
) {
    let cursor = windows.iter().next().and_then(Window::cursor_position);
    pointer.cursor = cursor;
    pointer.ray = cursor
        .zip(cameras.iter().next())
        .and_then(|(cursor, (camera, place))| camera.viewport_to_world(place, cursor).ok());
    // egui's answer is a frame old, and the cursor may have come to a panel since.
    let is_over_panel = cursor
        .zip(panels.iter_mut().next())
        .is_some_and(|(cursor, mut panels)| {
            let context = panels.get_mut();
            let at = egui::pos2(cursor.x, cursor.y) / context.zoom_factor();
            let layer = context.layer_id_at(at);
            // The background is everywhere; the view is seen through it.
            layer.is_some_and(|layer| layer.order != egui::Order::Background)
        });
    pointer.is_panels = is_over_panel || wanted.wants_any_pointer_input();
}

#[cfg(test)]
mod tests {
    use bevy::ecs::system::RunSystemOnce as _;

    use super::*;

    #[test]
    fn a_panel_is_hit_where_it_is_drawn_at_any_scale() {
        let mut world = World::new();
        world.init_resource::<Pointer>();
        world.init_resource::<EguiWantsInput>();
        let mut panels = EguiContext::default();
        panels.get_mut().set_zoom_factor(2.0);
        for _ in 0..3 {
            let _output = panels.get_mut().run_ui(default(), |ui| {
                let area = egui::Area::new(egui::Id::new("panel")).fixed_pos((100.0, 100.0));
                area.show(ui.ctx(), |ui| ui.allocate_space(egui::vec2(50.0, 50.0)));
            });
        }
        world.spawn((panels, PrimaryEguiContext));
        let window = world.spawn((Window::default(), PrimaryWindow)).id();
        for (cursor, expected) in [(90.0, false), (210.0, true), (290.0, true), (310.0, false)] {
            let mut window = world.get_mut::<Window>(window).unwrap();
            window.set_cursor_position(Some(Vec2::splat(cursor)));
            world.run_system_once(aim).unwrap();
            let pointer = world.resource::<Pointer>();
            assert_eq!(pointer.is_panels, expected, "{cursor}");
        }
    }
}
