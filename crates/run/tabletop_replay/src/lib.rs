//! Recordings, simulated again: replays, their verification, and any moment of a recording.

mod difference;
mod edit;
mod error;
mod playback;
mod player;
mod shown;
mod verify;

pub use difference::first_difference;
pub use edit::{EditError, SegmentEdit};
pub use error::ReplayError;
pub use playback::PlaybackPlugin;
pub use player::Player;

use std::path::{Path, PathBuf};

use bevy::{app::PluginGroupBuilder, prelude::*};
use serde::Deserialize as _;
use tabletop_core::{
    Actor, HandCamera, HeadCamera, Reach, RecordingCommand, RobotCommand, SimCommand, SimTick,
    StepApp as _, TICKS_PER_SECOND,
};
use tabletop_physics::{PhysicsPlugin, PhysicsSettings};
use tabletop_recorder::{
    HandPictures, RecorderPlugin, RecordingReader, RecordingReport, Session, SessionCommand,
    TICKS_PER_FRAME, UnrecordedPlugin, recording_report,
};
use tabletop_robot::{Description, DescriptionError, RobotPlugin};
use tabletop_sim::{
    TabletopSimPlugins, headless_app_with,
    settings::{PHYSICS, ROBOT, RobotSettings, Settings},
};

/// A recording that can be replayed through the same states, to the bit.
#[derive(Clone, Debug)]
pub struct Replay {
    recording: RecordingReader,
    /// Its session, with an end added if it was cut off.
    session: Session,
    begin: SimTick,
    settings: Settings,
    robot: RobotPlugin,
}

impl Replay {
    /// Reads the parts of a recording that a replay needs.
    ///
    /// # Errors
    ///
    /// The session log cannot be read, does not go back far enough, or has settings that this program does not have; or its robot has
    /// meshes outside of the folder.
    pub fn read(folder: impl Into<PathBuf>) -> Result<Self, ReplayError> {
        Self::read_allowing(folder, &[])
    }

    /// [`read`](Self::read) for a recording whose robot may have its meshes in these folders, too.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn read_allowing(
        folder: impl Into<PathBuf>,
        allowed: &[PathBuf],
    ) -> Result<Self, ReplayError> {
        let folder = folder.into();
        let path = folder.join("session.jsonl");
        let recording = RecordingReader::open(&folder)?;
        let header = recording.header();
        if let Some(from) = header.imported_from() {
            let from = from.to_owned();
            return Err(ReplayError::Imported { folder, from });
        }
        let fault = |name, problem| ReplayError::Settings {
            path: path.clone(),
            name,
            problem,
            program: header.program.clone(),
        };
        for (name, recorded, here) in [
            (
                "ticks_per_second",
                u64::from(header.ticks_per_second),
                u64::from(TICKS_PER_SECOND),
            ),
            ("ticks_per_frame", header.ticks_per_frame, TICKS_PER_FRAME),
        ] {
            if recorded != here {
                return Err(fault(name, format!("expected {here}, found {recorded}")));
            }
        }
        let physics = match header.settings.get(PHYSICS) {
            Some(physics) => PhysicsSettings::deserialize(physics)
                .map_err(|error| fault("settings.physics", error.to_string()))?,
            None => PhysicsSettings::default(),
        };
        if let Some(problem) = physics.fault() {
            return Err(fault("settings.physics", problem));
        }
        let robot_settings = match header.settings.get(ROBOT) {
            Some(robot) => RobotSettings::deserialize(robot)
                .map_err(|error| fault("settings.robot", error.to_string()))?,
            None => RobotSettings::default(),
        };
        let robot = robot_settings
            .clone()
            .plugin(Reach::of([&folder].into_iter().chain(allowed)));
        let robot = robot.map_err(|error| fault("settings.robot", error.to_string()))?;
        let missing = on_no_link(&header.hand_cameras, &robot)
            .map_err(|error| fault("settings.robot", error.to_string()))?;
        if let Some(HandCamera { name, link, .. }) = missing {
            let problem = format!("{name}: the robot has no link {link}");
            return Err(fault("hand_cameras", problem));
        }
        let Some(begin) = header.begin_tick.map(SimTick) else {
            return Err(ReplayError::NoBeginning { path });
        };
        let mut session = recording.session().clone();
        let cut_off_at = recording.cut_off_at();
        session
            .commands
            .extend(cut_off_at.map(|tick| SessionCommand {
                tick: tick.0,
                actor: Actor::Replay,
                command: SimCommand::Recording(RecordingCommand::Finish),
                at_once: false,
            }));
        Ok(Self {
            recording,
            session,
            begin,
            settings: Settings {
                physics,
                robot: robot_settings,
            },
            robot,
        })
    }

    /// The recording's folder.
    pub fn folder(&self) -> &Path {
        self.recording.folder()
    }

    /// The reader of the recording.
    pub fn recording(&self) -> &RecordingReader {
        &self.recording
    }

    /// The tick in which the recording was cut off, if it was: the program was killed, or its disk was full. The replay goes up to
    /// there.
    pub fn cut_off_at(&self) -> Option<SimTick> {
        self.recording.cut_off_at()
    }

    /// The first file in which the recording of a replay differs from this one, and the difference. Parts that were cut off are not
    /// compared, nor are pictures of a real robot's camera, which a replay draws.
    ///
    /// # Errors
    /// A folder or file cannot be read.
    pub fn first_difference(&self, replayed: &Path) -> Result<Option<String>, ReplayError> {
        match self.cut_off_at() {
            None => difference::first_of(self.folder(), replayed, !self.is_of_a_real_robot()),
            Some(_) => {
                difference::first_before_cut(self.folder(), replayed, !self.is_of_a_real_robot())
            }
        }
    }

    /// True if it shows a real robot, which the simulated one mirrored.
    fn is_of_a_real_robot(&self) -> bool {
        let mut commands = self.session.commands.iter();
        commands.any(|it| matches!(it.command, SimCommand::Robot(RobotCommand::Mirror(_))))
    }

    /// Its session: with an end added, if it was cut off.
    pub const fn session(&self) -> &Session {
        &self.session
    }

    /// The same with other commands, or with another beginning and end.
    #[must_use]
    pub fn with_session(&self, session: Session) -> Self {
        Self {
            begin: session.header.begin_tick.map_or(self.begin, SimTick),
            session,
            ..self.clone()
        }
    }

    /// Version of the program that made the recording.
    pub fn program(&self) -> &str {
        &self.session.header.program
    }

    /// The head camera with which it was recorded.
    pub fn camera(&self) -> HeadCamera {
        self.session.header.camera.unwrap_or_default()
    }

    /// The hand cameras whose pictures were recorded.
    pub fn hand_cameras(&self) -> &[HandCamera] {
        &self.session.header.hand_cameras
    }

    /// The robot that was recorded.
    pub fn robot(&self) -> &RobotPlugin {
        &self.robot
    }

    /// The simulator with the settings with which it was recorded.
    pub fn plugins(&self) -> PluginGroupBuilder {
        TabletopSimPlugins
            .build()
            .set(PhysicsPlugin {
                settings: self.settings.physics,
            })
            .set(self.robot.clone())
    }

    /// Lets an app that has these [plugins](Self::plugins) replay it from its beginning.
    pub fn play_in(&self, app: &mut App) {
        self.play(Player::new(&self.session), app);
    }

    fn play(&self, player: Player, app: &mut App) {
        app.insert_resource(self.begin)
            .insert_resource(self.camera());
        player.play_in(app);
    }

    /// Replays it without a window and records that, with its own settings in the header and pictures from this camera; and with those of the
    /// same hand cameras, unless the recorder has others.
    ///
    /// # Errors
    /// [`ReplayError::Record`], as with a full disk.
    pub fn record(
        &self,
        recorder: RecorderPlugin,
        camera: HeadCamera,
    ) -> Result<RecordingReport, ReplayError> {
        self.record_while(recorder, camera, |_| true)
    }

    /// [`record`](Self::record) as long as this says so of the number of ticks replayed.
    ///
    /// # Errors
    /// As [`record`](Self::record).
    pub fn record_while(
        &self,
        recorder: RecorderPlugin,
        camera: HeadCamera,
        goes_on: impl FnMut(u64) -> bool,
    ) -> Result<RecordingReport, ReplayError> {
        let recorder = RecorderPlugin {
            header: self.session.header.settings.clone(),
            hand_pictures: match recorder.hand_pictures {
                HandPictures::None => HandPictures::Of(self.hand_cameras().to_vec()),
                others @ (HandPictures::OfAll | HandPictures::Of(_)) => others,
            },
            ..recorder
        };
        let mut app = headless_app_with(self.plugins().set(recorder));
        self.play(Player::recording(&self.session), &mut app);
        app.insert_resource(camera);
        self.run_while(&mut app, goes_on)
    }

    /// Replays it without a window and without recording that, as long as this says so of the number of ticks replayed.
    pub fn simulate_while(&self, goes_on: impl FnMut(u64) -> bool) {
        let plugins = self.plugins().disable::<RecorderPlugin>();
        let mut app = headless_app_with(plugins.add(UnrecordedPlugin));
        self.play_in(&mut app);
        // Nothing is recorded that could fail.
        let _report = self.run_while(&mut app, goes_on);
    }

    /// Number of ticks of a replay: from the first command on which the recording depends to its end.
    pub fn ticks(&self) -> u64 {
        self.recording.last_tick().0.saturating_sub(self.begin.0)
    }

    fn run_while(
        &self,
        app: &mut App,
        mut goes_on: impl FnMut(u64) -> bool,
    ) -> Result<RecordingReport, ReplayError> {
        loop {
            let world = app.world();
            let report = recording_report(world);
            if let Some(reason) = report.and_then(|report| report.failure.as_ref()) {
                return Err(ReplayError::Record(reason.clone()));
            }
            let replayed = world.resource::<SimTick>().0.saturating_sub(self.begin.0);
            if world.resource::<Player>().is_over() || !goes_on(replayed) {
                return Ok(report.cloned().unwrap_or_default());
            }
            app.step(1);
        }
    }
}

/// The first of these cameras that is on no link of a robot.
fn on_no_link<'c>(
    cameras: &'c [HandCamera],
    robot: &RobotPlugin,
) -> Result<Option<&'c HandCamera>, DescriptionError> {
    if cameras.is_empty() {
        return Ok(None);
    }
    let description = match robot.description.clone() {
        Some(description) => description,
        None => Description::baxter()?,
    };
    Ok(cameras
        .iter()
        .find(|camera| description.model.find_link(&camera.link).is_err()))
}
