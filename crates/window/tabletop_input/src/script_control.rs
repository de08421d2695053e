//! Starting and stopping the script that drives the robot (report section 5.2), and its messages.

use bevy::prelude::*;
use tabletop_core::{Agent, ScriptCommand, ScriptEvent};
use tabletop_user::{Action, KeySystems, Notices, Tone, was_struck};

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(Update, note_events).add_systems(
        RunFixedMainLoop,
        toggle
            .run_if(was_struck(Action::RunScript))
            .in_set(KeySystems),
    );
}

fn toggle(agent: Res<Agent>, mut orders: MessageWriter<ScriptCommand>) {
    orders.write(toggled(&agent));
}

/// The order that starts a script, or stops the one that runs.
pub fn toggled(agent: &Agent) -> ScriptCommand {
    match agent.is_on() {
        true => ScriptCommand::Stop,
        false => ScriptCommand::Start,
    }
}

fn note_events(mut events: MessageReader<ScriptEvent>, mut notices: ResMut<Notices>) {
    for event in events.read() {
        match event {
            ScriptEvent::Started { engine } => {
                notices.append(Tone::Event, &format!("{engine} is online"));
            }
            ScriptEvent::Printed { line, is_error } => {
                let tone = if *is_error {
                    Tone::Warning
                } else {
                    Tone::Event
                };
                notices.log(tone, line);
            }
            ScriptEvent::Noted { line } => notices.append(Tone::Warning, line),
            ScriptEvent::Failed { reason } => notices.append(Tone::Fault, reason),
            ScriptEvent::Stopped => notices.append(Tone::Event, "the script has ended"),
        }
    }
}

#[cfg(test)]
mod tests {
    use bevy::time::TimeUpdateStrategy;
    use tabletop_core::CorePlugin;
    use tabletop_user::UserPlugin;

    use super::*;
    use crate::keys;

    fn app() -> App {
        let mut app = App::new();
        app.add_plugins((
            MinimalPlugins,
            CorePlugin::default(),
            UserPlugin,
            keys::plugin,
            plugin,
        ))
        .insert_resource(TimeUpdateStrategy::FixedTimesteps(1))
        .init_resource::<ButtonInput<KeyCode>>()
        .init_resource::<Notices>();
        app
    }

    #[test]
    fn the_key_starts_a_script_and_stops_the_one_that_runs() {
        for (agent, expected) in [
            (Agent::Off, ScriptCommand::Start),
            (Agent::Failed, ScriptCommand::Start),
            (Agent::Starting, ScriptCommand::Stop),
        ] {
            let mut app = app();
            app.insert_resource(agent);
            let mut keys = app.world_mut().resource_mut::<ButtonInput<KeyCode>>();
            keys.press(KeyCode::KeyM);
            app.update();
            let orders = app.world().resource::<Messages<ScriptCommand>>();
            let orders: Vec<_> = orders.iter_current_update_messages().copied().collect();
            assert_eq!(orders, [expected]);
        }
    }

    #[test]
    fn repeated_lines_of_a_script_are_each_reported() {
        let mut app = app();
        let line = ScriptEvent::Printed {
            line: "once more".into(),
            is_error: false,
        };
        app.world_mut().write_message(line.clone());
        app.world_mut().write_message(line);
        app.world_mut().write_message(ScriptEvent::Failed {
            reason: "undefined\n  at a.m:2".into(),
        });
        app.update();
        let notices: Vec<_> = app.world().resource::<Notices>().iter().collect();
        assert_eq!(notices, ["once more", "once more", "undefined\n  at a.m:2"]);
    }
}
