//! A window that waits for the user costs next to nothing.

use std::time::Duration;

use bevy::{
    prelude::*,
    winit::{UpdateMode, WinitSettings},
};
use tabletop_core::Paused;

use super::{opening::Opening, redraw::Redraw};

/// How often a window in which nothing happens looks after what comes neither from mouse nor keys, such as a file that has changed.
const IDLE: Duration = Duration::from_millis(250);

/// For how long a paused window goes on as before after the last news.
const LINGER: Duration = Duration::from_millis(500);

pub(super) fn plugin(app: &mut App) {
    app.insert_resource(WinitSettings::continuous())
        .add_systems(Last, rest_while_waiting);
}

/// A window that waits for the user costs next to nothing; keys and mouse still act at once.
fn rest_while_waiting(
    paused: Res<Paused>,
    opening: Res<Opening>,
    redraw: Res<Redraw>,
    time: Res<Time<Real>>,
    mut settings: ResMut<WinitSettings>,
) {
    let is_waiting = paused.0 || *opening != Opening::Done;
    let mode = match is_waiting && redraw.idle_for(time.elapsed()) > LINGER {
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
    use super::*;

    const MS: Duration = Duration::from_millis(1);

    #[test]
    fn a_pause_rests_when_nothing_has_been_new_for_a_while() {
        let mut app = App::new();
        app.add_plugins(MinimalPlugins)
            .init_resource::<Paused>()
            .init_resource::<Redraw>()
            .insert_resource(Opening::Done)
            .insert_resource(bevy::time::TimeUpdateStrategy::ManualDuration(100 * MS))
            .add_plugins(plugin);
        let mut modes = |paused| {
            app.insert_resource(Paused(paused));
            for _ in 0..10 {
                app.update();
            }
            app.world().resource::<WinitSettings>().focused_mode
        };
        assert_eq!(modes(false), UpdateMode::Continuous);
        assert_eq!(modes(true), UpdateMode::reactive_low_power(IDLE));
        assert_eq!(modes(false), UpdateMode::Continuous);
    }
}
