//! The user's wishes to the timeline, carried out.

use bevy::{ecs::system::SystemParam, prelude::*};
use tabletop_core::{
    Actor, ClockCommand, CommandWriter, HistoryCommand, OpenRecording, OrderSystems, PlaybackOrder,
    Recording, RestApp as _, RestingSystems,
};
use tabletop_user::{
    Action, EditOrder, Imitating, KeySystems, Pace, SingleStep, TaskOrder, was_struck,
};

use super::model::Request;
use crate::files::FileRequest;

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<PendingUndos>()
        .init_resource::<Pace>()
        .add_message::<SingleStep>()
        .add_message::<FileRequest>()
        .add_systems(
            FixedUpdate,
            undo_one
                .run_if(PendingUndos::are_left)
                .in_set(OrderSystems::User)
                .in_set(RestingSystems),
        )
        .wake_while(PendingUndos::are_left)
        .add_systems(
            RunFixedMainLoop,
            (
                step.run_if(was_struck(Action::Step)),
                go_slower.run_if(was_struck(Action::Slower)),
                go_faster.run_if(was_struck(Action::Faster)),
                imitate_or_stop.run_if(was_struck(Action::Imitate)),
            )
                .in_set(KeySystems),
        );
}

/// The number of segments that are still to be undone.
#[derive(Resource, Debug, Default)]
pub(super) struct PendingUndos(usize);

impl PendingUndos {
    fn are_left(undos: Res<Self>) -> bool {
        undos.0 > 0
    }
}

/// The resources that requests change.
#[derive(SystemParam)]
pub(super) struct Orders<'w> {
    commands: CommandWriter<'w>,
    steps: MessageWriter<'w, SingleStep>,
    playback: MessageWriter<'w, PlaybackOrder>,
    open: MessageWriter<'w, OpenRecording>,
    files: MessageWriter<'w, FileRequest>,
    task: MessageWriter<'w, TaskOrder>,
    edits: MessageWriter<'w, EditOrder>,
    pace: ResMut<'w, Pace>,
    undos: ResMut<'w, PendingUndos>,
}

impl Orders<'_> {
    pub fn pace(&self) -> Pace {
        *self.pace
    }

    pub fn carry_out(&mut self, request: Request) {
        match request {
            Request::Play => {
                self.commands
                    .write(Actor::Panel, ClockCommand::SetPaused(false));
            }
            Request::Pause => {
                self.commands
                    .write(Actor::Panel, ClockCommand::SetPaused(true));
            }
            Request::Step => {
                self.steps.write(SingleStep);
            }
            Request::GoTo(tick) => {
                self.playback.write(PlaybackOrder::GoTo(tick));
            }
            Request::StopAt(tick) => {
                self.playback.write(PlaybackOrder::StopAt(tick));
            }
            Request::SetPace(pace) => *self.pace = pace,
            Request::Loop(loops) => {
                self.playback.write(PlaybackOrder::Loop(loops));
            }
            Request::Undo(segments) => self.undos.0 = segments,
            Request::Redo => {
                self.commands.write(Actor::Panel, HistoryCommand::Redo);
            }
            Request::Open(folder) => {
                self.open.write(OpenRecording(folder));
            }
            Request::SaveVideo => {
                self.files.write(FileRequest::AskForVideo);
            }
            Request::Close => {
                self.playback.write(PlaybackOrder::Close);
            }
            Request::Task(order) => {
                self.task.write(order);
            }
            Request::Edit(order) => {
                self.edits.write(order);
            }
        }
    }
}

/// A tick undoes one segment, as a user does.
fn undo_one(
    recording: Res<Recording>,
    mut undos: ResMut<PendingUndos>,
    mut commands: CommandWriter,
) {
    undos.0 -= 1;
    if recording.0 {
        commands.write(Actor::Panel, HistoryCommand::Undo);
    } else {
        undos.0 = 0;
    }
}

fn step(mut steps: MessageWriter<SingleStep>) {
    steps.write(SingleStep);
}

fn go_slower(mut pace: ResMut<Pace>) {
    *pace = pace.slower();
}

fn go_faster(mut pace: ResMut<Pace>) {
    *pace = pace.faster();
}

fn imitate_or_stop(imitating: Res<Imitating>, mut orders: MessageWriter<TaskOrder>) {
    orders.write(match imitating.is_on() {
        true => TaskOrder::Stop,
        false => TaskOrder::Imitate,
    });
}

#[cfg(test)]
mod tests {
    use bevy::time::TimeUpdateStrategy;
    use tabletop_core::{CorePlugin, IssuedCommand, SimCommand, SimTick};
    use tabletop_user::UserPlugin;

    use super::*;

    #[derive(Resource, Default)]
    struct PendingRequests(Vec<Request>);

    #[derive(Resource, Default)]
    struct SentCommands(Vec<SimCommand>);

    fn carry_out(mut asked: ResMut<PendingRequests>, mut orders: Orders) {
        for request in asked.0.drain(..) {
            orders.carry_out(request);
        }
    }

    fn app() -> App {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default(), UserPlugin, plugin))
            .insert_resource(TimeUpdateStrategy::FixedTimesteps(1))
            .init_resource::<ButtonInput<KeyCode>>()
            .init_resource::<PendingRequests>()
            .init_resource::<SentCommands>()
            .add_systems(Update, carry_out)
            .add_systems(
                FixedLast,
                |mut commands: MessageReader<IssuedCommand>, mut reported: ResMut<SentCommands>| {
                    let issued = commands.read();
                    reported
                        .0
                        .extend(issued.map(|issued| issued.command.clone()));
                },
            );
        app.finish();
        app.cleanup();
        app.update();
        app
    }

    fn ask(app: &mut App, request: Request) -> Vec<SimCommand> {
        app.world_mut()
            .resource_mut::<PendingRequests>()
            .0
            .push(request);
        (0..6).for_each(|_| app.update());
        std::mem::take(&mut app.world_mut().resource_mut::<SentCommands>().0)
    }

    fn sent<M: Message + Clone>(app: &mut App, request: Request) -> Vec<M> {
        app.world_mut()
            .resource_mut::<PendingRequests>()
            .0
            .push(request);
        app.update();
        app.world_mut()
            .resource_mut::<Messages<M>>()
            .drain()
            .collect()
    }

    #[test]
    fn requests_become_commands() {
        let mut app = app();
        for (request, command) in [
            (
                Request::Play,
                SimCommand::Clock(ClockCommand::SetPaused(false)),
            ),
            (
                Request::Pause,
                SimCommand::Clock(ClockCommand::SetPaused(true)),
            ),
            (Request::Redo, SimCommand::History(HistoryCommand::Redo)),
        ] {
            assert_eq!(ask(&mut app, request), [command]);
        }
        let tick = SimTick(7);
        for (request, order) in [
            (Request::GoTo(tick), PlaybackOrder::GoTo(tick)),
            (Request::StopAt(tick), PlaybackOrder::StopAt(tick)),
            (Request::Loop(true), PlaybackOrder::Loop(true)),
            (Request::Close, PlaybackOrder::Close),
        ] {
            assert_eq!(sent::<PlaybackOrder>(&mut app, request), [order]);
        }
        let open = Request::Open("demo".into());
        assert_eq!(
            sent::<OpenRecording>(&mut app, open),
            [OpenRecording("demo".into())]
        );
        assert_eq!(sent::<SingleStep>(&mut app, Request::Step), [SingleStep]);
        assert_eq!(
            sent::<FileRequest>(&mut app, Request::SaveVideo),
            [FileRequest::AskForVideo]
        );
        let task = Request::Task(TaskOrder::PutBack);
        assert_eq!(sent::<TaskOrder>(&mut app, task), [TaskOrder::PutBack]);
        ask(&mut app, Request::SetPace(Pace::Double));
        assert_eq!(*app.world().resource::<Pace>(), Pace::Double);
    }

    #[test]
    fn segments_are_undone_one_a_tick_while_a_recording_runs() {
        let mut app = app();
        assert_eq!(ask(&mut app, Request::Undo(3)), []);
        app.insert_resource(Recording(true));
        assert_eq!(
            ask(&mut app, Request::Undo(3)),
            vec![SimCommand::History(HistoryCommand::Undo); 3]
        );
        assert_eq!(
            ask(&mut app, Request::Redo),
            [SimCommand::History(HistoryCommand::Redo)]
        );
    }

    #[test]
    fn keys_step_and_set_the_pace() {
        let mut app = app();
        let keymap = tabletop_user::Keymap::default();
        let strike = |app: &mut App, action| {
            let binding = keymap.bindings(action)[0];
            let mut keys = app.world_mut().resource_mut::<ButtonInput<KeyCode>>();
            if binding.modifiers.shift {
                keys.press(KeyCode::ShiftLeft);
            }
            keys.press(binding.key);
            app.update();
            let mut keys = app.world_mut().resource_mut::<ButtonInput<KeyCode>>();
            keys.reset_all();
        };
        strike(&mut app, Action::Faster);
        assert_eq!(*app.world().resource::<Pace>(), Pace::Double);
        strike(&mut app, Action::Slower);
        assert_eq!(*app.world().resource::<Pace>(), Pace::Normal);
        strike(&mut app, Action::Step);
        let steps = app.world().resource::<Messages<SingleStep>>();
        assert_eq!(steps.iter_current_update_messages().count(), 1);
    }

    #[test]
    fn a_key_lets_the_robot_do_it_and_stops_it() {
        let mut app = app();
        for (imitating, order) in [
            (Imitating::Idle, TaskOrder::Imitate),
            (Imitating::Preparing, TaskOrder::Stop),
        ] {
            app.insert_resource(imitating);
            let mut keys = app.world_mut().resource_mut::<ButtonInput<KeyCode>>();
            keys.press(KeyCode::ControlLeft);
            keys.press(KeyCode::Enter);
            app.update();
            app.world_mut()
                .resource_mut::<ButtonInput<KeyCode>>()
                .reset_all();
            let mut orders = app.world_mut().resource_mut::<Messages<TaskOrder>>();
            assert_eq!(orders.drain().collect::<Vec<_>>(), [order]);
        }
    }
}
