//! The program in a window.

mod background;
mod curves;
mod debug;
mod display;
mod editing;
mod files;
mod frame_rate;
#[cfg(feature = "gamepad")]
mod gamepads;
mod idle;
mod no_window;
mod opening;
mod picture_times;
mod real_robot;
mod redraw;
mod replay;
mod screenshot;
mod shelf;
mod takes;
mod task;
#[cfg(test)]
mod test_folder;

pub use display::DisplayOptions;
pub use no_window::NoWindow;
pub use real_robot::Connected;
pub use screenshot::ScreenshotAt;
pub use tabletop_gui::display::{Antialiasing, Resolution};

use std::{path::PathBuf, time::Duration};

use bevy::{
    app::{PanicHandlerPlugin, PluginGroupBuilder, TerminalCtrlCHandlerPlugin},
    log::{Level, LogPlugin},
    prelude::*,
    render::RenderPlugin,
};
use tabletop_core::{Actor, CommandWriter, OpenRecording, RobotCommand, SceneCommand};
use tabletop_gui::{GuiPlugin, Preferences, WidgetListPlugin, keymap_file::KeymapFile};
use tabletop_user::{CameraView, FirstView, PacePlugin, PresetSeeds};

use self::opening::{Beginning, Opening};
use tabletop_history::HistoryPlugin;
use tabletop_recorder::{HandPictures, RecorderPlugin};
use tabletop_replay::{PlaybackPlugin, Replay};
use tabletop_robot::RobotPlugin;
use tabletop_script::{ScriptPlugin, ScriptSettings, Waiting};
use tabletop_sim::TabletopSimPlugins;
use tabletop_view::ViewPlugin;
use tabletop_xml::AllowedFolders;

/// The window on a simulation, beside Bevy's `DefaultPlugins`: [`ViewPlugin`] shows the world, [`GuiPlugin`] has keys, mouse and panels, and
/// [`PacePlugin`] lets users choose the pace of time.
#[derive(Clone, Copy, Debug, Default)]
pub struct TabletopWindowPlugins;

impl PluginGroup for TabletopWindowPlugins {
    fn build(self) -> PluginGroupBuilder {
        PluginGroupBuilder::start::<Self>()
            .add(ViewPlugin)
            .add(GuiPlugin)
            .add(PacePlugin)
    }
}

/// The options of a window.
#[derive(Clone, Debug)]
pub struct WindowOptions {
    /// The content of the table.
    pub show: Show,
    /// Folders whose files, at any depth, may be named by others, besides those around them.
    pub allowed: Vec<PathBuf>,
    /// The robot at the table; a replay has that of its recording.
    pub robot: RobotPlugin,
    /// The hand cameras whose pictures are recorded, too; a replay has those of its recording.
    pub hand_pictures: HandPictures,
    /// True if the robot stands at the table from the start.
    pub show_robot: bool,
    /// The scripts that can drive the robot, and their engine.
    pub scripts: ScriptSettings,
    /// The display settings.
    pub display: DisplayOptions,
    /// The file that binds keys; else it is the user's own, if there is one.
    pub keys: Option<PathBuf>,
    /// Seed of the colours and places of presets.
    pub seed: u64,
    /// A picture to take, after which the program ends.
    pub screenshot: Option<ScreenshotAt>,
    /// A file that lists the widgets on the screen, for programs that click.
    pub widgets: Option<PathBuf>,
    /// True if every command and every fact is written to the console.
    pub is_verbose: bool,
}

/// The content of a window's table.
#[derive(Clone, Debug)]
pub enum Show {
    /// A task file, for the user to act on.
    Task(PathBuf),
    /// A recording. After its end, the user can continue from there.
    Replay(Box<Replay>),
}

impl Show {
    /// The task to load when a recording is closed.
    fn task(&self) -> PathBuf {
        match self {
            Self::Task(task) => task.clone(),
            Self::Replay(_) => DEFAULT_TASK.into(),
        }
    }
}

/// The task of a window that has shown none yet.
const DEFAULT_TASK: &str = "tablesetup/default.xml";

/// The seed of a window for which none is named.
pub const DEFAULT_SEED: u64 = PresetSeeds::DEFAULT;

/// Time for which a frame waits for a script.
const LONGEST_WAIT: Duration = Duration::from_millis(50);

/// Runs the simulation in a window until the user or a screenshot ends it.
///
/// # Errors
///
/// There is no display, or no graphics driver, or a library is missing. Then nothing has been started, and no logger
/// has been set up: the simulation can be run without a window instead.
pub fn run(options: WindowOptions) -> Result<AppExit, NoWindow> {
    run_beside(options, None)
}

/// The same beside a real robot, if there is one.
///
/// # Errors
///
/// As [`run`].
pub fn run_beside(options: WindowOptions, real: Option<Connected>) -> Result<AppExit, NoWindow> {
    let is_verbose = options.is_verbose;
    let mut app = no_window::catch(|| build(options))?;
    if let Some(real) = real {
        real.stand_in(&mut app);
    }
    app.add_plugins((
        PanicHandlerPlugin,
        log(is_verbose),
        TerminalCtrlCHandlerPlugin,
    ));
    Ok(app.run())
}

/// The app without its process-wide parts, so that giving up leaves no trace.
fn build(options: WindowOptions) -> App {
    let mut app = App::new();
    let preferences = Preferences::default();
    let beginning = Beginning::new(options.display, &preferences);
    app.add_plugins((
        DefaultPlugins
            .set(WindowPlugin {
                primary_window: Some(beginning.window()),
                ..default()
            })
            // The first frames wait for their shaders instead of being black.
            .set(RenderPlugin {
                synchronous_pipeline_compilation: true,
                ..default()
            })
            .disable::<PanicHandlerPlugin>()
            .disable::<LogPlugin>()
            .disable::<TerminalCtrlCHandlerPlugin>(),
        match &options.show {
            Show::Task(_) => TabletopSimPlugins
                .build()
                .set(options.robot)
                .set(HistoryPlugin {
                    keeps_always: true,
                    ..default()
                }),
            Show::Replay(replay) => replay.plugins(),
        }
        .set(RecorderPlugin {
            hand_pictures: match &options.show {
                Show::Task(_) => options.hand_pictures,
                Show::Replay(replay) => HandPictures::Of(replay.hand_cameras().to_vec()),
            },
            ..default()
        })
        .set(ScriptPlugin {
            settings: ScriptSettings {
                waiting: Waiting::Frame(LONGEST_WAIT),
                ..options.scripts
            },
        }),
        TabletopWindowPlugins,
        PlaybackPlugin {
            task: options.show.task(),
        },
        display::plugin,
        editing::plugin,
        files::plugin,
        frame_rate::plugin,
        idle::plugin,
        opening::plugin,
        picture_times::plugin,
        real_robot::plugin,
        redraw::plugin,
        replay::plugin,
        task::plugin,
    ))
    .add_plugins((curves::plugin, shelf::plugin, takes::plugin))
    .insert_resource(preferences)
    .insert_resource(AllowedFolders(options.allowed))
    .insert_resource(PresetSeeds::new(options.seed))
    .insert_resource(Opening::Begun(beginning));
    #[cfg(feature = "gamepad")]
    app.add_plugins(gamepads::plugin);
    match options.show {
        Show::Task(setup) => {
            let load = move |mut commands: CommandWriter| {
                commands.write(Actor::Panel, SceneCommand::Load(setup.clone()));
                if options.show_robot {
                    commands.write(Actor::Panel, RobotCommand::Show(true));
                }
            };
            app.add_systems(Startup, load);
            if options.show_robot {
                // From behind its head nothing is seen of the table.
                app.insert_resource(FirstView(CameraView::Across));
            }
        }
        Show::Replay(replay) => {
            let open = OpenRecording(replay.folder().to_owned());
            app.world_mut().write_message(open);
        }
    }
    if let Some(keys) = options.keys {
        app.insert_resource(KeymapFile(keys));
    }
    if options.is_verbose {
        app.add_plugins(debug::plugin);
    }
    if let Some(file) = options.widgets {
        app.add_plugins(WidgetListPlugin { file });
    }
    if let Some(screenshot) = options.screenshot {
        screenshot.plan(&mut app);
    }
    app
}

fn log(is_verbose: bool) -> LogPlugin {
    let filter = match is_verbose {
        true => "tabletop=debug",
        false => "tabletop=info",
    };
    LogPlugin {
        level: Level::WARN,
        filter: filter.into(),
        ..default()
    }
}
