//! The one clock: ticks of a fixed length, in the same order of phases everywhere.

use bevy::{
    app::FixedMainScheduleOrder,
    ecs::{
        change_detection::Tick,
        message::{MessageRegistry, ShouldUpdateMessages},
        schedule::{InternedScheduleLabel, ScheduleLabel as _, SingleThreadedExecutor},
    },
    prelude::*,
};

use crate::{
    ActuateSystems, CommandSystems, MechanismSystems, OrderSystems, Paused, PictureDemand,
    PictureSystems, RestingSystems, SimBlocked, SimSystems, SimTick, TICKS_PER_SECOND, TickSystems,
    rest,
};

pub(crate) fn configure(app: &mut App) {
    app.init_resource::<SimTick>()
        .init_resource::<Paused>()
        .insert_resource(Time::<Fixed>::from_hz(f64::from(TICKS_PER_SECOND)))
        .configure_sets(
            FixedUpdate,
            (
                SimSystems::Load,
                SimSystems::Ingest,
                SimSystems::Actuate.run_if(Paused::is_running),
                SimSystems::Physics.run_if(Paused::is_running),
                SimSystems::Propagate,
                SimSystems::Sense.run_if(Paused::is_running),
                (PictureSystems::Receive, PictureSystems::Draw)
                    .chain()
                    .run_if(PictureDemand::is_due),
                SimSystems::Record.run_if(Paused::is_running),
                SimSystems::Advance.run_if(Paused::is_running),
            )
                .chain()
                .in_set(TickSystems),
        )
        .configure_sets(
            FixedUpdate,
            (
                OrderSystems::Scenario.run_if(SimBlocked::is_clear),
                OrderSystems::User.run_if(SimBlocked::is_clear),
                OrderSystems::Controller.run_if(SimBlocked::is_clear),
                OrderSystems::Script,
                TickSystems.run_if(SimBlocked::is_clear),
            )
                .chain(),
        )
        .configure_sets(
            FixedUpdate,
            (
                CommandSystems::History,
                SimSystems::Load,
                CommandSystems::Recording,
                CommandSystems::Clock,
                SimSystems::Ingest,
                CommandSystems::Hands,
                CommandSystems::Mechanisms,
                CommandSystems::Robot,
                SimSystems::Actuate,
            )
                .chain()
                .in_set(TickSystems),
        )
        .configure_sets(
            FixedUpdate,
            CommandSystems::Scene.in_set(SimSystems::Ingest),
        )
        .configure_sets(
            FixedUpdate,
            (MechanismSystems::Obey, MechanismSystems::React)
                .chain()
                .in_set(CommandSystems::Mechanisms),
        )
        .configure_sets(
            FixedUpdate,
            (ActuateSystems::Hands, ActuateSystems::Robot)
                .chain()
                .in_set(SimSystems::Actuate),
        )
        .add_systems(
            FixedUpdate,
            advance_tick
                .in_set(SimSystems::Advance)
                .in_set(RestingSystems),
        );
}

fn advance_tick(mut tick: ResMut<SimTick>) {
    tick.0 += 1;
}

/// Runs the schedules of a tick on one thread. Their systems are many and short: handing them to a thread pool
/// costs more than ten times the work itself.
pub(crate) fn run_ticks_on_one_thread(app: &mut App) {
    fn on_one_thread(schedule: &mut Schedule) {
        schedule.set_executor(SingleThreadedExecutor::new());
    }
    app.edit_schedule(FixedFirst, on_one_thread)
        .edit_schedule(FixedPreUpdate, on_one_thread)
        .edit_schedule(FixedUpdate, on_one_thread)
        .edit_schedule(FixedPostUpdate, on_one_thread)
        .edit_schedule(FixedLast, on_one_thread);
}

/// Steps an app without a window as fast as the machine can.
pub trait StepApp {
    /// Finishes the plugins and runs the start-up schedules, once; afterwards the app can be [stepped](Self::step).
    fn start(&mut self) -> &mut Self;

    /// Simulates this many ticks, without anything of the frame around them: no wall clock, no [`Update`]. Ticks
    /// [at rest](RestingSystems) are passed over.
    fn step(&mut self, ticks: u64) -> &mut Self;
}

impl StepApp for App {
    fn start(&mut self) -> &mut Self {
        self.finish();
        self.cleanup();
        for schedule in [PreStartup.intern(), Startup.intern(), PostStartup.intern()] {
            let _absent_in_a_bare_app = self.world_mut().try_run_schedule(schedule);
        }
        self
    }

    fn step(&mut self, ticks: u64) -> &mut Self {
        step_world(self.world_mut(), ticks);
        self
    }
}

/// [`StepApp::step`] for the world of a started app, which unlike the app can be sent to another thread.
pub fn step_world(world: &mut World, ticks: u64) {
    let mut left = ticks;
    while left > 0 {
        let resting = rest::ticks_of_rest(world).min(left);
        if resting > 0 && rest::holds_for_all_systems(world) {
            rest::pass_over(world, resting);
            (0..resting.min(2)).for_each(|_| end_tick(world));
            left -= resting;
        } else {
            run_tick(world);
            end_tick(world);
            left -= 1;
        }
    }
}

/// Runs the schedules of a tick that have systems. Bevy's own way to run them takes their order out of the world and puts it back, which costs
/// more than an empty schedule.
fn run_tick(world: &mut World) {
    let mut number = 0;
    while let Some(label) = nth_schedule(world, number) {
        let schedule = world.resource::<Schedules>().get(label);
        if schedule.is_some_and(|it| !it.graph().systems.is_empty()) {
            world.run_schedule(label);
        }
        number += 1;
    }
}

fn nth_schedule(world: &World, number: usize) -> Option<InternedScheduleLabel> {
    let order = world.get_resource::<FixedMainScheduleOrder>()?;
    order.labels.get(number).copied()
}

/// The moment at which messages were last forgotten.
#[derive(Resource, Clone, Copy, Default)]
struct Forgotten(Tick);

/// Forgets the messages and removals of the previous tick. After two ticks, nothing is left of them.
fn end_tick(world: &mut World) {
    let Forgotten(before) = *world.get_resource_or_init();
    if let Some(mut registry) = world.get_resource_mut::<MessageRegistry>() {
        let mut messages = std::mem::take(&mut *registry);
        messages.run_updates(world, before);
        if messages.should_update == ShouldUpdateMessages::Ready {
            messages.should_update = ShouldUpdateMessages::Waiting;
        }
        *world.resource_mut() = messages;
    }
    // What is written before the next tick is newer.
    let now = world.increment_change_tick();
    *world.resource_mut() = Forgotten(now);
    world.clear_trackers();
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ClockCommand, CorePlugin, IssuedCommand, SceneCommand, WriteCommand as _};

    #[test]
    fn a_pause_stops_the_clock_and_not_the_commands() {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default()))
            .start();
        app.step(3);
        app.world_mut().write_command(ClockCommand::SetPaused(true));
        app.step(5);
        assert_eq!(app.world().resource::<SimTick>().0, 3);
        app.world_mut()
            .write_command(ClockCommand::SetPaused(false));
        app.step(2);
        assert_eq!(app.world().resource::<SimTick>().0, 5);
    }

    #[test]
    fn stepping_drops_old_messages() {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default()))
            .start();
        for _ in 0..10 {
            app.world_mut().write_command(SceneCommand::Clear);
            app.step(1);
        }
        let kept = |app: &App| app.world().resource::<Messages<IssuedCommand>>().len();
        assert!(kept(&app) <= 2, "{} messages are kept", kept(&app));
        app.step(3);
        assert_eq!(kept(&app), 0);
    }
}
