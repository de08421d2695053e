//! Opening of the window: first with the display settings alone, if the user is asked, and then with the simulation. While he is asked, the
//! simulation has not begun: only those of Bevy's schedules run that windows and panels need.

use bevy::{
    app::Main,
    ecs::{
        message::signal_message_update_system,
        schedule::{ScheduleLabel, SingleThreadedExecutor},
    },
    prelude::*,
    window::{MonitorSelection, PrimaryWindow, WindowCloseRequested},
};
use tabletop_gui::{
    Preferences,
    display::{
        CONCERN, DisplayDialog, DisplayOffer, DisplayRequest, DisplaySettings, Resolution, TITLE,
    },
};
use tabletop_user::{Notices, Tone};

use super::display::{self, DisplayOptions};

/// The stage of opening the window.
#[derive(Resource, Clone, Debug, PartialEq, Eq)]
pub(super) enum Opening {
    /// Nothing is in it.
    Begun(Beginning),
    /// It shows the display settings.
    Asking,
    /// It shows the simulation.
    Done,
}

/// The settings that are known before there is a window.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Beginning {
    options: DisplayOptions,
    /// The settings of the last run.
    remembered: Option<DisplaySettings>,
    /// The reason why they cannot be read.
    fault: Option<String>,
}

impl Beginning {
    /// Uses the command line, and the choice of the last run.
    pub fn new(options: DisplayOptions, preferences: &Preferences) -> Self {
        let (remembered, fault) = match preferences.read(CONCERN) {
            Ok(remembered) => (remembered, None),
            Err(error) => (None, Some(error.to_string())),
        };
        Self {
            options,
            remembered,
            fault,
        }
    }

    fn asks(&self) -> bool {
        self.options.asks(self.remembered)
    }

    /// The window that the user sees first.
    pub fn window(&self) -> Window {
        if self.asks() {
            return Window {
                title: TITLE.into(),
                resolution: DisplayDialog::SIZE.into(),
                position: WindowPosition::Centered(MonitorSelection::Primary),
                ..default()
            };
        }
        let Resolution { width, height } = self.chosen(DisplaySettings::default()).resolution;
        Window {
            title: WINDOW_TITLE.into(),
            resolution: (width, height).into(),
            ..default()
        }
    }

    /// The settings of the command line, then those of the last run, then these.
    fn chosen(&self, recommended: DisplaySettings) -> DisplaySettings {
        self.options.over(self.remembered.unwrap_or(recommended))
    }
}

/// The title of the main window.
const WINDOW_TITLE: &str = "tabletop";

/// The schedule of a frame.
#[derive(ScheduleLabel, Clone, Debug, PartialEq, Eq, Hash)]
struct WindowFrame;

/// Lets the app's window open. Replaces the schedule that Bevy runs in each frame.
pub(super) fn plugin(app: &mut App) {
    let mut frame = Schedule::new(WindowFrame);
    frame.set_executor(SingleThreadedExecutor::new());
    frame.add_systems(show_frame);
    app.add_schedule(frame).main_mut().update_schedule = Some(WindowFrame.intern());
}

fn show_frame(world: &mut World) -> Result {
    match world.resource::<Opening>().clone() {
        Opening::Begun(beginning) => begin(world, &beginning)?,
        Opening::Asking => ask(world)?,
        Opening::Done => (),
    }
    match world.resource::<Opening>() {
        Opening::Begun(_) | Opening::Asking => show_settings(world)?,
        Opening::Done => world.run_schedule(Main),
    }
    Ok(())
}

/// Runs the schedules that the settings need.
fn show_settings(world: &mut World) -> Result {
    // Otherwise messages would be kept for the first tick, and keys typed here would be read there.
    world.run_system_cached(signal_message_update_system)?;
    world.run_schedule(First);
    world.run_schedule(PreUpdate);
    world.run_schedule(PostUpdate);
    world.run_schedule(Last);
    Ok(())
}

fn begin(world: &mut World, beginning: &Beginning) -> Result {
    let renderer = world.run_system_cached(display::renderer)?;
    world.insert_resource(renderer);
    let offer = world.run_system_cached(display::offer)?;
    let chosen = beginning.chosen(offer.default_settings());
    world.insert_resource(offer);
    world.insert_resource(chosen);
    if let Some(fault) = &beginning.fault {
        world.resource_mut::<Notices>().add(Tone::Warning, fault);
    }
    if beginning.asks() {
        world.spawn(DisplayDialog);
        world.insert_resource(Opening::Asking);
    } else {
        open(world);
    }
    Ok(())
}

/// Carries out the user's decision, if there is one.
fn ask(world: &mut World) -> Result {
    let is_closed = !world
        .resource::<Messages<WindowCloseRequested>>()
        .is_empty();
    let mut requests = world.resource_mut::<Messages<DisplayRequest>>();
    match requests.drain().last() {
        Some(DisplayRequest::Continue) => {
            let settings = *world.resource::<DisplaySettings>();
            let kept = world.resource::<Preferences>().keep(CONCERN, &settings);
            if let Err(error) = kept {
                let text = error.to_string();
                world.resource_mut::<Notices>().add(Tone::Warning, &text);
            }
            let mut dialogs = world.query_filtered::<Entity, With<DisplayDialog>>();
            let dialog = dialogs.single(world)?;
            world.despawn(dialog);
            let mut windows = world.query_filtered::<&mut Window, With<PrimaryWindow>>();
            let mut window = windows.single_mut(world)?;
            window.title = WINDOW_TITLE.into();
            open(world);
            let opened = world.resource::<DisplaySettings>().resolution;
            let corner = world.run_system_cached_with(display::centered, opened)?;
            if let Some(corner) = corner {
                windows.single_mut(world)?.position = WindowPosition::At(corner);
            }
        }
        Some(DisplayRequest::Cancel) => {
            world.write_message(AppExit::Success);
        }
        None if is_closed => {
            world.write_message(AppExit::Success);
        }
        None => (),
    }
    Ok(())
}

/// Begins the simulation, with the nearest to the settings that the display can do.
fn open(world: &mut World) {
    let settings = *world.resource::<DisplaySettings>();
    let (nearest, changes) = world.resource::<DisplayOffer>().nearest(settings);
    world.insert_resource(nearest);
    let mut notices = world.resource_mut::<Notices>();
    for change in changes {
        notices.add(Tone::Warning, &change);
    }
    world.insert_resource(Opening::Done);
}

#[cfg(test)]
mod tests {
    use std::num::NonZeroU32;

    use tabletop_gui::display::{Antialiasing, ScreenMode};

    use super::*;

    #[derive(Resource, Default, Debug, PartialEq)]
    struct Ran {
        startups: u32,
        updates: u32,
        posts: u32,
    }

    /// An app that is asking, as after its first frame.
    fn app(preferences: Preferences) -> App {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, plugin))
            .init_resource::<Ran>()
            .init_resource::<Notices>()
            .insert_resource(preferences)
            .add_message::<DisplayRequest>()
            .add_message::<WindowCloseRequested>()
            .add_systems(Startup, |mut ran: ResMut<Ran>| ran.startups += 1)
            .add_systems(Update, |mut ran: ResMut<Ran>| ran.updates += 1)
            .add_systems(PostUpdate, |mut ran: ResMut<Ran>| ran.posts += 1)
            .insert_resource(Opening::Asking)
            .insert_resource(DisplayOffer {
                desktop: Resolution::new(800, 600),
                screen: ScreenMode {
                    resolution: Resolution::new(800, 600),
                    refresh_rate: NonZeroU32::MIN,
                    color_depth: 24,
                },
                modes: Vec::new(),
                antialiasing: Antialiasing::ALL.to_vec(),
                is_software: false,
            })
            .init_resource::<DisplaySettings>();
        app.world_mut().spawn((Window::default(), PrimaryWindow));
        app.world_mut().spawn(DisplayDialog);
        app.update();
        app
    }

    fn ran(app: &App) -> [u32; 3] {
        let ran = app.world().resource::<Ran>();
        [ran.startups, ran.updates, ran.posts]
    }

    #[test]
    fn nothing_has_begun_while_the_user_is_asked() {
        let mut app = app(Preferences::nowhere());
        app.update();
        assert_eq!(ran(&app), [0, 0, 2]);
    }

    #[test]
    fn the_simulation_begins_when_the_user_continues() {
        let folder = std::env::temp_dir().join(format!("tabletop-opening-{}", std::process::id()));
        let preferences = Preferences::in_folder(&folder);
        let mut app = app(preferences.clone());
        app.world_mut().write_message(DisplayRequest::Continue);
        app.update();
        assert_eq!(ran(&app), [1, 1, 2]);
        let world = app.world_mut();
        assert_eq!(world.query::<&DisplayDialog>().iter(world).count(), 0);
        let settings = world.resource::<DisplaySettings>();
        assert_eq!(settings.resolution, Resolution::new(800, 600));
        let kept: Option<DisplaySettings> = preferences.read(CONCERN).unwrap();
        assert_eq!(kept, Some(DisplaySettings::default()), "what was chosen");
        std::fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn cancel_and_the_cross_of_the_window_quit() {
        let mut cancelled = app(Preferences::nowhere());
        cancelled.world_mut().write_message(DisplayRequest::Cancel);
        cancelled.update();
        assert_eq!(cancelled.should_exit(), Some(AppExit::Success));
        let mut closed = app(Preferences::nowhere());
        let window = Entity::PLACEHOLDER;
        closed
            .world_mut()
            .write_message(WindowCloseRequested { window });
        closed.update();
        assert_eq!(closed.should_exit(), Some(AppExit::Success));
        assert_eq!(ran(&closed)[1], 0);
    }

    #[test]
    fn the_first_window_is_that_of_the_settings_or_has_the_chosen_size() {
        let nowhere = Preferences::nowhere();
        let first = |options| Beginning::new(options, &nowhere).window();
        let asking = first(DisplayOptions::default());
        assert_eq!(asking.title, TITLE);
        let sized = first(DisplayOptions {
            resolution: Some(Resolution::new(640, 480)),
            ..default()
        });
        assert_eq!(sized.title, WINDOW_TITLE);
        assert_eq!(sized.physical_size(), UVec2::new(640, 480));
    }

    #[test]
    fn a_damaged_memory_is_reported_and_the_user_asked() {
        let folder = std::env::temp_dir().join(format!("tabletop-damaged-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join("display.ron"), "(resolution: big)").unwrap();
        let preferences = Preferences::in_folder(&folder);
        let beginning = Beginning::new(DisplayOptions::default(), &preferences);
        assert!(beginning.fault.unwrap().contains("display.ron"));
        assert_eq!(beginning.remembered, None);
        std::fs::remove_dir_all(folder).unwrap();
    }
}
