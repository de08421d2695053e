//! Keys of the whole program: Space pauses, Esc quits (report section 2.4).

use bevy::prelude::*;
use tabletop_core::{Actor, ClockCommand, CommandWriter, Paused, Recording};
use tabletop_user::{
    Action, Chosen, Connection, ConnectionOrder, Editing, KeySystems, Measuring, QuitQuestion,
    was_struck,
};

use crate::context_menu::ContextMenu;

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Recording>()
        .init_resource::<ContextMenu>()
        .add_systems(
            RunFixedMainLoop,
            (
                toggle_pause.run_if(was_struck(Action::Pause)),
                quit.run_if(was_struck(Action::Quit)).run_if(not(drives)),
                stop.run_if(drives),
            )
                .in_set(KeySystems),
        );
}

fn toggle_pause(paused: Res<Paused>, mut commands: CommandWriter) {
    commands.write(Actor::Key, ClockCommand::SetPaused(!paused.0));
}

fn drives(connection: Res<Connection>) -> bool {
    connection.drives()
}

/// Stops the real robot, whatever else is in front.
fn stop(keys: Res<ButtonInput<KeyCode>>, mut orders: MessageWriter<ConnectionOrder>) {
    if keys.just_pressed(KeyCode::Escape) {
        orders.write(ConnectionOrder::Stop);
    }
}

/// Closes the menu that is open, ends measuring, gives up the choice of an object, or ends the program; asks before that if a recording runs, or edits are not saved.
fn quit(
    mut exit: MessageWriter<AppExit>,
    mut menu: ResMut<ContextMenu>,
    mut chosen: ResMut<Chosen>,
    mut measuring: ResMut<Measuring>,
    mut commands: CommandWriter,
    mut question: ResMut<QuitQuestion>,
    recording: Res<Recording>,
    editing: Res<Editing>,
) {
    if menu.close(&mut commands) {
        return;
    }
    if measuring.is_on {
        measuring.switch();
    } else if chosen.0.is_some() {
        chosen.0 = None;
    } else if !question.asks(&recording, &editing) {
        exit.write(AppExit::Success);
    }
}

#[cfg(test)]
mod tests {
    use tabletop_user::{KeyboardFocus, UserPlugin};

    use super::*;
    use bevy::time::TimeUpdateStrategy;
    use tabletop_core::CorePlugin;

    fn app() -> App {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default(), UserPlugin, plugin))
            .insert_resource(TimeUpdateStrategy::FixedTimesteps(1))
            .init_resource::<ButtonInput<KeyCode>>();
        app.finish();
        app.cleanup();
        app.update();
        app
    }

    fn strike(app: &mut App, key: KeyCode) {
        let mut keys = app.world_mut().resource_mut::<ButtonInput<KeyCode>>();
        keys.press(key);
        app.update();
        let mut keys = app.world_mut().resource_mut::<ButtonInput<KeyCode>>();
        keys.release(key);
        keys.clear();
    }

    fn is_paused(app: &App) -> bool {
        app.world().resource::<Paused>().0
    }

    #[test]
    fn space_pauses_and_resumes() {
        let mut app = app();
        strike(&mut app, KeyCode::Space);
        assert!(is_paused(&app));
        app.update();
        assert!(is_paused(&app));
        strike(&mut app, KeyCode::Space);
        assert!(!is_paused(&app));
    }

    #[test]
    fn space_held_down_pauses_once() {
        let mut app = app();
        let mut keys = app.world_mut().resource_mut::<ButtonInput<KeyCode>>();
        keys.press(KeyCode::Space);
        for _ in 0..4 {
            app.update();
            let mut keys = app.world_mut().resource_mut::<ButtonInput<KeyCode>>();
            keys.clear();
            assert!(is_paused(&app));
        }
    }

    #[test]
    fn escape_does_not_quit_while_a_recording_runs() {
        let mut app = app();
        app.insert_resource(Recording(true));
        strike(&mut app, KeyCode::Escape);
        assert_eq!(app.should_exit(), None);
    }

    #[test]
    fn escape_stops_a_real_robot_before_it_quits() {
        let mut app = app();
        app.insert_resource(Connection::Driving("baxter:ros://there".into()))
            .insert_resource(KeyboardFocus::Text);
        strike(&mut app, KeyCode::Escape);
        assert_eq!(app.should_exit(), None);
        let orders = app.world().resource::<Messages<ConnectionOrder>>();
        assert_eq!(orders.iter_current_update_messages().count(), 1);
    }

    #[test]
    fn escape_first_gives_up_the_choice_of_an_object() {
        let mut app = app();
        let object = app.world_mut().spawn_empty().id();
        app.insert_resource(Chosen(Some(object)));
        strike(&mut app, KeyCode::Escape);
        assert_eq!(app.should_exit(), None);
        assert_eq!(*app.world().resource::<Chosen>(), Chosen(None));
        strike(&mut app, KeyCode::Escape);
        assert_eq!(app.should_exit(), Some(AppExit::Success));
    }

    #[test]
    fn only_escape_quits() {
        let mut app = app();
        strike(&mut app, KeyCode::KeyX);
        assert_eq!(app.should_exit(), None);
        strike(&mut app, KeyCode::Escape);
        assert_eq!(app.should_exit(), Some(AppExit::Success));
    }
}
