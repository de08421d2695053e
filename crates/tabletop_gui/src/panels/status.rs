//! The Status window: how fast the picture and the simulation are, and what the script does.

use std::time::Duration;

use bevy::prelude::*;
use bevy_egui::{EguiContexts, EguiPrimaryContextPass, egui};
use tabletop_core::{Agent, Paused, SimTick, TICKS_PER_SECOND};

use crate::panels::{Panel, Panels};

/// The time over which speeds are averaged.
const SPAN: Duration = Duration::from_secs(2);

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Speed>()
        .add_systems(Update, measure)
        .add_systems(EguiPrimaryContextPass, show_status);
}

/// Frames and ticks of the last seconds.
#[derive(Resource, Default)]
struct Speed {
    since: Duration,
    frames: u32,
    ticks: SimTick,
    /// Frames a second.
    fps: f32,
    /// Simulated seconds a second.
    pace: f32,
}

fn measure(time: Res<Time<Real>>, tick: Res<SimTick>, mut speed: ResMut<Speed>) {
    speed.frames += 1;
    speed.since += time.delta();
    if speed.since < SPAN {
        return;
    }
    let seconds = speed.since.as_secs_f32();
    let ticks = tick.0.saturating_sub(speed.ticks.0);
    *speed = Speed {
        fps: speed.frames as f32 / seconds,
        pace: ticks as f32 / TICKS_PER_SECOND as f32 / seconds,
        ticks: *tick,
        ..default()
    };
}

fn show_status(
    mut contexts: EguiContexts,
    mut panels: ResMut<Panels>,
    speed: Res<Speed>,
    tick: Res<SimTick>,
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
                ("Simulated", simulated(*tick, *paused, speed.pace)),
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

    #[test]
    fn speeds_are_means_of_two_seconds() {
        let mut app = App::new();
        app.add_plugins(MinimalPlugins)
            .init_resource::<SimTick>()
            .init_resource::<Speed>()
            .add_systems(Update, measure)
            .insert_resource(bevy::time::TimeUpdateStrategy::ManualDuration(
                Duration::from_millis(100),
            ));
        for _ in 0..25 {
            app.world_mut().resource_mut::<SimTick>().0 += 3;
            app.update();
        }
        let speed = app.world().resource::<Speed>();
        assert!((speed.fps - 10.0).abs() < 1.0, "{}", speed.fps);
        assert!((speed.pace - 0.5).abs() < 0.1, "{}", speed.pace);
    }
}
