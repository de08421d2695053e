//! Idle windows, which cost next to nothing while they wait for the user.

use std::time::Duration;

use bevy::{
    prelude::*,
    window::WindowEvent,
    winit::{UpdateMode, WinitSettings},
};
use tabletop_core::{Idle, Paused};
use tabletop_user::Gamepad;

use super::{opening::Opening, redraw::Redraw};

/// Time between checks of an idle window for events that come neither from mouse nor keys, such as a changed file.
const IDLE: Duration = Duration::from_millis(250);

/// Time after the last event for which an idle window goes on as before.
const LINGER: Duration = Duration::from_millis(500);

pub(super) fn plugin(app: &mut App) {
    app.insert_resource(WinitSettings::continuous())
        .init_resource::<LastAct>()
        .add_systems(Last, (note_acts, rest_while_waiting).chain());
}

/// The time of the user's last act, or of the last motion.
#[derive(Resource, Default)]
struct LastAct(Duration);

fn note_acts(
    mut events: MessageReader<WindowEvent>,
    redraw: Res<Redraw>,
    gamepad: Res<Gamepad>,
    idle: Res<Idle>,
    time: Res<Time<Real>>,
    mut last: ResMut<LastAct>,
) {
    let is_of_user = |event: &&WindowEvent| !matches!(event, WindowEvent::RequestRedraw(_));
    let has_acted = events.read().filter(is_of_user).count() > 0 || gamepad.is_used();
    last.0 = match has_acted || *idle == Idle(0) {
        true => time.elapsed(),
        false => last.0.max(redraw.moved_at()),
    };
}

/// Lets a window rest while it waits for the user; keys and mouse still act at once. Meanwhile panels may show
/// the time, which does not count as an event.
fn rest_while_waiting(
    paused: Res<Paused>,
    opening: Res<Opening>,
    redraw: Res<Redraw>,
    last_act: Res<LastAct>,
    time: Res<Time<Real>>,
    mut settings: ResMut<WinitSettings>,
) {
    let now = time.elapsed();
    let is_waiting = paused.0 || *opening != Opening::Done;
    let waits = is_waiting && redraw.idle_for(now) > LINGER;
    let rests = now.saturating_sub(last_act.0) > LINGER;
    let mode = match waits || rests {
        true => UpdateMode::reactive_low_power(IDLE),
        false => UpdateMode::Continuous,
    };
    if settings.focused_mode != mode {
        *settings = WinitSettings {
            focused_mode: mode,
            unfocused_mode: mode,
        };
    }
}

#[cfg(test)]
mod tests {
    use bevy::window::WindowFocused;

    use super::*;

    const MS: Duration = Duration::from_millis(1);

    #[test]
    fn a_window_rests_when_nothing_has_been_new_for_a_while() {
        let mut app = App::new();
        app.add_plugins(MinimalPlugins)
            .add_message::<WindowEvent>()
            .init_resource::<Gamepad>()
            .init_resource::<Idle>()
            .init_resource::<Paused>()
            .init_resource::<Redraw>()
            .insert_resource(Opening::Done)
            .insert_resource(bevy::time::TimeUpdateStrategy::ManualDuration(100 * MS))
            .add_plugins(plugin);
        let mut mode = |paused, idle, is_touched| {
            app.insert_resource(Paused(paused))
                .insert_resource(Idle(idle));
            for _ in 0..10 {
                if is_touched {
                    let event = WindowFocused {
                        window: Entity::PLACEHOLDER,
                        focused: true,
                    };
                    app.world_mut().write_message(WindowEvent::from(event));
                }
                app.update();
            }
            app.world().resource::<WinitSettings>().focused_mode
        };
        let resting = UpdateMode::reactive_low_power(IDLE);
        assert_eq!(mode(false, 0, false), UpdateMode::Continuous);
        assert_eq!(mode(true, 0, false), resting);
        assert_eq!(mode(false, 0, false), UpdateMode::Continuous);
        assert_eq!(mode(false, 1000, false), resting);
        assert_eq!(mode(false, 1000, true), UpdateMode::Continuous);
        assert_eq!(mode(false, 1000, false), resting);
        assert_eq!(mode(false, 0, false), UpdateMode::Continuous);
    }
}
