//! The mouse pointer. It follows the mouse in the order of its events, so that a press counts where it happened, however far the cursor has
//! gone since in a slow frame.

use std::collections::VecDeque;

use bevy::{
    input::mouse::MouseButtonInput,
    prelude::*,
    window::{PrimaryWindow, WindowEvent},
};
use bevy_egui::{EguiContext, PrimaryEguiContext, egui, input::EguiWantsInput};
use tabletop_user::UserCamera;

/// So far, in pixels, the cursor may move while a button is down, and it is still a click.
pub(crate) const SLACK: f32 = 4.0;

/// Reading the mouse, once a frame before its ticks.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct MouseSystems;

/// The mouse's buttons, while the [`Pointer`] is where it is.
#[derive(Resource, Clone, Debug, Default, Deref, DerefMut)]
pub struct Buttons(ButtonInput<MouseButton>);

/// The mouse cursor; it is nowhere while it is outside the window.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub struct Pointer {
    /// The line of sight through it, from the user's camera.
    pub ray: Option<Ray3d>,
    /// Its place in the window, in logical pixels from the upper left corner.
    pub cursor: Option<Vec2>,
    /// True if a press is for the panels.
    pub is_panels: bool,
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<EguiWantsInput>()
        .init_resource::<Buttons>()
        .add_message::<WindowEvent>()
        .add_systems(RunFixedMainLoop, (follow, aim).chain().before(MouseSystems));
}

/// Something that the mouse has done.
enum MouseStep {
    To(Vec2),
    Away,
    Button(MouseButtonInput),
}

impl MouseStep {
    fn of(event: &WindowEvent) -> Option<Self> {
        if let WindowEvent::CursorMoved(moved) = event {
            Some(Self::To(moved.position))
        } else if let WindowEvent::MouseButtonInput(button) = event {
            Some(Self::Button(*button))
        } else {
            matches!(event, WindowEvent::CursorLeft(_)).then_some(Self::Away)
        }
    }
}

/// Follows the mouse up to its next press or release. The frame after that goes on from there.
fn follow(
    mut events: MessageReader<WindowEvent>,
    mut trail: Local<VecDeque<MouseStep>>,
    windows: Query<&Window, With<PrimaryWindow>>,
    mut buttons: ResMut<Buttons>,
    mut pointer: ResMut<Pointer>,
) {
    trail.extend(events.read().filter_map(MouseStep::of));
    buttons.clear();
    while let Some(step) = trail.pop_front() {
        match step {
            MouseStep::To(place) => pointer.cursor = Some(place),
            MouseStep::Away => pointer.cursor = None,
            MouseStep::Button(MouseButtonInput { button, state, .. }) => {
                match state.is_pressed() {
                    true => buttons.press(button),
                    false => buttons.release(button),
                }
                return;
            }
        }
    }
    pointer.cursor = windows.iter().next().and_then(Window::cursor_position);
}

pub(crate) fn aim(
    mut pointer: ResMut<Pointer>,
    cameras: Query<(&Camera, &GlobalTransform), With<UserCamera>>,
    mut panels: Query<&mut EguiContext, With<PrimaryEguiContext>>,
    wanted: Res<EguiWantsInput>,
) {
    let cursor = pointer.cursor;
    pointer.ray = cursor
        .zip(cameras.iter().next())
        .and_then(|(cursor, (camera, place))| camera.viewport_to_world(place, cursor).ok());
    let is_over_panel = cursor
        .zip(panels.iter_mut().next())
        .is_some_and(|(cursor, mut panels)| {
            let context = panels.get_mut();
            let at = egui::pos2(cursor.x, cursor.y) / context.zoom_factor();
            let layer = context.layer_id_at(at);
            // The background is everywhere; the view is seen through it.
            layer.is_some_and(|layer| layer.order != egui::Order::Background)
        });
    // Not whether egui saw the cursor over a panel: its answer is a frame old.
    pointer.is_panels = is_over_panel || wanted.is_using_pointer() || wanted.is_popup_open();
}

#[cfg(test)]
mod tests {
    use bevy::{
        ecs::system::RunSystemOnce as _,
        input::ButtonState,
        window::{CursorLeft, CursorMoved},
    };

    use super::*;

    const WINDOW: Entity = Entity::PLACEHOLDER;

    fn moved(x: f32) -> WindowEvent {
        let position = Vec2::splat(x);
        WindowEvent::CursorMoved(CursorMoved {
            window: WINDOW,
            position,
            delta: None,
        })
    }

    fn button(state: ButtonState) -> WindowEvent {
        WindowEvent::MouseButtonInput(MouseButtonInput {
            button: MouseButton::Left,
            state,
            window: WINDOW,
        })
    }

    /// An app whose window has its cursor at the last place of these events.
    fn app_after(events: Vec<WindowEvent>, cursor: Option<Vec2>) -> App {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, plugin))
            .init_resource::<Pointer>();
        let mut window = Window::default();
        window.set_cursor_position(cursor);
        app.world_mut().spawn((window, PrimaryWindow));
        app.world_mut().write_message_batch(events);
        app
    }

    /// Where the pointer is in a frame, and whether the left button has just gone down or come up.
    fn frame(app: &mut App) -> (Option<f32>, bool, bool) {
        app.update();
        let buttons = app.world().resource::<Buttons>();
        (
            app.world().resource::<Pointer>().cursor.map(|at| at.x),
            buttons.just_pressed(MouseButton::Left),
            buttons.just_released(MouseButton::Left),
        )
    }

    #[test]
    fn a_press_and_a_release_count_where_they_happened() {
        let stroke = vec![
            moved(10.0),
            moved(20.0),
            button(ButtonState::Pressed),
            moved(30.0),
            moved(40.0),
            button(ButtonState::Released),
            moved(50.0),
        ];
        let mut app = app_after(stroke, Some(Vec2::splat(50.0)));
        assert_eq!(frame(&mut app), (Some(20.0), true, false));
        assert_eq!(frame(&mut app), (Some(40.0), false, true));
        assert_eq!(frame(&mut app), (Some(50.0), false, false));
        assert_eq!(frame(&mut app), (Some(50.0), false, false));
    }

    #[test]
    fn a_cursor_that_has_left_the_window_is_nowhere() {
        let away = WindowEvent::CursorLeft(CursorLeft { window: WINDOW });
        let released = button(ButtonState::Released);
        let mut app = app_after(vec![moved(10.0), away, released], None);
        assert_eq!(frame(&mut app), (None, false, false));
        assert_eq!(frame(&mut app), (None, false, false));
    }

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
        for (cursor, expected) in [(90.0, false), (210.0, true), (290.0, true), (310.0, false)] {
            world.resource_mut::<Pointer>().cursor = Some(Vec2::splat(cursor));
            world.run_system_once(aim).unwrap();
            let pointer = world.resource::<Pointer>();
            assert_eq!(pointer.is_panels, expected, "{cursor}");
        }
    }
}
