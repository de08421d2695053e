//! Speeds of the picture, the simulation and the script, and the simulated time.

use std::time::Duration;

use bevy::prelude::*;
use tabletop_core::{Agent, Idle, Paused, SimTick, TICKS_PER_SECOND};

use crate::PictureStatus;

/// The time over which speeds are averaged.
const SPAN: Duration = Duration::from_secs(2);

/// Time between updates of the simulated time while nothing else changes in the picture.
const STILL_SPAN: Duration = Duration::from_secs(1);

/// Pictures, ticks and calls of the script in the last seconds.
#[derive(Resource, Default)]
pub(super) struct Speed {
    since: Duration,
    drawn: u64,
    ticks: SimTick,
    calls: u32,
    calling: Duration,
    pub mean: Means,
}

/// The shown means.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Means {
    /// Pictures a second; none before they have been counted.
    pub fps: Option<f32>,
    /// Simulated seconds a second.
    pub pace: f32,
    /// The time that a call of the script took.
    pub call: Option<Duration>,
}

pub(super) fn measure(
    time: Res<Time<Real>>,
    tick: Res<SimTick>,
    agent: Res<Agent>,
    picture: Res<PictureStatus>,
    mut speed: ResMut<Speed>,
) {
    speed.since += time.delta();
    if let Agent::Online { took } = *agent {
        speed.calls += 1;
        speed.calling += took;
    }
    if speed.since < SPAN {
        return;
    }
    let seconds = speed.since.as_secs_f32();
    let ticks = tick.0.saturating_sub(speed.ticks.0);
    *speed = Speed {
        mean: Means {
            fps: Some(picture.drawn.saturating_sub(speed.drawn) as f32 / seconds),
            pace: ticks as f32 / TICKS_PER_SECOND as f32 / seconds,
            call: speed.calling.checked_div(speed.calls),
        },
        drawn: picture.drawn,
        ticks: *tick,
        ..default()
    };
}

/// The simulated time as the window shows it.
#[derive(Resource, Default)]
pub(super) struct Clock {
    pub tick: SimTick,
    read_at: Duration,
    /// True if the world has been resting since.
    pub is_resting: bool,
}

/// Reads the clock as often as the window shows another time.
pub(super) fn tell_time(
    time: Res<Time<Real>>,
    tick: Res<SimTick>,
    picture: Res<PictureStatus>,
    paused: Res<Paused>,
    idle: Res<Idle>,
    mut clock: ResMut<Clock>,
) {
    let now = time.elapsed();
    let is_resting = picture.is_still && *idle != Idle(0);
    let is_due = !picture.is_still || now >= clock.read_at + STILL_SPAN;
    // While the world rests, the clock tells since when: a new picture only to tell the time costs more than all else.
    if paused.0 || (is_due && !(is_resting && clock.is_resting)) {
        *clock = Clock {
            tick: *tick,
            read_at: now,
            is_resting,
        };
    }
}

#[cfg(test)]
mod tests {
    use bevy::time::TimeUpdateStrategy;

    use super::*;

    const fn ms(ms: u64) -> Duration {
        Duration::from_millis(ms)
    }

    fn app() -> App {
        let mut app = App::new();
        app.add_plugins(MinimalPlugins)
            .init_resource::<SimTick>()
            .init_resource::<Paused>()
            .init_resource::<PictureStatus>()
            .init_resource::<Speed>()
            .init_resource::<Clock>()
            .init_resource::<Agent>()
            .init_resource::<Idle>()
            .add_systems(Update, (measure, tell_time))
            .insert_resource(TimeUpdateStrategy::ManualDuration(ms(100)));
        app
    }

    /// A frame with three ticks, drawn or not.
    fn frame(app: &mut App, is_drawn: bool) {
        app.world_mut().resource_mut::<SimTick>().0 += 3;
        app.update();
        app.world_mut().resource_mut::<PictureStatus>().drawn += u64::from(is_drawn);
    }

    #[test]
    fn speeds_are_means_of_two_seconds() {
        let mut app = app();
        for number in 0..25 {
            let took = ms(if number % 2 == 0 { 1 } else { 3 });
            app.insert_resource(Agent::Online { took });
            frame(&mut app, number % 2 == 0);
        }
        let mean = app.world().resource::<Speed>().mean;
        let fps = mean.fps.unwrap();
        assert!((fps - 5.0).abs() < 0.6, "{mean:?}");
        assert!((mean.pace - 0.5).abs() < 0.1, "{mean:?}");
        let call = mean.call.unwrap();
        assert!(ms(1) < call && call < ms(3), "{mean:?}");
    }

    #[test]
    fn a_still_picture_tells_the_time_once_a_second() {
        let mut app = app();
        for (is_still, different) in [(false, 30), (true, 3)] {
            app.world_mut().resource_mut::<PictureStatus>().is_still = is_still;
            let mut reported = std::collections::BTreeSet::new();
            for _ in 0..30 {
                frame(&mut app, true);
                reported.insert(app.world().resource::<Clock>().tick.0);
            }
            let distinct = reported.len();
            assert!(distinct.abs_diff(different) <= 1, "{distinct}");
        }
    }

    #[test]
    fn the_time_of_a_world_at_rest_is_since_when_it_rests() {
        let mut app = app();
        app.world_mut().resource_mut::<PictureStatus>().is_still = true;
        app.insert_resource(Idle(u64::MAX));
        (0..11).for_each(|_| frame(&mut app, false));
        let clock = app.world().resource::<Clock>();
        let since = clock.tick;
        assert!(clock.is_resting);
        (0..50).for_each(|_| frame(&mut app, false));
        assert_eq!(app.world().resource::<Clock>().tick, since);
        app.insert_resource(Idle(0));
        frame(&mut app, false);
        let clock = app.world().resource::<Clock>();
        assert!(!clock.is_resting && clock.tick.0 > since.0 + 100);
    }
}
