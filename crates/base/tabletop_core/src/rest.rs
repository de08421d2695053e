//! Rest: ticks in which nothing can change but the clock, so that nothing else is run.

use bevy::{
    app::FixedMainScheduleOrder,
    ecs::{
        message::signal_message_update_system,
        schedule::{
            BoxedCondition, InternedScheduleLabel, ScheduleError, SystemCondition, SystemKey,
        },
        system::ReadOnlySystem,
    },
    platform::collections::HashMap,
    prelude::*,
};

use crate::{
    Agent, Hands, IssuedCommand, Paused, PictureDemand, ScriptCommand, SimBlocked, SimFact, SimTick,
};

/// Systems that change nothing in a tick at rest: one that begins while no [wake source](RestApp::wake_while) is awake. While all
/// systems of the fixed schedules belong to these, `StepApp::step` passes over such ticks. Any other system that is added to an
/// app makes every tick run.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct RestingSystems;

/// Number of ticks at rest that run before the first is passed over: Rapier tidies up after the last body has stopped.
const SETTLING_TICKS: u64 = 16;

/// Declares when something can change.
pub trait RestApp {
    /// Runs every tick before which this condition holds, as something can change in it. Time alone must not make it hold, because
    /// nobody asks while time is passed over.
    fn wake_while<M>(&mut self, is_awake: impl SystemCondition<M>) -> &mut Self;

    /// Runs a tick although the world rests: after as many ticks as this system returns, and at once for 0. `None` lets time go by without
    /// end.
    fn wake_after<M, S>(&mut self, ticks: S) -> &mut Self
    where
        S: IntoSystem<(), Option<u64>, M, System: ReadOnlySystem>;

    /// Runs this upkeep for ticks that are passed over; it receives their number.
    fn at_rest(&mut self, upkeep: Upkeep) -> &mut Self;
}

/// The upkeep for a number of ticks at rest.
pub type Upkeep = fn(&mut World, u64) -> Result;

impl RestApp for App {
    fn wake_while<M>(&mut self, is_awake: impl SystemCondition<M>) -> &mut Self {
        let mut source: BoxedCondition = Box::new(IntoSystem::into_system(is_awake));
        let world = self.world_mut();
        source.initialize(world);
        let mut rest = world.get_resource_or_init::<Rest>();
        rest.wake_sources.push(source);
        self
    }

    fn wake_after<M, S>(&mut self, ticks: S) -> &mut Self
    where
        S: IntoSystem<(), Option<u64>, M, System: ReadOnlySystem>,
    {
        let mut alarm: Alarm = Box::new(IntoSystem::into_system(ticks));
        let world = self.world_mut();
        alarm.initialize(world);
        world.get_resource_or_init::<Rest>().alarms.push(alarm);
        self
    }

    fn at_rest(&mut self, upkeep: Upkeep) -> &mut Self {
        let mut rest = self.world_mut().get_resource_or_init::<Rest>();
        rest.upkeep.push(upkeep);
        self
    }
}

/// The number of ticks for which the world may rest.
type Alarm = Box<dyn ReadOnlySystem<In = (), Out = Option<u64>>>;

/// The rest of the world.
#[derive(Resource, Default)]
pub(crate) struct Rest {
    wake_sources: Vec<BoxedCondition>,
    alarms: Vec<Alarm>,
    upkeep: Vec<Upkeep>,
    /// The first tick of the unbroken row of ticks before which nothing was awake.
    quiet_since: Option<u64>,
    resting: Known,
}

/// For each schedule, whether it holds only [`RestingSystems`], with its sizes when that was found out.
type Known = HashMap<InternedScheduleLabel, (Sizes, bool)>;

/// The number of a schedule's systems, and of the [`RestingSystems`] among them.
type Sizes = (usize, usize);

pub(crate) fn configure(app: &mut App) {
    app.init_resource::<Rest>()
        .wake_while(has_commands)
        .wake_while(is_used);
}

fn has_commands(
    commands: Res<Messages<IssuedCommand>>,
    facts: Res<Messages<SimFact>>,
    script_commands: Res<Messages<ScriptCommand>>,
) -> bool {
    !commands.is_empty() || !facts.is_empty() || !script_commands.is_empty()
}

fn is_used(
    paused: Res<Paused>,
    blocked: Res<SimBlocked>,
    agent: Res<Agent>,
    hands: Res<Hands>,
    demand: Option<Res<PictureDemand>>,
) -> bool {
    let is_asked = demand.is_some_and(|demand| demand.is_asked());
    paused.0 || blocked.0 || agent.is_on() || hands.hold_something() || is_asked
}

/// The number of ticks, including the one that is beginning, in which nothing can change unless the world is changed from outside. Systems
/// outside the crate's own are not asked.
pub(crate) fn ticks_of_rest(world: &mut World) -> u64 {
    let Some(mut rest) = world.get_resource_mut::<Rest>() else {
        return 0;
    };
    let mut rest = std::mem::take(&mut *rest);
    let ticks = rest.ticks(world);
    *world.resource_mut::<Rest>() = rest;
    ticks
}

/// True if every tick at rest may be passed over: all systems are [`RestingSystems`].
pub(crate) fn holds_for_all_systems(world: &mut World) -> bool {
    let mut known = std::mem::take(&mut world.resource_mut::<Rest>().resting);
    let holds = hold_for_all_systems(&mut known, world);
    world.resource_mut::<Rest>().resting = known;
    holds
}

/// Lets the time of this many ticks pass.
pub(crate) fn pass_over(world: &mut World, ticks: u64) {
    let rest = world.resource::<Rest>();
    for upkeep in rest.upkeep.clone() {
        if let Err(error) = upkeep(world, ticks) {
            error!("cannot pass over a tick: {error}");
        }
    }
    world.resource_mut::<SimTick>().0 += ticks;
}

impl Rest {
    fn ticks(&mut self, world: &World) -> u64 {
        // A condition that cannot be asked counts as awake.
        let is_awake = |source: &mut BoxedCondition| source.run_readonly((), world).unwrap_or(true);
        let tick = world.resource::<SimTick>().0;
        if let Some(awake) = self.wake_sources.iter_mut().position(is_awake) {
            // It is asked first in the next tick, in which it is likely to be awake still.
            self.wake_sources[..=awake].rotate_right(1);
            self.quiet_since = None;
            return 0;
        }
        let since = *self.quiet_since.get_or_insert(tick);
        if tick.saturating_sub(since) < SETTLING_TICKS {
            return 0;
        }
        let until = |alarm: &mut Alarm| alarm.run_readonly((), world).unwrap_or(Some(0));
        let alarms = self.alarms.iter_mut().filter_map(until);
        alarms.min().unwrap_or(u64::MAX)
    }
}

fn hold_for_all_systems(known: &mut Known, world: &World) -> bool {
    let (Some(order), Some(schedules)) = (
        world.get_resource::<FixedMainScheduleOrder>(),
        world.get_resource::<Schedules>(),
    ) else {
        return false;
    };
    order.labels.iter().all(|&label| {
        let schedule = schedules.get(label);
        schedule.is_none_or(|schedule| holds_for(known, label, schedule))
    })
}

fn holds_for(known: &mut Known, label: InternedScheduleLabel, schedule: &Schedule) -> bool {
    if schedule.graph().systems.is_empty() {
        return true;
    }
    let resting = match schedule.graph().systems_in_set(RestingSystems.intern()) {
        Ok(resting) => resting.len(),
        Err(ScheduleError::SetNotFound) => 0,
        Err(_) => return false, // Systems were added, and have not run yet.
    };
    let sizes = (schedule.systems_len(), resting);
    match known.get(&label) {
        Some(&(known, rests)) if known == sizes => rests,
        Some(_) | None => {
            let rests = holds_resting_systems_only(schedule);
            known.insert(label, (sizes, rests));
            rests
        }
    }
}

fn holds_resting_systems_only(schedule: &Schedule) -> bool {
    let graph = schedule.graph();
    let of_bevy = signal_message_update_system.into_system_set().intern();
    let is_among = |set, key: SystemKey| {
        let systems = graph.systems_in_set(set);
        systems.is_ok_and(|systems| systems.contains(&key))
    };
    schedule.systems().is_ok_and(|mut systems| {
        systems.all(|(key, system)| {
            is_among(RestingSystems.intern(), key)
                || is_among(of_bevy, key)
                || system.system_type() == std::any::TypeId::of::<ApplyDeferred>()
        })
    })
}

#[cfg(test)]
mod tests {
    use bevy::ecs::schedule::ScheduleLabel as _;

    use super::*;
    use crate::{CorePlugin, SceneCommand, StepApp as _, WriteCommand as _};

    #[derive(Resource, Default)]
    struct Ticks(u64);

    fn count(mut ticks: ResMut<Ticks>) {
        ticks.0 += 1;
    }

    /// An app that counts the ticks that are run.
    fn app() -> App {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default()))
            .init_resource::<Ticks>()
            .add_systems(FixedUpdate, count.in_set(RestingSystems));
        app
    }

    fn ticks_made(app: &mut App, ticks: u64) -> u64 {
        let before = app.world().resource::<Ticks>().0;
        app.step(ticks);
        app.world().resource::<Ticks>().0 - before
    }

    #[test]
    fn ticks_at_rest_are_passed_over_and_counted() {
        let mut app = app();
        app.start();
        assert_eq!(ticks_made(&mut app, 100), SETTLING_TICKS);
        assert_eq!(ticks_made(&mut app, 1), 0);
        assert_eq!(app.world().resource::<SimTick>().0, 101);
    }

    #[test]
    fn a_command_wakes() {
        let mut app = app();
        app.start().step(100);
        app.world_mut().write_command(SceneCommand::Clear);
        assert!(ticks_made(&mut app, 100) > SETTLING_TICKS);
    }

    #[test]
    fn a_wake_source_that_is_awake_wakes() {
        let mut app = app();
        // Time alone makes this hold, between two calls of `step`.
        app.wake_while(|tick: Res<SimTick>| (50..60).contains(&tick.0))
            .start();
        for (ticks, made) in [(50, SETTLING_TICKS), (1, 1), (9, 9), (40, SETTLING_TICKS)] {
            assert_eq!(ticks_made(&mut app, ticks), made);
        }
    }

    #[test]
    fn a_tick_that_is_due_is_made_and_those_before_and_after_it_are_not() {
        let mut app = app();
        app.wake_after(|tick: Res<SimTick>| 50u64.checked_sub(tick.0))
            .start();
        assert_eq!(ticks_made(&mut app, 1000), SETTLING_TICKS + 1);
        assert_eq!(app.world().resource::<SimTick>().0, 1000);
        app.wake_after(|tick: Res<SimTick>| Some((tick.0 / 10 + 1) * 10 - tick.0 - 1));
        assert_eq!(ticks_made(&mut app, 105), 10);
    }

    #[test]
    fn another_system_sees_every_tick() {
        for schedule in [FixedUpdate.intern(), FixedLast.intern()] {
            let mut app = app();
            app.start().step(100);
            app.add_systems(schedule, || {});
            assert_eq!(ticks_made(&mut app, 100), 100);
        }
    }
}
