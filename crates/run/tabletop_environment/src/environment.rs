//! An environment of reinforcement learning: a task, and a robot that acts.

use std::path::PathBuf;

use bevy::prelude::*;
use tabletop_camera::CameraSpec;
use tabletop_core::{
    ObjectIndex, Picture, Random, RecordingCommand, Robot, RobotCommand, RobotLayout, SceneCommand,
    WriteCommand as _,
};
use tabletop_episodes::robot_body;
use tabletop_planner::RobotBody;
use tabletop_recorder::GivenCommands;
use tabletop_robot::{Description, RobotPlugin};
use tabletop_scenario::{Judge, Verdict};
use tabletop_scene::{IdAllocator, assemble};
use tabletop_sim::{remember_beginning, reset};

use crate::{
    action::{ActionSpace, EndEffectorTargets, move_at, move_to},
    error::EnvironmentError,
    goal::EpisodeGoal,
    observation::{ObservationSpace, StateLayout},
    pick_place::pick_and_place,
    table_world::{TableWorld, WorldMoment, WorldOptions, WorldOrigin, robot_plugin},
    task::EnvironmentTask,
};

/// The options of an environment.
#[derive(Clone, Debug)]
pub struct EnvironmentOptions {
    /// A `robot.ron` or a URDF; `None` for Baxter.
    pub robot: Option<PathBuf>,
    /// Whether the arms are moved by motors with limited torque.
    pub is_dynamic: bool,
    /// What it observes.
    pub observation: ObservationSpace,
    /// How the robot acts.
    pub action: ActionSpace,
    /// The reward.
    pub reward: Reward,
    /// The camera of its pictures, with their size.
    pub camera: CameraSpec,
    /// Whether the edges in its pictures are smooth, which takes three times as long.
    pub is_smooth: bool,
    /// Number of ticks of 1/60 s in a step.
    pub ticks_per_step: u64,
    /// Number of steps after which an episode is cut off.
    pub most_steps: u64,
    /// The folder in which each episode becomes a recording, `000000` and so on; `None` if none is recorded.
    pub record: Option<PathBuf>,
}

impl Default for EnvironmentOptions {
    fn default() -> Self {
        Self {
            robot: None,
            is_dynamic: false,
            observation: ObservationSpace::State,
            action: ActionSpace::JointVelocity,
            reward: Reward::Dense,
            camera: CameraSpec::head(128, 128),
            is_smooth: false,
            ticks_per_step: 3,
            most_steps: 400,
            record: None,
        }
    }
}

/// The reward of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reward {
    /// The units by which the world has come nearer to its goal in this step, and 1 if it is there. It is the mean over the checks of the distance
    /// of the two places that a check compares, and half the distance of the nearest end effector from what is to be moved next.
    Dense,
    /// 1 if the world is at its goal, 0 otherwise.
    Sparse,
    /// The negative mean over the checks of the distance of the two places that a check compares, in units: what hindsight can compute anew for
    /// other goals.
    Distance,
}

impl Reward {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Dense, Self::Sparse, Self::Distance];

    /// Its name in options.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Dense => "dense",
            Self::Sparse => "sparse",
            Self::Distance => "distance",
        }
    }
}

/// The result of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Transition {
    /// The reward.
    pub reward: f32,
    /// Whether the world is at its goal.
    pub is_success: bool,
    /// Whether the episode is cut off.
    pub is_truncated: bool,
}

/// An environment. It can be sent to another thread.
///
/// ```
/// use tabletop_environment::{TaskEnvironment, EnvironmentOptions, EnvironmentTask};
///
/// let task = EnvironmentTask::of_scenario("scenarios/stack_three.ron".as_ref(), true, &[])?;
/// let mut environment = TaskEnvironment::new(task, &EnvironmentOptions::default())?;
/// environment.reset(Some(7))?;
/// let transition = environment.step(&[0.5; 16])?;
/// assert!(!transition.is_success);
/// let mut state = vec![0.0; environment.state_layout().numbers()];
/// environment.observe_state(&mut state);
/// assert!((state[0] - 0.0).abs() < 3.2);
/// # Ok::<_, tabletop_environment::EnvironmentError>(())
/// ```
pub struct TaskEnvironment {
    world: TableWorld,
    task: EnvironmentTask,
    options: EnvironmentOptions,
    body: Option<RobotBody>,
    layout: StateLayout,
    action: Vec<f32>,
    random: Random,
    episode: EpisodeState,
    /// The commands that led to the world with which each episode begins.
    given: GivenCommands,
    /// Number of episodes that were recorded.
    recorded: usize,
}

/// The state of an episode, beside the world.
#[derive(Clone, Debug, Default)]
struct EpisodeState {
    goal: EpisodeGoal,
    judge: Judge,
    verdicts: Vec<Verdict>,
    targets: EndEffectorTargets,
    has_begun: bool,
    steps: u64,
    /// The distance from the goal, of which the dense reward is the decrease.
    distance: f32,
}

/// An environment at a moment, to which it can [return](TaskEnvironment::restore).
pub struct EnvironmentMoment {
    world: WorldMoment,
    random: Random,
    episode: EpisodeState,
}

impl TaskEnvironment {
    /// An environment. Its first episode begins with a [reset](Self::reset).
    ///
    /// # Errors
    /// A file cannot be read or has a fault.
    pub fn new(
        task: EnvironmentTask,
        options: &EnvironmentOptions,
    ) -> Result<Self, EnvironmentError> {
        let robot = Self::shared_robot(options)?;
        Self::with_robot(task, options, robot)
    }

    /// The robot of these options, whose clones share what they can.
    pub(crate) fn shared_robot(
        options: &EnvironmentOptions,
    ) -> Result<RobotPlugin, EnvironmentError> {
        let mut robot = robot_plugin(options.robot.as_deref(), options.is_dynamic)?;
        if robot.description.is_none() {
            let baxter = Description::baxter();
            robot.description =
                Some(baxter.map_err(|error| EnvironmentError::World(error.to_string()))?);
        }
        Ok(robot)
    }

    /// [`new`](Self::new) with a clone of a shared robot.
    pub(crate) fn with_robot(
        task: EnvironmentTask,
        options: &EnvironmentOptions,
        robot: RobotPlugin,
    ) -> Result<Self, EnvironmentError> {
        if options.ticks_per_step == 0 || options.most_steps == 0 {
            return Err(EnvironmentError::Option(
                "expected at least one tick in a step, and one step in an episode".into(),
            ));
        }
        let world_options = WorldOptions {
            beginning: WorldOrigin::Empty,
            robot: options.robot.clone(),
            is_dynamic: options.is_dynamic,
            is_recordable: options.record.is_some(),
            shows_robot: options.action != ActionSpace::PickPlace,
            ..WorldOptions::default()
        };
        let mut world = TableWorld::with_robot(&world_options, robot.clone())?;
        world.set_smooth(options.is_smooth);
        remember_beginning(world.world_mut());
        let plan = task.plan(world.world_mut(), None, &mut Random::new(0))?;
        let body = match options.action == ActionSpace::PickPlace {
            true => None,
            false => {
                let body = robot_body(&robot, &plan.scene.table);
                Some(body.map_err(|error| EnvironmentError::Option(error.to_string()))?)
            }
        };
        let robot = world.world().resource::<RobotLayout>();
        let objects = assemble(&plan.scene, &mut IdAllocator::default()).objects;
        let layout = StateLayout {
            joints: robot.joints.len(),
            limbs: robot.limbs.len(),
            objects: objects.into_iter().map(|object| object.id).collect(),
            checks: plan.goal.len(),
        };
        let action = vec![0.0; options.action.len(robot)];
        Ok(Self {
            given: GivenCommands::of(world.world()),
            recorded: 0,
            world,
            task,
            options: options.clone(),
            body,
            layout,
            action,
            random: Random::new(0),
            episode: EpisodeState::default(),
        })
    }

    /// Begins an episode: with a seed that of this seed, in any environment of this task; otherwise the next one.
    ///
    /// # Errors
    /// There is no room for a random arrangement, or the recording of an episode has failed.
    pub fn reset(&mut self, seed: Option<u64>) -> Result<(), EnvironmentError> {
        self.finish_recording()?;
        if let Some(seed) = seed {
            self.random = Random::new(seed);
        }
        self.world.drop_removed();
        let world = self.world.world_mut();
        reset(world);
        self.given.restore(world);
        let plan = self
            .task
            .plan(world, self.body.as_ref(), &mut self.random)?;
        world.write_command(SceneCommand::Set(Box::new(plan.scene)));
        if !plan.markers.is_empty() {
            world.write_command(RobotCommand::ShowMarkers(plan.markers));
        }
        self.world.step(1);
        self.world.take_facts();
        self.episode = EpisodeState {
            goal: plan.goal,
            targets: EndEffectorTargets::new(self.world.world()),
            has_begun: true,
            ..EpisodeState::default()
        };
        self.judge(1)?;
        self.episode.distance = self.distance();
        self.record()
    }

    /// Records the episode that begins, if episodes are recorded.
    fn record(&mut self) -> Result<(), EnvironmentError> {
        let Some(folder) = &self.options.record else {
            return Ok(());
        };
        let folder = folder.join(format!("{:06}", self.recorded));
        self.world.record_into(&folder)?;
        self.world
            .world_mut()
            .write_command(RecordingCommand::Start);
        self.recorded += 1;
        Ok(())
    }

    /// Ends the recording of an episode, if there is one; it takes a tick. The next [reset](Self::reset) does so, too.
    ///
    /// # Errors
    /// The recording has failed: the fault, and the remedy.
    pub fn finish_recording(&mut self) -> Result<(), EnvironmentError> {
        self.world.finish_recording().map(drop)
    }

    /// Whether it can act so now.
    ///
    /// # Errors
    /// No episode has begun, the action has the wrong length, or one of its numbers is NaN.
    pub fn check_action(&self, action: &[f32]) -> Result<(), EnvironmentError> {
        if !self.episode.has_begun {
            return Err(EnvironmentError::NoEpisode("no episode has begun"));
        }
        if action.len() != self.action.len() {
            return Err(EnvironmentError::Action {
                found: action.len(),
                expected: self.action.len(),
            });
        }
        match action.iter().position(|number| number.is_nan()) {
            Some(number) => Err(EnvironmentError::NotANumber { number }),
            None => Ok(()),
        }
    }

    /// Acts for a step.
    ///
    /// # Errors
    /// As [`check_action`](Self::check_action).
    pub fn step(&mut self, action: &[f32]) -> Result<Transition, EnvironmentError> {
        self.check_action(action)?;
        for (own, &number) in self.action.iter_mut().zip(action) {
            *own = number.clamp(-1.0, 1.0);
        }
        let before = self.world.tick();
        let ticks = self.options.ticks_per_step;
        let (world, targets) = (&mut self.world, &mut self.episode.targets);
        match self.options.action {
            ActionSpace::JointVelocity => move_at(world.world_mut(), &self.action, ticks),
            ActionSpace::JointPosition => move_to(world.world_mut(), &self.action, ticks),
            ActionSpace::EndEffectorDelta => {
                targets.move_by(world.world_mut(), &self.action, ticks)
            }
            ActionSpace::PickPlace => pick_and_place(world, &self.action),
        }
        self.world.take_facts();
        let passed = self.world.tick() - before;
        self.judge(passed)?;
        self.episode.steps += 1;
        let is_success = self.episode.verdicts.iter().all(|it| it.failure.is_none());
        let success = f32::from(u8::from(is_success));
        let reward = match self.options.reward {
            Reward::Sparse => success,
            Reward::Distance => -self.gap(),
            Reward::Dense => {
                let before = self.episode.distance;
                self.episode.distance = self.distance();
                before - self.episode.distance + success
            }
        };
        Ok(Transition {
            reward,
            is_success,
            is_truncated: !is_success && self.episode.steps >= self.options.most_steps,
        })
    }

    fn judge(&mut self, ticks: u64) -> Result<(), EnvironmentError> {
        let world = self.world.world_mut();
        let episode = &mut self.episode;
        let failed = |error: BevyError| EnvironmentError::World(error.to_string());
        episode.judge.observe(world, ticks).map_err(failed)?;
        episode.verdicts = episode.goal.judge(&episode.judge, world).map_err(failed)?;
        Ok(())
    }

    /// The mean distance of the places that there are from those that should be.
    fn gap(&self) -> f32 {
        let verdicts = &self.episode.verdicts;
        let gaps: f32 = verdicts.iter().map(|it| it.gap.length()).sum();
        gaps / verdicts.len().max(1) as f32
    }

    /// The distance from the goal.
    fn distance(&self) -> f32 {
        let mean = self.gap();
        let next = self.episode.goal.next(&self.episode.verdicts);
        let world = self.world.world();
        let object = next.and_then(|id| world.resource::<ObjectIndex>().get(id));
        let place = object.and_then(|object| world.get::<Transform>(object));
        let limbs = &world.resource::<Robot>().limbs;
        let away = place.map(|place| {
            let away = limbs
                .iter()
                .map(|limb| limb.end_effector.location.distance(place.translation));
            away.fold(f32::INFINITY, f32::min)
        });
        mean + away.filter(|away| away.is_finite()).unwrap_or(0.0) / 2.0
    }

    /// The order of the numbers of a state.
    pub const fn state_layout(&self) -> &StateLayout {
        &self.layout
    }

    /// Number of the numbers of an action.
    pub const fn action_len(&self) -> usize {
        self.action.len()
    }

    /// Its options.
    pub const fn options(&self) -> &EnvironmentOptions {
        &self.options
    }

    /// Writes the state into a slice of [as many](StateLayout::numbers) numbers.
    pub fn observe_state(&self, state: &mut [f32]) {
        self.layout
            .write(self.world.world(), &self.episode.verdicts, state);
    }

    /// The picture of its camera.
    ///
    /// # Errors
    /// The robot has no such camera.
    pub fn picture(&mut self) -> Result<&Picture, EnvironmentError> {
        let camera = std::slice::from_ref(&self.options.camera);
        Ok(&self.world.shoot(camera)?[0].picture)
    }

    /// The checks of the episode, compared with the world. Those of an [instruction](Self::instruction) are of the objects, one each: where it is, and
    /// where it is to be.
    pub fn verdicts(&self) -> &[Verdict] {
        &self.episode.verdicts
    }

    /// The sentences that say what is to be done in this episode, if it is said.
    pub fn instruction(&self) -> Option<&str> {
        self.episode.goal.instruction()
    }

    /// What is not yet as it should be, in words.
    pub fn failures(&self) -> Vec<String> {
        let verdicts = self.episode.verdicts.iter();
        verdicts.filter_map(|it| it.failure.clone()).collect()
    }

    /// The present moment.
    pub fn snapshot(&mut self) -> EnvironmentMoment {
        EnvironmentMoment {
            world: self.world.snapshot(),
            random: self.random.clone(),
            episode: self.episode.clone(),
        }
    }

    /// Returns to a moment of this environment, bit for bit.
    ///
    /// # Errors
    /// As [`TableWorld::restore`].
    pub fn restore(&mut self, moment: &EnvironmentMoment) -> Result<(), EnvironmentError> {
        self.world.restore(&moment.world)?;
        self.random = moment.random.clone();
        self.episode = moment.episode.clone();
        Ok(())
    }

    /// Its world.
    pub const fn table_world(&mut self) -> &mut TableWorld {
        &mut self.world
    }
}
