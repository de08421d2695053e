//! The Status window (report figure 4): speeds of the picture and the simulation, the script, the recording.

use std::{path::PathBuf, time::Duration};

use bevy::{ecs::system::SystemParam, prelude::*};
use bevy_egui::{
    EguiContexts, EguiPrimaryContextPass,
    egui::{Label, RichText, Ui},
};
use tabletop_core::{
    Agent, History, Paused, Recording, RecordingFact, Replaying, SimFact, SimTick, TICKS_PER_SECOND,
};

use crate::{
    PictureStatus,
    panels::{Panel, Panels},
    widgets::style::ThemeColors,
};

/// The time over which speeds are averaged.
const SPAN: Duration = Duration::from_secs(2);

/// Time between updates of the simulated time while nothing else changes in the picture.
const STILL_SPAN: Duration = Duration::from_secs(1);

/// Height of a row, and width of the names of the values, in points.
const ROW_HEIGHT: f32 = 16.0;
const NAME_WIDTH: f32 = 84.0;

/// Ticks between two frames of a recording (report section 4.1: four images a second).
const TICKS_PER_FRAME: u64 = TICKS_PER_SECOND as u64 / 4;

/// The renderer of the window. The code that opens the window sets it.
#[derive(Resource, Clone, Debug, PartialEq, Eq)]
pub struct Renderer {
    /// The name that it gives itself.
    pub name: String,
    /// True if it draws on the processor instead of a graphics card.
    pub is_software: bool,
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Speed>()
        .init_resource::<Clock>()
        .init_resource::<Take>()
        .add_systems(Update, (measure, tell_time, follow_recording))
        .add_systems(EguiPrimaryContextPass, show_panel);
}

/// Pictures, ticks and calls of the script in the last seconds.
#[derive(Resource, Default)]
struct Speed {
    since: Duration,
    drawn: u64,
    ticks: SimTick,
    calls: u32,
    calling: Duration,
    mean: Means,
}

/// The shown means.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Means {
    /// Pictures a second.
    fps: f32,
    /// Simulated seconds a second.
    pace: f32,
    /// The time that a call of the script took.
    call: Option<Duration>,
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
    picture: Res<PictureStatus>,
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
            fps: picture.drawn.saturating_sub(speed.drawn) as f32 / seconds,
            pace: ticks as f32 / TICKS_PER_SECOND as f32 / seconds,
            call: speed.calling.checked_div(speed.calls),
        },
        drawn: picture.drawn,
        ticks: *tick,
        ..default()
    };
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

/// The content of the window.
#[derive(Clone, Debug, Default, PartialEq)]
struct Model {
    mean: Means,
    /// True if nothing moves in the picture.
    is_still: bool,
    /// The simulated time.
    tick: SimTick,
    is_paused: bool,
    agent: Agent,
    film: FilmState,
    history: History,
    renderer: Option<Renderer>,
}

/// The state of recordings.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
enum FilmState {
    #[default]
    None,
    /// One is written.
    Recorded {
        folder: PathBuf,
        segment: usize,
        frame: u64,
    },
    /// One is played.
    Replayed,
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

/// Pictures a second. Of a still picture their number says nothing.
fn frames(model: &Model) -> String {
    match model.is_still {
        true => "at rest".into(),
        false => format!("{:03.0}", model.mean.fps),
    }
}

fn simulated(model: &Model) -> String {
    let seconds = model.tick.0 as f64 / f64::from(TICKS_PER_SECOND);
    match model.is_paused {
        true => format!("{seconds:.1} s, paused"),
        false => format!("{seconds:.1} s, {:.2} × real time", model.mean.pace),
    }
}

/// The state of the script, in words.
fn matlab(agent: &Agent, call: Option<Duration>) -> String {
    match (agent, call) {
        (Agent::Off, _) => "offline".into(),
        (Agent::Starting, _) => "starting".into(),
        (Agent::Online { .. }, None) => "online".into(),
        (Agent::Online { .. }, Some(call)) => {
            format!("online, {:.1} ms a call", call.as_secs_f64() * 1e3)
        }
        (Agent::Waiting { since }, _) => {
            format!("waiting for script {:.1} s", since.as_secs_f64())
        }
        (Agent::Failed, _) => "stopped by an error".into(),
    }
}

fn recording(film: &FilmState) -> String {
    match film {
        FilmState::None => "not recording".into(),
        FilmState::Recorded {
            folder,
            segment,
            frame,
        } => format!("segment {segment}, frame {frame} in {}", folder.display()),
        FilmState::Replayed => "a recording is played".into(),
    }
}

/// The number of segments that can be undone, and the memory that they take.
fn undo(history: &History) -> String {
    const MEGABYTE: usize = 1024 * 1024;
    let [used, most] = [history.bytes, history.most_bytes].map(|bytes| bytes.div_ceil(MEGABYTE));
    let segments = match history.undoable {
        1 => "1 segment".to_owned(),
        count => format!("{count} segments"),
    };
    let memory = format!("{segments}, {used} of {most} MB");
    match history.dropped {
        0 => memory,
        dropped => format!("{memory}; the first {dropped} are kept no longer"),
    }
}

fn words_for(renderer: &Renderer, colors: &ThemeColors) -> RichText {
    match renderer.is_software {
        true => {
            RichText::new(format!("software renderer ({})", renderer.name)).color(colors.warning)
        }
        false => renderer.name.as_str().into(),
    }
}

#[cfg(test)]
mod tests {
    use bevy::{ecs::system::RunSystemOnce as _, time::TimeUpdateStrategy};
    use egui_kittest::{Harness, kittest::Queryable as _};
    use tabletop_core::CorePlugin;
    use tabletop_user::UserPlugin;

    use super::*;

    const fn ms(ms: u64) -> Duration {
        Duration::from_millis(ms)
    }

    #[test]
    fn the_script_has_words_for_all_that_it_does() {
        for (agent, call, words) in [
            (Agent::Off, None, "offline"),
            (Agent::Online { took: ms(9) }, None, "online"),
            (
                Agent::Online { took: ms(9) },
                Some(ms(1)),
                "online, 1.0 ms a call",
            ),
            (
                Agent::Waiting { since: ms(3210) },
                None,
                "waiting for script 3.2 s",
            ),
        ] {
            assert_eq!(matlab(&agent, call), words);
        }
    }

    #[test]
    fn the_memory_of_undo_and_dropped_segments_are_reported() {
        let mut history = History {
            undoable: 12,
            bytes: 3_500_000,
            most_bytes: 512 * 1024 * 1024,
            ..default()
        };
        assert_eq!(undo(&history), "12 segments, 4 of 512 MB");
        history.dropped = 5;
        let reported = "12 segments, 4 of 512 MB; the first 5 are kept no longer";
        assert_eq!(undo(&history), reported);
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
        assert!((mean.fps - 5.0).abs() < 0.6, "{mean:?}");
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
    fn everything_is_shown_in_words() {
        let model = Model {
            mean: Means {
                fps: 59.6,
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
            .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO))
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
