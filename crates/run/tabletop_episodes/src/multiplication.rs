//! Multiplication of demonstrations: the same task with everything elsewhere, demonstrated again by the hand or by the robot (MimicGen's idea:
//! Mandlekar et al., MimicGen: A Data Generation System for Scalable Robot Learning using Human Demonstrations, 2023).
//!
//! The seed and the number of a demonstration alone decide it, so it does not matter which others were made, or where.

mod camera_displacement;
mod fingerprint;
mod lasting;
mod late;
mod object_variation;
mod operated;
mod performance;
mod variation;
mod varied_beginning;
mod way;

pub use camera_displacement::CameraDisplacement;
pub use fingerprint::Fingerprint;
pub use object_variation::{distractor, narrow, recolor, with_colors_exchanged};
pub use variation::Variation;
pub use varied_beginning::VariedBeginning;

use std::{fmt, io, path::Path};

use bevy::prelude::*;
use serde_json::{Value, json};
use tabletop_camera::Camera;
use tabletop_controller::Sight;
use tabletop_core::{
    CameraCarrier, HeadCamera, Random, RecordingCommand, RobotCommand, SceneCommand, SceneSpec,
    StepApp as _, Table, WriteCommand as _,
};
use tabletop_kinematics::ModelError;
use tabletop_planner::{Before, PlanFailure, RobotBody, imitate};
use tabletop_recorder::{
    HandPictures, RecorderError, RecorderPlugin, RecordingReader, SessionHeader, finish_recording,
};
use tabletop_robot::{DescriptionSource, RobotPlugin};
use tabletop_scene::{IdAllocator, assemble};
use tabletop_storage::{Storage, Symlinks, read_regular_file};
use tabletop_task::{Binding, Demonstration, Furniture, RequirementError, Requirements, Task};

use tabletop_sim::{TabletopSimPlugins, headless_app_with};

use crate::{beginning::scene_at_beginning, imitation::AppStage, robot_body::robot_body};
use lasting::lasts;
use late::LateObjects;
use operated::Operated;
use performance::perform;
use variation::Varying;

/// A demonstration, ready to be multiplied.
#[derive(Debug)]
pub struct Multiplication {
    shown: Demonstration,
    task: Task,
    /// What the demonstration did besides moving objects, in order.
    operated: Vec<Operated>,
    late: LateObjects,
    requirements: Requirements,
    scene: SceneSpec,
    /// The robot, if it demonstrates instead of the hand.
    robot: Option<RobotDemonstrator>,
    variation: Variation,
    hand_pictures: HandPictures,
    seed: u64,
    /// That of the recording's files.
    recorded: Fingerprint,
}

/// A robot that demonstrates.
#[derive(Debug)]
struct RobotDemonstrator {
    plugin: RobotPlugin,
    body: RobotBody,
}

/// The result of making one demonstration.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Made {
    /// True if it was kept.
    pub is_kept: bool,
    /// The faults of the attempts that were dropped before.
    pub dropped: Vec<Dropped>,
}

/// The reason why a demonstration was dropped.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Dropped {
    /// There was no room for everything.
    NoRoom,
    /// Something that the task moves was not in the picture all the time.
    OutOfView,
    /// A step of the task has failed.
    Step(usize, PlanFailure),
}

/// The error of a demonstration that cannot be multiplied.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "the message says it")]
pub enum MultiplyError {
    #[error(transparent)]
    Recording(#[from] RecorderError),
    #[error(transparent)]
    Requirements(#[from] RequirementError),
    #[error(transparent)]
    Robot(#[from] ModelError),
    #[error("the recording moves nothing for good, so there is nothing to demonstrate again")]
    NoTask,
    #[error("the recording does not contain the scene at its beginning")]
    NoScene,
    #[error("{0}")]
    Unbound(#[from] tabletop_task::Unbound),
    #[error("{0}")]
    Record(String),
    #[error("{path}: {source}", path = .path.display())]
    Io {
        path: std::path::PathBuf,
        source: io::Error,
    },
}

/// The name of the setting that says of a recording how it was made.
const MULTIPLIED: &str = "multiplied";
/// The most bytes of a file of a recording that are read.
const MOST_BYTES: u64 = 1 << 30;
/// Number of attempts, each with other places, to make a demonstration.
const TRIES: u64 = 20;
/// Number of ticks after which objects on the table are at rest.
const SETTLING: u64 = 30;

impl Multiplication {
    /// Reads a recording whose task is to be demonstrated again, by the robot if there is one, otherwise by the hand.
    ///
    /// # Errors
    /// It cannot be read, or shows no task.
    pub fn of(
        recording: &RecordingReader,
        robot: Option<RobotPlugin>,
        variation: Variation,
        seed: u64,
    ) -> Result<Self, MultiplyError> {
        let shown = Demonstration::of(recording)?;
        let scene = scene_at_beginning(recording.session()).ok_or(MultiplyError::NoScene)?;
        let operated = Operated::in_session(recording.session());
        let folder = recording.folder();
        Self::shown(folder, shown, Some(operated), scene, robot).map(|one| Self {
            variation,
            seed,
            ..one
        })
    }

    /// The same of a folder with nothing but events, as the original program writes them. They are completed from this scene, whose objects take
    /// the roles.
    ///
    /// # Errors
    /// As of [`of`](Self::of), or the objects do not fit.
    pub fn of_events(
        folder: &Path,
        scene: SceneSpec,
        robot: Option<RobotPlugin>,
        variation: Variation,
        seed: u64,
    ) -> Result<Self, MultiplyError> {
        let assembly = assemble(&scene, &mut IdAllocator::default());
        let furniture = Furniture {
            objects: assembly.objects,
            joints: assembly.joints,
        };
        let shown = Demonstration::read(folder, &furniture)?;
        Self::shown(folder, shown, None, scene, robot).map(|one| Self {
            variation,
            seed,
            ..one
        })
    }

    fn shown(
        folder: &Path,
        shown: Demonstration,
        operated: Option<Vec<Operated>>,
        scene: SceneSpec,
        robot: Option<RobotPlugin>,
    ) -> Result<Self, MultiplyError> {
        let task = Task::of(&shown);
        let operated = operated.unwrap_or_else(|| Operated::in_events(&task));
        if task.steps.is_empty() {
            return Err(MultiplyError::NoTask);
        }
        let robot = robot.map(|plugin| RobotDemonstrator::new(plugin, &scene.table));
        Ok(Self {
            operated,
            late: LateObjects::of(&shown),
            requirements: Requirements::read_for(&task, folder)?,
            shown,
            task,
            scene,
            robot: robot.transpose()?,
            variation: Variation::default(),
            hand_pictures: HandPictures::None,
            seed: 0,
            recorded: fingerprint_of(folder)?,
        })
    }

    /// The same with the objects of another scene, which take the roles of the task.
    ///
    /// # Errors
    /// They do not fit.
    pub fn with_scene(mut self, scene: SceneSpec) -> Result<Self, MultiplyError> {
        let objects = assemble(&scene, &mut IdAllocator::default()).objects;
        self.late.bind(&self.task, &self.requirements, &objects)?;
        if let Some(robot) = &mut self.robot {
            robot.body = robot_body(&robot.plugin, &scene.table)?;
        }
        self.scene = scene;
        Ok(self)
    }

    /// The same with the pictures of hand cameras.
    #[must_use]
    pub fn with_hand_pictures(self, hand_pictures: HandPictures) -> Self {
        Self {
            hand_pictures,
            ..self
        }
    }

    /// Records the demonstration of this number in a new folder. It tries other places until the relations of the task hold at
    /// the end and go on to hold.
    ///
    /// # Errors
    /// It cannot be recorded there.
    pub fn make(&self, number: u64, folder: &Path) -> Result<Made, MultiplyError> {
        let mut made = Made::default();
        for attempt in 0..TRIES {
            let beginning = match self.beginning(number, attempt)? {
                Ok(beginning) => beginning,
                Err(dropped) => {
                    made.dropped.push(dropped);
                    continue;
                }
            };
            match self.show(beginning, number, attempt, folder)? {
                Ok(()) => {
                    self.requirements.write(folder)?;
                    made.is_kept = true;
                    break;
                }
                Err((step, failure)) => {
                    made.dropped.push(Dropped::Step(step, failure));
                    let removed = Storage::default().remove_folder(folder);
                    removed.map_err(MultiplyError::io(folder))?;
                }
            }
        }
        Ok(made)
    }

    /// True if a recording says that it is the demonstration of this number.
    pub fn has_made(&self, number: u64, header: &SessionHeader) -> bool {
        let multiplied = header.settings.get(MULTIPLIED);
        let is = |name: &str, value: u64| {
            let found = multiplied.and_then(|multiplied| multiplied.get(name));
            found.and_then(Value::as_u64) == Some(value)
        };
        is("number", number) && is("seed", self.seed)
    }

    fn varying(&self) -> Varying<'_> {
        Varying {
            task: &self.task,
            late: &self.late,
            requirements: &self.requirements,
            scene: &self.scene,
            body: self.robot.as_ref().map(|robot| &robot.body),
            variation: self.variation,
        }
    }

    /// What carries the head camera: the robot, or Baxter, which stands by while the hand demonstrates.
    fn carrier(&self) -> CameraCarrier {
        let robot = self.robot.as_ref();
        let description = robot.and_then(|robot| robot.plugin.description.as_ref());
        description.map_or_else(CameraCarrier::default, |it| (&it.layout).into())
    }

    fn seed_of(&self, number: u64, attempt: u64) -> u64 {
        let mut mixed = self.seed;
        for part in [number, attempt] {
            mixed = Random::new(mixed ^ part.wrapping_mul(0xd6e8_feb8_6659_fd93)).bits();
        }
        mixed
    }

    /// The task that is demonstrated.
    pub fn task(&self) -> &Task {
        &self.task
    }

    /// The variation from one demonstration to the next.
    pub fn variation(&self) -> Variation {
        self.variation
    }

    /// The seed of all differences.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// The beginning of an attempt at the demonstration of this number, or the reason why there is none.
    ///
    /// # Errors
    /// The objects do not fit.
    pub fn beginning(
        &self,
        number: u64,
        attempt: u64,
    ) -> Result<Result<VariedBeginning, Dropped>, MultiplyError> {
        let random = &mut Random::new(self.seed_of(number, attempt));
        let Some(scene) = self.varying().varied(random) else {
            return Ok(Err(Dropped::NoRoom));
        };
        let objects = assemble(&scene, &mut IdAllocator::default()).objects;
        let binding = self.late.bind(&self.task, &self.requirements, &objects)?;
        let carrier = self.carrier();
        let head = HeadCamera {
            carrier,
            ..HeadCamera::default()
        };
        let displacement = self.variation.displacement(random);
        let mount = displacement.map(|displacement| displacement.of(head.pose(&scene.table)));
        let seed = random.bits();
        let light = self.variation.light(random);
        let beginning = VariedBeginning {
            scene,
            objects,
            binding,
            mount,
            light,
            carrier,
            seed,
        };
        let is_in_view = !self.variation.in_view
            || beginning
                .still_scene()
                .keeps_in_view(&self.task, &beginning.binding);
        Ok(is_in_view.then_some(beginning).ok_or(Dropped::OutOfView))
    }

    /// Demonstrates it once, and records that.
    fn show(
        &self,
        beginning: VariedBeginning,
        number: u64,
        attempt: u64,
        folder: &Path,
    ) -> Result<Result<(), (usize, PlanFailure)>, MultiplyError> {
        let view = self.variation.in_view.then(|| beginning.camera());
        let VariedBeginning {
            scene,
            binding,
            mount,
            light,
            seed,
            ..
        } = beginning;
        let mut header = serde_json::Map::new();
        header.insert(
            MULTIPLIED.into(),
            json!({ "seed": self.seed, "number": number, "attempt": attempt }),
        );
        let mut plugins = TabletopSimPlugins.build().set(RecorderPlugin {
            folder: folder.to_owned(),
            header,
            hand_pictures: self.hand_pictures.clone(),
            ..default()
        });
        if let Some(robot) = &self.robot {
            plugins = plugins.set(robot.plugin.clone());
        }
        let mut app = headless_app_with(plugins);
        let world = app.world_mut();
        let mut camera = world.resource_mut::<HeadCamera>();
        camera.mount = mount;
        camera.light = light;
        world.write_command(SceneCommand::Set(Box::new(scene)));
        if self.robot.is_some() {
            world.write_command(RobotCommand::Show(true));
        }
        app.step(SETTLING);
        app.world_mut().write_command(RecordingCommand::Start);
        app.step(1);
        let before = Before::anything(&Sight::of(app.world_mut()));
        let shown = self.act(&mut app, &binding, seed, view.as_ref());
        finish_recording(app.world_mut()).map_err(MultiplyError::Record)?;
        Ok(shown.and_then(|()| lasts(&mut app, &self.task, &binding, &before)))
    }

    /// A fingerprint of all that decides the demonstrations besides variation and seed: the recording, its requirements, the objects, and a robot
    /// other than the one inside the program.
    pub fn fingerprint(&self) -> String {
        let scene = serde_json::to_vec(&self.scene).unwrap_or_default();
        let mut found = self.recorded.and(&scene);
        if let Some(source) = self.robot.as_ref().and_then(RobotDemonstrator::source) {
            let layout = source.layout.as_deref().unwrap_or_default();
            found = found.and(source.urdf.as_bytes()).and(layout.as_bytes());
        }
        found.to_string()
    }

    fn act(
        &self,
        app: &mut App,
        binding: &Binding,
        seed: u64,
        view: Option<&Camera>,
    ) -> Result<(), (usize, PlanFailure)> {
        let Some(RobotDemonstrator { body, .. }) = &self.robot else {
            return perform(app, &self.shown, &self.task, &self.operated, binding, view);
        };
        let mut stage = AppStage::new(app);
        let imitation = imitate(&mut stage, body, &self.task, binding, seed, |_| {});
        imitation.failure.map_or(Ok(()), Err)
    }
}

impl RobotDemonstrator {
    fn new(plugin: RobotPlugin, table: &Table) -> Result<Self, ModelError> {
        let body = robot_body(&plugin, table)?;
        Ok(Self { plugin, body })
    }

    /// The files that it was read from, if it is not the robot inside the program.
    fn source(&self) -> Option<&DescriptionSource> {
        self.plugin.description.as_ref()?.source.as_ref()
    }
}

/// The fingerprint of a recording's files, its pictures apart, and of its requirements.
fn fingerprint_of(recording: &Path) -> Result<Fingerprint, MultiplyError> {
    let entries = Storage::default().entries(recording);
    let files = entries.map_err(MultiplyError::io(recording))?.into_iter();
    let mut found = Fingerprint::EMPTY;
    for file in files.filter(|file| file.is_file()) {
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        if name.starts_with('.') {
            continue;
        }
        let bytes = read_regular_file(&file, MOST_BYTES, Symlinks::Refused);
        let bytes = bytes.map_err(MultiplyError::io(&file))?;
        found = found.and(name.as_bytes()).and(&bytes);
    }
    Ok(found)
}

impl MultiplyError {
    fn io(path: &Path) -> impl FnOnce(io::Error) -> Self {
        |source| Self::Io {
            path: path.to_owned(),
            source,
        }
    }
}

impl fmt::Display for Dropped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoRoom => f.write_str("there was no room for everything"),
            Self::OutOfView => f.write_str("the head camera did not see all that is moved"),
            Self::Step(step, failure) => write!(f, "step {step}: {failure}"),
        }
    }
}
