//! Pace: how fast simulated time passes in a window, and single steps.

use std::time::{Duration, Instant};

use bevy::prelude::*;

use tabletop_core::{
    Actor, ClockCommand, CommandWriter, IdlePlugin, OrderSystems, Paused, RestApp as _,
    RestingSystems, SimTick, TICK_SECONDS,
};

/// Longest time that the ticks of a frame may take together, so that pictures keep coming at any pace.
const LONGEST_TICKS: Duration = Duration::from_millis(50);

/// Longest part of a frame that is simulated. Simulated time stands still for the rest.
const LONGEST_FRAME: Duration = Duration::from_millis(250);

/// The pace of the simulation, as a multiple of real time. Its results do not depend on it.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Reflect)]
#[reflect(Resource)]
pub enum Pace {
    /// A quarter.
    Quarter,
    /// A half.
    Half,
    /// Real time.
    #[default]
    Normal,
    /// Twice as fast.
    Double,
    /// Four times as fast.
    Fourfold,
    /// Eight times as fast.
    Eightfold,
}

impl Pace {
    /// All of them, the slowest first.
    pub const ALL: [Self; 6] = [
        Self::Quarter,
        Self::Half,
        Self::Normal,
        Self::Double,
        Self::Fourfold,
        Self::Eightfold,
    ];

    /// Simulated seconds per second.
    pub const fn factor(self) -> f32 {
        match self {
            Self::Quarter => 0.25,
            Self::Half => 0.5,
            Self::Normal => 1.0,
            Self::Double => 2.0,
            Self::Fourfold => 4.0,
            Self::Eightfold => 8.0,
        }
    }

    /// Its label for the user.
    pub const fn label(self) -> &'static str {
        match self {
            Self::Quarter => "¼×",
            Self::Half => "½×",
            Self::Normal => "1×",
            Self::Double => "2×",
            Self::Fourfold => "4×",
            Self::Eightfold => "8×",
        }
    }

    /// The next slower one; the slowest stays.
    #[must_use]
    pub fn slower(self) -> Self {
        let slower = Self::ALL.into_iter().rev().find(|&pace| pace < self);
        slower.unwrap_or(self)
    }

    /// The next faster one; the fastest stays.
    #[must_use]
    pub fn faster(self) -> Self {
        let faster = Self::ALL.into_iter().find(|&pace| pace > self);
        faster.unwrap_or(self)
    }
}

/// Simulate one tick, and pause.
#[derive(Message, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SingleStep;

/// Lets an app with a window run at its [`Pace`] and make [`SingleStep`]s. Needs [`CorePlugin`](tabletop_core::CorePlugin).
#[derive(Clone, Copy, Debug, Default)]
pub struct PacePlugin;

impl Plugin for PacePlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Pace>()
            .init_resource::<TickCost>()
            .add_message::<SingleStep>()
            .add_systems(
                FixedUpdate,
                make_steps.in_set(OrderSystems::User).in_set(RestingSystems),
            )
            .wake_while(|steps: Res<Messages<SingleStep>>| !steps.is_empty())
            .add_systems(
                RunFixedMainLoop,
                (
                    begin_effort.in_set(RunFixedMainLoopSystems::BeforeFixedMainLoop),
                    (end_effort, go_at_pace)
                        .chain()
                        .in_set(RunFixedMainLoopSystems::AfterFixedMainLoop),
                ),
            )
            .add_plugins(IdlePlugin);
    }
}

/// Lets the simulation run for one tick, by the commands that a user would give.
fn make_steps(
    mut asked_for: MessageReader<SingleStep>,
    mut steps: Local<usize>,
    mut is_stepping: Local<bool>,
    paused: Res<Paused>,
    mut commands: CommandWriter,
) {
    *steps += asked_for.read().count();
    let has_stepped = std::mem::replace(&mut *is_stepping, *steps > 0);
    if *steps > 0 {
        *steps -= 1;
        if paused.0 {
            commands.write(Actor::Panel, ClockCommand::SetPaused(false));
        }
    } else if has_stepped {
        commands.write(Actor::Panel, ClockCommand::SetPaused(true));
    }
}

/// Measured duration of ticks.
#[derive(Resource, Debug)]
struct TickCost {
    begin: Instant,
    first: SimTick,
    /// Duration of a tick, as a moving mean.
    tick: Duration,
}

impl Default for TickCost {
    fn default() -> Self {
        Self {
            begin: Instant::now(),
            first: SimTick(0),
            tick: Duration::ZERO,
        }
    }
}

impl TickCost {
    /// Takes a measurement in: this many ticks took this long.
    fn note(&mut self, ticks: u32, took: Duration) {
        if let Some(tick) = took.checked_div(ticks) {
            self.tick = (self.tick * 3 + tick) / 4;
        }
    }

    /// Longest part of a frame that can be simulated without its ticks exceeding their time; one tick at least.
    fn longest_frame(&self, pace: Pace) -> Duration {
        let ticks = LONGEST_TICKS.as_secs_f32() / self.tick.as_secs_f32().max(1e-6);
        let seconds = ticks.max(1.0) * TICK_SECONDS / pace.factor();
        Duration::from_secs_f32(seconds.min(LONGEST_FRAME.as_secs_f32()))
    }
}

fn begin_effort(mut effort: ResMut<TickCost>, tick: Res<SimTick>) {
    effort.begin = Instant::now();
    effort.first = *tick;
}

fn end_effort(mut effort: ResMut<TickCost>, tick: Res<SimTick>) {
    let took = effort.begin.elapsed();
    let ticks = tick.0.saturating_sub(effort.first.0);
    effort.note(u32::try_from(ticks).unwrap_or(u32::MAX), took);
}

fn go_at_pace(pace: Res<Pace>, effort: Res<TickCost>, mut time: ResMut<Time<Virtual>>) {
    time.set_relative_speed(pace.factor());
    time.set_max_delta(effort.longest_frame(*pace));
}

#[cfg(test)]
mod tests {
    use bevy::time::TimeUpdateStrategy;

    use super::*;
    use tabletop_core::{CorePlugin, WriteCommand as _};

    fn app(frame: TimeUpdateStrategy) -> App {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default(), PacePlugin))
            .insert_resource(frame);
        app.finish();
        app.cleanup();
        app.update();
        app
    }

    fn tick(app: &App) -> u64 {
        app.world().resource::<SimTick>().0
    }

    #[test]
    fn a_step_is_a_tick_however_many_a_frame_has() {
        for ticks_a_frame in [1, 3] {
            let mut app = app(TimeUpdateStrategy::FixedTimesteps(ticks_a_frame));
            app.world_mut().write_command(ClockCommand::SetPaused(true));
            app.update();
            assert_eq!(tick(&app), 0);
            for steps in 1..4 {
                app.world_mut().write_message(SingleStep);
                (0..4).for_each(|_| app.update());
                assert_eq!(tick(&app), steps, "{ticks_a_frame} ticks a frame");
                assert!(app.world().resource::<Paused>().0);
            }
            app.world_mut().write_message_batch([SingleStep; 5]);
            (0..8).for_each(|_| app.update());
            assert_eq!(tick(&app), 8, "several steps are several ticks");
        }
    }

    #[test]
    fn a_step_of_a_running_simulation_is_its_last_tick() {
        let mut app = app(TimeUpdateStrategy::FixedTimesteps(1));
        (0..3).for_each(|_| app.update());
        app.world_mut().write_message(SingleStep);
        (0..5).for_each(|_| app.update());
        assert_eq!(tick(&app), 4);
        assert!(app.world().resource::<Paused>().0);
    }

    #[test]
    fn simulated_time_goes_at_its_pace() {
        for (pace, ticks) in [
            (Pace::Quarter, 15),
            (Pace::Normal, 60),
            (Pace::Eightfold, 480),
        ] {
            let second = TimeUpdateStrategy::ManualDuration(Duration::from_millis(10));
            let mut app = app(second);
            app.insert_resource(pace);
            app.update();
            let before = tick(&app);
            (0..100).for_each(|_| app.update());
            let passed = tick(&app) - before;
            assert!(passed.abs_diff(ticks) <= 1, "{passed} ticks at {pace:?}");
        }
    }

    #[test]
    fn a_frame_simulates_no_more_than_it_can() {
        let mut effort = TickCost::default();
        let frame = |effort: &TickCost, pace| effort.longest_frame(pace).as_secs_f32();
        assert_eq!(frame(&effort, Pace::Normal), 0.25);
        (0..100).for_each(|_| effort.note(10, Duration::from_millis(100)));
        assert!((frame(&effort, Pace::Normal) - 5.0 * TICK_SECONDS).abs() < 1e-4);
        assert!((frame(&effort, Pace::Eightfold) - 5.0 * TICK_SECONDS / 8.0).abs() < 1e-4);
        (0..100).for_each(|_| effort.note(1, Duration::from_secs(1)));
        assert!((frame(&effort, Pace::Normal) - TICK_SECONDS).abs() < 1e-4);
        effort.note(0, Duration::from_secs(1000));
        assert!(frame(&effort, Pace::Quarter) > 0.0);
    }

    #[test]
    fn paces_follow_each_other_and_end() {
        assert_eq!(Pace::Normal.slower().slower().slower(), Pace::Quarter);
        assert_eq!(Pace::Normal.faster(), Pace::Double);
        assert_eq!(Pace::Eightfold.faster(), Pace::Eightfold);
        for pair in Pace::ALL.windows(2) {
            assert!(pair[0].factor() < pair[1].factor());
        }
    }
}
