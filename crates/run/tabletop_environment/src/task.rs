//! The task of an environment: the table with which an episode begins, and the checks at which it ends.

use std::path::{Path, PathBuf};

use bevy::prelude::*;
use tabletop_core::{Random, RobotLayout, SceneSpec};
use tabletop_episodes::imitation::scattered;
use tabletop_geometry::Pose;
use tabletop_planner::RobotBody;
use tabletop_robot::reach;
use tabletop_scenario::{Check, Program, RobotCheck, Scenario};
use tabletop_sim::shipped::{read_faultless_task, read_scenario, true_path};

use crate::{
    error::EnvironmentError,
    goal::EpisodeGoal,
    instruction::{ToldGoal, setup},
};

/// The number of places that are tried for a target of `Reach`.
const TRIES: usize = 1000;

/// The number of arrangements that are tried for an episode.
const DRAWS: usize = 50;

/// Distance, in units, from which an end effector is at its target.
const REACHED: f32 = 0.3;

/// Extents, in units, of the box over the table in which the targets of `Reach` are.
const TARGETS: [(f32, f32); 3] = [(-7.0, 7.0), (-5.0, 2.0), (1.0, 6.0)];

/// The task of an environment.
#[derive(Clone, Debug)]
pub struct EnvironmentTask {
    path: PathBuf,
    kind: TaskKind,
}

#[derive(Clone, Debug)]
enum TaskKind {
    /// The setup of a scenario, and the checks after its last act.
    Scenario {
        scenario: Box<Scenario>,
        allowed: Vec<PathBuf>,
        scatters: bool,
    },
    /// What a sentence says is to be done with the objects of a scene, which are somewhere else in each episode.
    Instruction(Box<SceneSpec>),
    /// An end effector is to be at a point.
    Reach,
}

/// The beginning and the end of an episode.
#[derive(Clone, Debug)]
pub(crate) struct EpisodePlan {
    pub scene: SceneSpec,
    pub goal: EpisodeGoal,
    /// Points to show.
    pub markers: Vec<Vec3>,
}

impl EnvironmentTask {
    /// The task of a scenario: its setup, and the checks after its last act. What it does in between is not looked at. With `scatters`,
    /// everything is put at other places within reach of the robot in each episode.
    ///
    /// # Errors
    /// The scenario cannot be read, has no setup or no goal.
    pub fn of_scenario(
        path: &Path,
        scatters: bool,
        allowed: &[PathBuf],
    ) -> Result<Self, EnvironmentError> {
        let mut scenario = read_scenario(path)?;
        scenario.allowed = allowed.to_vec();
        Self::new(scenario, scatters, allowed)
    }

    /// The task of a task file and checks, each as it stands in a scenario: `OnTopOf(object: "Red", of: "Green")`.
    ///
    /// # Errors
    /// The task file cannot be read or has faults, or a check cannot be read.
    pub fn of_setup(
        setup: &Path,
        checks: &[String],
        scatters: bool,
        allowed: &[PathBuf],
    ) -> Result<Self, EnvironmentError> {
        let checks: Vec<_> = checks
            .iter()
            .map(|check| format!("Expect({check})"))
            .collect();
        let mut scenario = Scenario::parse("goal", &format!("(steps: [{}])", checks.join(", ")))?;
        scenario.allowed = allowed.to_vec();
        scenario.begin_with(&true_path(setup));
        Self::new(scenario, scatters, allowed)
    }

    fn new(
        scenario: Scenario,
        scatters: bool,
        allowed: &[PathBuf],
    ) -> Result<Self, EnvironmentError> {
        let path = scenario.path.clone();
        begin(&scenario, allowed, 0)?;
        Ok(Self {
            path,
            kind: TaskKind::Scenario {
                scenario: Box::new(scenario),
                allowed: allowed.to_vec(),
                scatters,
            },
        })
    }

    /// What a sentence says is to be done, which is another one in each episode: with blocks of several sizes and colours, a tray and a plate at
    /// places within reach of the robot.
    ///
    /// # Errors
    /// None that the program's tests would not find.
    pub fn instruction() -> Result<Self, EnvironmentError> {
        let scene = read_faultless_task(setup(), &[]).map_err(EnvironmentError::Task)?;
        Ok(Self {
            path: setup().to_owned(),
            kind: TaskKind::Instruction(Box::new(scene)),
        })
    }

    /// An end effector is to reach points over an empty table.
    pub fn reach() -> Self {
        Self {
            path: "Reach".into(),
            kind: TaskKind::Reach,
        }
    }

    /// An episode in a world whose robot is at home, at random. The body is that robot's, if it is there.
    pub(crate) fn plan(
        &self,
        world: &mut World,
        body: Option<&RobotBody>,
        random: &mut Random,
    ) -> Result<EpisodePlan, EnvironmentError> {
        let no_room = || EnvironmentError::NoRoom(self.path.clone());
        match &self.kind {
            TaskKind::Scenario {
                scenario,
                allowed,
                scatters,
            } => {
                let mut plan = begin(scenario, allowed, random.bits())?;
                if *scatters {
                    let arranged = |_| scattered(&plan.scene, &[], body, random.bits());
                    plan.scene = (0..DRAWS).find_map(arranged).ok_or_else(no_room)?;
                }
                Ok(plan)
            }
            TaskKind::Instruction(scene) => {
                for _ in 0..DRAWS {
                    let Some(scene) = scattered(scene, &[], body, random.bits()) else {
                        continue;
                    };
                    let goal = ToldGoal::draw(&scene, random);
                    let goal = goal.map_err(|fault| EnvironmentError::Task(fault.to_string()))?;
                    if let Some(goal) = goal {
                        return Ok(EpisodePlan {
                            scene,
                            goal: EpisodeGoal::Told(Box::new(goal)),
                            markers: Vec::new(),
                        });
                    }
                }
                Err(no_room())
            }
            TaskKind::Reach => {
                let layout = world.resource::<RobotLayout>();
                let limb = layout.limb_ids().last().ok_or_else(no_room)?;
                let arm = layout.limb(limb).name;
                let target = |_| Vec3::from_array(TARGETS.map(|range| random.between(range)));
                let at = (0..TRIES)
                    .map(target)
                    .find(|&at| reach(world, limb, Pose::at(at)).is_ok())
                    .ok_or_else(no_room)?;
                let check = RobotCheck::EndEffector {
                    arm,
                    at,
                    within: REACHED,
                };
                Ok(EpisodePlan {
                    scene: SceneSpec::default(),
                    goal: EpisodeGoal::Checks(vec![Check::Robot(check)]),
                    markers: vec![at],
                })
            }
        }
    }
}

/// An episode of a scenario, with its random places.
fn begin(
    scenario: &Scenario,
    allowed: &[PathBuf],
    seed: u64,
) -> Result<EpisodePlan, EnvironmentError> {
    let program = Program::new(scenario, |file| read_faultless_task(file, allowed), seed)?;
    let path = || scenario.path.clone();
    let scene = program.scene().cloned();
    let scene = scene.ok_or_else(|| EnvironmentError::NoSetup(path()))?;
    let goal = program.goal();
    if goal.is_empty() {
        return Err(EnvironmentError::NoGoal(path()));
    }
    Ok(EpisodePlan {
        scene,
        goal: EpisodeGoal::Checks(goal),
        markers: Vec::new(),
    })
}
