//! The Status window (report figure 4): speeds of the picture and the simulation, the script, the recording.

mod model;
mod speed;
mod words;

use std::path::PathBuf;

use bevy::{ecs::system::SystemParam, prelude::*};
use bevy_egui::{
    EguiContexts, EguiPrimaryContextPass,
    egui::{Label, RichText, Ui},
};
use tabletop_core::{
    Agent, History, Idle, Paused, Recording, RecordingFact, Replaying, SimFact, SimTick,
    TICKS_PER_SECOND,
};

pub use self::model::Renderer;
use self::{
    model::{FilmState, Model},
    speed::{Clock, Speed, measure, tell_time},
    words::{frames, matlab, recording, simulated, undo, words_for},
};
use crate::{
    PictureStatus,
    panels::{Panel, Panels},
    widgets::style::ThemeColors,
};

/// Height of a row, and width of the names of the values, in points.
const ROW_HEIGHT: f32 = 16.0;
const NAME_WIDTH: f32 = 84.0;

/// Ticks between two frames of a recording (report section 4.1: four images a second).
const TICKS_PER_FRAME: u64 = TICKS_PER_SECOND as u64 / 4;

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Speed>()
        .init_resource::<Clock>()
        .init_resource::<Idle>()
        .init_resource::<Take>()
        .add_systems(Update, (measure, tell_time, follow_recording))
        .add_systems(EguiPrimaryContextPass, show_panel);
}

/// The folder and the beginning of the present recording.
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
struct Take {
    folder: PathBuf,
    began: SimTick,
}

fn follow_recording(mut facts: MessageReader<SimFact>, tick: Res<SimTick>, mut take: ResMut<Take>) {
    for fact in facts.read() {
        if let SimFact::Recording(RecordingFact::Started { folder, .. }) = fact {
            *take = Take {
                folder: folder.clone(),
                began: *tick,
            };
        }
    }
}

/// The resources from which the model is made.
#[derive(SystemParam)]
struct Sources<'w> {
    speed: Res<'w, Speed>,
    clock: Res<'w, Clock>,
    tick: Res<'w, SimTick>,
    paused: Res<'w, Paused>,
    agent: Res<'w, Agent>,
    recording: Res<'w, Recording>,
    replaying: Res<'w, Replaying>,
    take: Res<'w, Take>,
    history: Res<'w, History>,
    picture: Res<'w, PictureStatus>,
    renderer: Option<Res<'w, Renderer>>,
}

impl Sources<'_> {
    fn model(&self) -> Model {
        Model {
            mean: self.speed.mean,
            is_still: self.picture.is_still,
            tick: self.clock.tick,
            is_resting: self.clock.is_resting,
            is_paused: self.paused.0,
            agent: self.agent.clone(),
            film: self.film(),
            history: *self.history,
            renderer: self.renderer.as_deref().cloned(),
        }
    }

    fn film(&self) -> FilmState {
        let ticks = self.tick.0.saturating_sub(self.take.began.0);
        match (self.recording.0, self.replaying.0) {
            (true, _) => FilmState::Recorded {
                folder: self.take.folder.clone(),
                segment: self.history.dropped + self.history.undoable,
                frame: ticks / TICKS_PER_FRAME,
            },
            (false, true) => FilmState::Replayed,
            (false, false) => FilmState::None,
        }
    }
}

fn show_panel(mut contexts: EguiContexts, mut panels: ResMut<Panels>, sources: Sources) {
    let Ok(context) = contexts.ctx_mut() else {
        return;
    };
    if panels.is_open(Panel::Status) {
        let model = sources.model();
        Panel::Status.show(context, &mut panels, |ui| show(ui, &model));
    }
}

fn show(ui: &mut Ui, model: &Model) {
    ui.spacing_mut().interact_size.y = ROW_HEIGHT;
    ui.spacing_mut().item_spacing.y = 2.0;
    row(ui, "FPS", frames(model));
    row(ui, "Simulated", simulated(model));
    row(ui, "Matlab", matlab(&model.agent, model.mean.call));
    row(ui, "Recording", recording(&model.film));
    row(ui, "Undo", undo(&model.history));
    if let Some(renderer) = &model.renderer {
        row(
            ui,
            "Renderer",
            words_for(renderer, ThemeColors::of(ui.visuals())),
        );
    }
}

fn row(ui: &mut Ui, name: &str, value: impl Into<RichText>) {
    ui.horizontal(|ui| {
        let cursor = ui.cursor().left();
        ui.label(RichText::new(name).weak());
        ui.add_space(cursor + NAME_WIDTH - ui.cursor().left());
        ui.add(Label::new(value.into()).truncate());
    });
}

#[cfg(test)]
mod tests {
    use bevy::{ecs::system::RunSystemOnce as _, time::TimeUpdateStrategy};
    use egui_kittest::{Harness, kittest::Queryable as _};
    use tabletop_core::CorePlugin;
    use tabletop_user::UserPlugin;

    use super::speed::Means;
    use super::*;

    #[test]
    fn everything_is_shown_in_words() {
        let model = Model {
            mean: Means {
                fps: Some(59.6),
                pace: 0.5,
                call: None,
            },
            tick: SimTick(125),
            film: FilmState::Recorded {
                folder: "demo".into(),
                segment: 2,
                frame: 57,
            },
            history: History::default(),
            renderer: Some(Renderer {
                name: "llvmpipe".into(),
                is_software: true,
            }),
            ..default()
        };
        let harness = Harness::new_ui(move |ui| show(ui, &model));
        for value in [
            "060",
            "2.1 s, 0.50 × real time",
            "offline",
            "segment 2, frame 57 in demo",
            "software renderer (llvmpipe)",
        ] {
            assert!(harness.query_by_label(value).is_some(), "{value}");
        }
    }

    #[test]
    fn at_rest_nothing_is_recorded_and_time_stands() {
        let model = Model {
            is_paused: true,
            is_still: true,
            ..default()
        };
        let harness = Harness::new_ui(move |ui| show(ui, &model));
        for value in ["at rest", "0.0 s, paused", "not recording"] {
            assert!(harness.query_by_label(value).is_some(), "{value}");
        }
        assert!(harness.query_by_label("Renderer").is_none());
    }

    #[test]
    fn a_recording_is_followed_frame_by_frame() {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default(), UserPlugin))
            .insert_resource(TimeUpdateStrategy::ManualDuration(
                std::time::Duration::ZERO,
            ))
            .init_resource::<Speed>()
            .init_resource::<Clock>()
            .init_resource::<Take>()
            .init_resource::<PictureStatus>()
            .add_systems(Update, follow_recording);
        app.insert_resource(SimTick(100));
        app.world_mut()
            .write_message(SimFact::Recording(RecordingFact::Started {
                cause: tabletop_core::CommandId(0),
                folder: "demo".into(),
                moved_aside: None,
            }));
        app.update();
        app.insert_resource(SimTick(131));
        let mut film = |recording, replaying, undoable| {
            app.insert_resource(Recording(recording));
            app.insert_resource(Replaying(replaying));
            app.insert_resource(History {
                undoable,
                redoable: 0,
                ..default()
            });
            let film = |sources: Sources| sources.film();
            app.world_mut().run_system_once(film).unwrap()
        };
        assert_eq!(film(false, false, 0), FilmState::None);
        assert_eq!(film(false, true, 0), FilmState::Replayed);
        let expected = FilmState::Recorded {
            folder: "demo".into(),
            segment: 3,
            frame: 2,
        };
        assert_eq!(film(true, false, 3), expected);
    }
}
