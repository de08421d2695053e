//! A world of the simulator, in the hands of a program.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use bevy::{app::PluginGroupBuilder, prelude::*};
use tabletop_camera::{CameraSpec, Shot, Studio};
use tabletop_core::{
    HandCameras, HeadCamera, ObjectIndex, ObjectSpec, Recording, RestingSystems, RobotCommand,
    RobotMode, SceneCommand, SceneSpec, SimFact, SimTick, Table, WriteCommand as _, step_world,
};
use tabletop_geometry::{Pose, Twist};
use tabletop_history::{KeepRemoved, WorldSnapshot, drop_removed};
use tabletop_recorder::{
    GivenCommands, RecorderPlugin, UnrecordedPlugin, finish_recording, record_into,
};
use tabletop_replay::{Player, Replay};
use tabletop_robot::RobotPlugin;
use tabletop_scenario::{Performer, Program, Scenario};
use tabletop_sim::{
    TabletopSimPlugins, headless_app_with,
    robots::read_robot,
    shipped::{read_faultless_task, read_scenario},
    task_files::save_task,
};

use crate::error::EnvironmentError;

/// The facts that are kept until somebody asks for them.
const MOST_FACTS: usize = 100_000;

/// What is on the table at first.
#[derive(Clone, Debug, PartialEq)]
pub enum WorldOrigin {
    /// Nothing.
    Empty,
    /// The content of a task file.
    Setup(PathBuf),
    /// The table after all steps of a scenario.
    Scenario(PathBuf),
    /// The first tick of a recording.
    Recording(PathBuf),
}

/// The options of a world.
#[derive(Clone, Debug)]
pub struct WorldOptions {
    /// What is on the table at first.
    pub beginning: WorldOrigin,
    /// A `robot.ron` or a URDF; `None` for Baxter, or the robot of the recording.
    pub robot: Option<PathBuf>,
    /// Whether the arms are moved by motors with limited torque.
    pub is_dynamic: bool,
    /// Whether the robot stands at the table from the start.
    pub shows_robot: bool,
    /// The seed of random places and presets.
    pub seed: u64,
    /// Whether it can be recorded, which makes each command a little dearer.
    pub is_recordable: bool,
    /// Folders whose files task files and scenarios may name.
    pub allowed: Vec<PathBuf>,
}

impl Default for WorldOptions {
    fn default() -> Self {
        Self {
            beginning: WorldOrigin::Empty,
            robot: None,
            is_dynamic: false,
            shows_robot: true,
            seed: 0,
            is_recordable: true,
            allowed: Vec::new(),
        }
    }
}

/// A world of the simulator that a program steps and commands. It can be sent to another thread.
///
/// ```
/// use tabletop_environment::{WorldOrigin, TableWorld, WorldOptions};
///
/// let mut world = TableWorld::new(&WorldOptions {
///     beginning: WorldOrigin::Setup("tablesetup/default.xml".into()),
///     ..WorldOptions::default()
/// })?;
/// world.perform(r#"Grasp("RedBlock"), Glide(to: (2, 0, 4), seconds: 1), Glide(to: (-2, 0, 4), seconds: 1)"#)?;
/// world.perform(r#"Glide(to: (-2, 0, 3), seconds: 1), Release"#)?;
/// let before = world.snapshot();
/// world.step(60);
/// world.perform(r#"Expect(OnTopOf(object: "RedBlock", of: "GreenBlock"))"#).unwrap_err(); // It must have been at rest.
/// world.restore(&before)?;
/// world.perform(r#"WaitUntilRest(3), Expect(OnTopOf(object: "RedBlock", of: "GreenBlock"))"#)?;
/// # Ok::<_, tabletop_environment::EnvironmentError>(())
/// ```
pub struct TableWorld {
    world: World,
    performer: Performer,
    /// The cameras of the last pictures.
    studio: Option<(Vec<CameraSpec>, Studio)>,
    options: WorldOptions,
    /// Shared with its moments: while there are any, removed objects are kept for them.
    moments: Arc<()>,
}

/// The state of an object.
#[derive(Clone, Debug, PartialEq)]
pub struct TableObject {
    /// Its description.
    pub spec: ObjectSpec,
    /// Its pose.
    pub pose: Pose,
    /// Its velocity.
    pub twist: Twist,
}

/// A world at a moment, to which it can [return](TableWorld::restore).
pub struct WorldMoment {
    world: WorldSnapshot,
    /// The commands that a later recording begins with.
    given: GivenCommands,
    performer: Performer,
    _of: Arc<()>,
}

/// The facts since somebody has asked for them.
#[derive(Resource, Default)]
struct FactLog(Vec<SimFact>);

fn log_facts(mut facts: MessageReader<SimFact>, mut log: ResMut<FactLog>) {
    if !facts.is_empty() {
        log.0.extend(facts.read().cloned());
        let too_many = log.0.len().saturating_sub(MOST_FACTS);
        log.0.drain(..too_many);
    }
}

impl TableWorld {
    /// A world with these options.
    ///
    /// # Errors
    /// A file cannot be read or has a fault, or a step of the scenario fails.
    pub fn new(options: &WorldOptions) -> Result<Self, EnvironmentError> {
        let robot = robot_plugin(options.robot.as_deref(), options.is_dynamic)?;
        Self::with_robot(options, robot)
    }

    /// [`new`](Self::new) with a robot that other worlds have, too: its looks are in memory once. That of a recording is the recording's own.
    pub(crate) fn with_robot(
        options: &WorldOptions,
        robot: RobotPlugin,
    ) -> Result<Self, EnvironmentError> {
        let replay = match &options.beginning {
            WorldOrigin::Recording(folder) => {
                Some(Replay::read_allowing(folder.clone(), &options.allowed)?)
            }
            WorldOrigin::Empty | WorldOrigin::Setup(_) | WorldOrigin::Scenario(_) => None,
        };
        let mut app = headless_app_with(plugins(options, replay.as_ref(), robot));
        app.init_resource::<FactLog>()
            .add_systems(FixedLast, log_facts.in_set(RestingSystems));
        if let Some(replay) = &replay {
            replay.play_in(&mut app);
        }
        let mut world = Self {
            world: std::mem::take(app.world_mut()),
            performer: Performer::new(options.seed),
            studio: None,
            options: options.clone(),
            moments: Arc::new(()),
        };
        if options.shows_robot && replay.is_none() {
            world.world.write_command(RobotCommand::Show(true));
        }
        match &options.beginning {
            WorldOrigin::Empty if options.shows_robot => world.step(1),
            WorldOrigin::Empty => {}
            WorldOrigin::Setup(file) => {
                let scene = world.read_scene(file)?;
                world.set_scene(scene);
                world.step(1);
            }
            WorldOrigin::Scenario(file) => {
                let mut scenario = read_scenario(file)?;
                scenario.allowed.clone_from(&options.allowed);
                world.perform_scenario(&scenario)?;
            }
            WorldOrigin::Recording(_) => world.go_to_start(),
        }
        Ok(world)
    }

    /// Replays the commands before a recording.
    fn go_to_start(&mut self) {
        let start = self.world.resource::<Player>().start();
        while *self.world.resource::<SimTick>() < start {
            self.step(1);
        }
        self.world.remove_resource::<Player>();
    }

    /// The scene of a task file without faults.
    ///
    /// # Errors
    /// It cannot be read, or has faults.
    pub fn read_scene(&self, file: &Path) -> Result<SceneSpec, EnvironmentError> {
        read_faultless_task(file, &self.options.allowed).map_err(EnvironmentError::Task)
    }

    /// Puts a scene on the table in the next tick.
    pub fn set_scene(&mut self, scene: SceneSpec) {
        let scene = SceneCommand::Set(Box::new(scene));
        self.world.write_command(scene);
    }

    /// Simulates this many ticks of 1/60 s.
    pub fn step(&mut self, ticks: u64) {
        step_world(&mut self.world, ticks);
    }

    /// Performs steps as they stand in a scenario, with commas between them (`docs/scenarios.md`), in the ticks that they take there.
    ///
    /// # Errors
    /// The steps cannot be read, or one of them failed; those before it were done.
    pub fn perform(&mut self, steps: &str) -> Result<(), EnvironmentError> {
        let mut scenario = Scenario::parse("steps", &format!("(steps: [{steps}])"))?;
        scenario.allowed.clone_from(&self.options.allowed);
        self.perform_scenario(&scenario)
    }

    fn perform_scenario(&mut self, scenario: &Scenario) -> Result<(), EnvironmentError> {
        self.drop_removed();
        let allowed = &self.options.allowed;
        let program = Program::new(
            scenario,
            |file| read_faultless_task(file, allowed),
            self.options.seed,
        )?;
        Ok(self.performer.perform(&mut self.world, program)?)
    }

    /// The tick that comes next.
    pub fn tick(&self) -> u64 {
        self.world.resource::<SimTick>().0
    }

    /// The objects on the table, in the order in which they came.
    pub fn objects(&self) -> Vec<TableObject> {
        let index = self.world.resource::<ObjectIndex>();
        let objects = index.iter().filter_map(|entity| {
            let object = self.world.get_entity(entity).ok()?;
            Some(TableObject {
                spec: object.get::<ObjectSpec>()?.clone(),
                pose: Pose::from(object.get::<Transform>()?),
                twist: object.get::<Twist>().copied().unwrap_or_default(),
            })
        });
        objects.collect()
    }

    /// The table, or the usual one if there is none.
    pub fn table(&mut self) -> Table {
        let world = self.world_mut();
        let mut tables = world.query::<&Table>();
        tables.iter(world).next().copied().unwrap_or_default()
    }

    /// The facts since the last call; only the latest 100,000.
    pub fn take_facts(&mut self) -> Vec<SimFact> {
        std::mem::take(&mut self.world.resource_mut::<FactLog>().0)
    }

    /// The present world before these cameras.
    ///
    /// # Errors
    /// The robot has no such camera.
    pub fn shoot(&mut self, cameras: &[CameraSpec]) -> Result<&[Shot], EnvironmentError> {
        let kept = self.studio.take().filter(|(kept, _)| kept == cameras);
        let studio = match kept {
            Some((_, studio)) => studio,
            None => {
                let known = &self.world.resource::<HandCameras>().0;
                Studio::new(cameras.to_vec(), known)?.alone()
            }
        };
        let (_, studio) = self.studio.insert((cameras.to_vec(), studio));
        Ok(studio.shoot(&mut self.world)?)
    }

    /// Smooths the edges in pictures, or not.
    pub fn set_smooth(&mut self, is_smooth: bool) {
        self.world.resource_mut::<HeadCamera>().antialiasing = is_smooth;
    }

    /// Removes objects for good that were kept for moments which nobody has any more.
    pub(crate) fn drop_removed(&mut self) {
        if Arc::strong_count(&self.moments) == 1 {
            self.world.resource_mut::<KeepRemoved>().for_playback = false;
            drop_removed(&mut self.world);
        }
    }

    /// The present moment, but for files.
    pub fn snapshot(&mut self) -> WorldMoment {
        self.world.resource_mut::<KeepRemoved>().for_playback = true;
        WorldMoment {
            world: WorldSnapshot::take(&mut self.world),
            performer: self.performer.clone(),
            given: GivenCommands::of(&self.world),
            _of: Arc::clone(&self.moments),
        }
    }

    /// Returns to a moment, bit for bit. It must be one of this world.
    ///
    /// # Errors
    /// A recording runs: it cannot go back.
    pub fn restore(&mut self, moment: &WorldMoment) -> Result<(), EnvironmentError> {
        if self.world.resource::<Recording>().0 {
            return Err(EnvironmentError::Recording(
                "a recording runs, and cannot go back; finish it first".into(),
            ));
        }
        moment.world.restore(&mut self.world);
        moment.given.restore(&mut self.world);
        self.performer = moment.performer.clone();
        self.world.resource_mut::<FactLog>().0.clear();
        Ok(())
    }

    /// Saves the table as a task file, replacing an existing one. Returns the parts of it that a task file cannot express.
    ///
    /// # Errors
    /// The file cannot be written; an existing one is unchanged.
    pub fn save(&self, file: &Path) -> Result<Vec<String>, EnvironmentError> {
        save_task(&self.world, file).map_err(|error| {
            EnvironmentError::Task(format!("{}: it cannot be saved: {error}", file.display()))
        })
    }

    /// Chooses the folder of the next recording.
    ///
    /// # Errors
    /// A recording runs, or the world cannot be recorded.
    pub fn record_into(&mut self, folder: &Path) -> Result<(), EnvironmentError> {
        record_into(&mut self.world, folder).map_err(EnvironmentError::Recording)
    }

    /// Ends the recording that it is making, if it is making one. Returns the number of recordings so far.
    ///
    /// # Errors
    /// A recording has failed, now or before: the fault, and the remedy.
    pub fn finish_recording(&mut self) -> Result<usize, EnvironmentError> {
        let report = finish_recording(&mut self.world).map_err(EnvironmentError::Recording)?;
        Ok(report.started)
    }

    /// The world itself.
    pub const fn world(&self) -> &World {
        &self.world
    }

    /// The world itself, to change it.
    pub const fn world_mut(&mut self) -> &mut World {
        &mut self.world
    }
}

/// The robot of these options.
pub(crate) fn robot_plugin(
    robot: Option<&Path>,
    is_dynamic: bool,
) -> Result<RobotPlugin, EnvironmentError> {
    let mode = match is_dynamic {
        true => RobotMode::Dynamic,
        false => RobotMode::Kinematic,
    };
    Ok(RobotPlugin {
        mode,
        description: robot.map(read_robot).transpose()?,
    })
}

fn plugins(
    options: &WorldOptions,
    replay: Option<&Replay>,
    robot: RobotPlugin,
) -> PluginGroupBuilder {
    let plugins = match replay {
        Some(replay) => replay.plugins(),
        None => TabletopSimPlugins.build().set(robot),
    };
    match options.is_recordable {
        true => plugins,
        false => plugins.disable::<RecorderPlugin>().add(UnrecordedPlugin),
    }
}
