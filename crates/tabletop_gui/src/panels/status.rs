//! The Status window: how fast the picture and the simulation are, and what the script does.

use std::time::Duration;

use bevy::prelude::*;
use bevy_egui::{EguiContexts, EguiPrimaryContextPass, egui};
use tabletop_core::{Agent, Paused, SimTick, TICKS_PER_SECOND};

use crate::{
    Picture,
    panels::{Panel, Panels},
};

/// The time over which speeds are averaged.
const SPAN: Duration = Duration::from_secs(2);

/// How often the simulated time is told while nothing else changes in the picture.
const STILL_SPAN: Duration = Duration::from_secs(1);

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Speed>()
        .init_resource::<Clock>()
        .add_systems(Update, (measure, tell_time))
        .add_systems(EguiPrimaryContextPass, show_status);
}

/// Pictures and ticks of the last seconds.
#[derive(Resource, Default)]
struct Speed {
    since: Duration,
    drawn: u64,
    ticks: SimTick,
    /// Pictures a second.
    fps: f32,
    /// Simulated seconds a second.
    pace: f32,
}

/// The simulated time as the window shows it.
#[derive(Resource, Default)]
struct Clock {
    tick: SimTick,
    read_at: Duration,
}

fn tell_time(
    time: Res<Time<Real>>,
    tick: Res<SimTick>,
    picture: Res<Picture>,
    paused: Res<Paused>,
    mut clock: ResMut<Clock>,
) {
    let now = time.elapsed();
    if !picture.is_still || paused.0 || now >= clock.read_at + STILL_SPAN {
        *clock = Clock {
            tick: *tick,
            read_at: now,
        };
    }
}

fn measure(
    time: Res<Time<Real>>,
    tick: Res<SimTick>,
    picture: Res<Picture>,
    mut speed: ResMut<Speed>,
) {
    speed.since += time.delta();
    if speed.since < SPAN {
        return;
    }
    let seconds = speed.since.as_secs_f32();
    let ticks = tick.0.saturating_sub(speed.ticks.0);
    *speed = Speed {
        fps: picture.drawn.saturating_sub(speed.drawn) as f32 / seconds,
        pace: ticks as f32 / TICKS_PER_SECOND as f32 / seconds,
        drawn: picture.drawn,
        ticks: *tick,
        ..default()
    };
}

fn show_status(
    mut contexts: EguiContexts,
    mut panels: ResMut<Panels>,
    speed: Res<Speed>,
    clock: Res<Clock>,
    paused: Res<Paused>,
    agent: Res<Agent>,
) {
    let Ok(context) = contexts.ctx_mut() else {
        return;
    };
    Panel::Status.show(context, &mut panels, |ui| {
        let grid = egui::Grid::new("status").spacing(egui::vec2(12.0, 2.0));
        grid.show(ui, |ui| {
            for (name, value) in [
                ("FPS", format!("{:03.0}", speed.fps)),
                ("Simulated", simulated(clock.tick, *paused, speed.pace)),
                ("Matlab", matlab(&agent)),
            ] {
                ui.label(name);
                ui.label(value);
                ui.end_row();
            }
        });
    });
}

fn simulated(tick: SimTick, paused: Paused, pace: f32) -> String {
    let seconds = tick.0 as f64 / f64::from(TICKS_PER_SECOND);
    match paused.0 {
        true => format!("{seconds:.1} s, paused"),
        false => format!("{seconds:.1} s, {pace:.2} × real time"),
    }
}

/// What the script does, in words.
fn matlab(agent: &Agent) -> String {
    match agent {
        Agent::Off => "offline".into(),
        Agent::Starting => "starting".into(),
        Agent::Online { took } => format!("online, {:.1} ms a call", took.as_secs_f64() * 1e3),
        Agent::Waiting { since } => format!("waiting for script {:.1} s", since.as_secs_f64()),
        Agent::Failed => "stopped by an error".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_script_has_words_for_all_that_it_does() {
        let ms = Duration::from_millis;
        for (agent, words) in [
            (Agent::Off, "offline"),
            (Agent::Online { took: ms(1) }, "online, 1.0 ms a call"),
            (
                Agent::Waiting { since: ms(3210) },
                "waiting for script 3.2 s",
            ),
        ] {
            assert_eq!(matlab(&agent), words);
        }
    }

    fn app() -> App {
        let mut app = App::new();
        app.add_plugins(MinimalPlugins)
            .init_resource::<SimTick>()
            .init_resource::<Paused>()
            .init_resource::<Picture>()
            .init_resource::<Speed>()
            .init_resource::<Clock>()
            .add_systems(Update, (measure, tell_time))
            .insert_resource(bevy::time::TimeUpdateStrategy::ManualDuration(
                Duration::from_millis(100),
            ));
        app
    }

    /// A frame with three ticks, drawn or not.
    fn frame(app: &mut App, is_drawn: bool) {
        app.world_mut().resource_mut::<SimTick>().0 += 3;
        app.update();
        app.world_mut().resource_mut::<Picture>().drawn += u64::from(is_drawn);
    }

    #[test]
    fn speeds_are_means_of_two_seconds() {
        let mut app = app();
        for number in 0..25 {
            frame(&mut app, number % 2 == 0);
        }
        let speed = app.world().resource::<Speed>();
        assert!((speed.fps - 5.0).abs() < 1.0, "{}", speed.fps);
        assert!((speed.pace - 0.5).abs() < 0.1, "{}", speed.pace);
    }

    #[test]
    fn a_still_picture_tells_the_time_once_a_second() {
        let mut app = app();
        for (is_still, different) in [(false, 30), (true, 3)] {
            app.world_mut().resource_mut::<Picture>().is_still = is_still;
            let mut told = std::collections::BTreeSet::new();
            for _ in 0..30 {
                frame(&mut app, true);
                told.insert(app.world().resource::<Clock>().tick.0);
            }
            let distinct = told.len();
            assert!(distinct.abs_diff(different) <= 1, "{distinct}");
        }
    }
}
