//! Trials of programs by a robot: what was understood of a lesson, done on other tables.

use std::collections::BTreeMap;

use bevy::prelude::*;
use tabletop_core::{
    Random, RobotCommand, SceneCommand, SceneSpec, StepApp as _, Table, WriteCommand as _,
};
use tabletop_episodes::{
    imitation::scattered,
    telling::{ProgramActor, carry_out},
};
use tabletop_planner::RobotBody;
use tabletop_program::{ProgramRun, TableScene, TaskProgram};
use tabletop_recorder::{RecorderPlugin, UnrecordedPlugin};
use tabletop_robot::RobotPlugin;
use tabletop_scene::{IdAllocator, assemble};
use tabletop_sim::{TabletopSimPlugins, headless_app_with};

use crate::lesson::{BenchmarkLesson, WIDE};

/// What a robot did of a program on other tables.
#[derive(Clone, Debug)]
pub struct RobotTrials {
    /// The lesson.
    pub lesson: &'static BenchmarkLesson,
    /// The number of objects of each trial, beside those that a lesson always has, and why it was given up; `None` if it is done.
    pub trials: Vec<(usize, Option<String>)>,
    /// The number of steps that were done.
    pub steps: usize,
    /// The number of tables for which there was no room before the robot.
    pub without_room: usize,
}

/// A robot that does programs.
#[derive(Clone, Debug)]
pub struct TrialRobot {
    plugin: RobotPlugin,
    body: RobotBody,
}

/// The table before the robot, in units.
const TABLE: Table = Table {
    xspan: 20.0,
    yspan: 12.0,
};
/// The fewest and the most objects of a trial.
const OBJECTS: (usize, usize) = (2, 9);
/// How often a table is drawn before it is given up.
const DRAWS: usize = 8;
/// Number of ticks after which a scene is at rest.
const SETTLING: u64 = 30;

impl TrialRobot {
    /// A robot with its body at the table of trials.
    ///
    /// # Errors
    /// It is no robot that can be planned for: the reason.
    pub fn new(plugin: RobotPlugin) -> Result<Self, String> {
        let body = tabletop_episodes::robot_body(&plugin, &TABLE);
        let body = body.map_err(|error| error.to_string())?;
        Ok(Self { plugin, body })
    }
}

impl RobotTrials {
    /// Lets a robot do a program on so many tables of a lesson, with from two to nine objects.
    pub fn of(
        lesson: &'static BenchmarkLesson,
        program: &TaskProgram,
        robot: &TrialRobot,
        seed: u64,
        tables: usize,
    ) -> Self {
        // Other tables than those of demonstrations.
        let mut random = Random::new(!seed);
        let (least, most) = OBJECTS;
        let least = least.max(lesson.least);
        let mut all = Self {
            lesson,
            trials: Vec::new(),
            steps: 0,
            without_room: 0,
        };
        for number in 0..tables {
            let count = least + number % (most.max(least) - least + 1);
            let Some(scene) = lesson.trial_scene(count, program, &robot.body, &mut random) else {
                all.without_room += 1;
                continue;
            };
            let (steps, failure) = tried(scene, program, robot, random.bits());
            all.steps += steps;
            all.trials.push((count, failure));
        }
        all
    }

    /// The number of tables on which the program was done.
    pub fn done(&self) -> usize {
        let done = self.trials.iter().filter(|(_, failure)| failure.is_none());
        done.count()
    }

    /// The reasons why programs were given up, with their numbers.
    pub fn failures(&self) -> BTreeMap<&str, usize> {
        let mut failures = BTreeMap::new();
        for (_, failure) in &self.trials {
            if let Some(failure) = failure {
                *failures.entry(failure.as_str()).or_default() += 1;
            }
        }
        failures
    }
}

/// A robot does a program in a world of its own: the number of steps that were done, and why it was given up.
fn tried(
    scene: SceneSpec,
    program: &TaskProgram,
    robot: &TrialRobot,
    seed: u64,
) -> (usize, Option<String>) {
    let objects = assemble(&scene, &mut IdAllocator::default()).objects;
    let plugins = TabletopSimPlugins.build().set(robot.plugin.clone());
    let plugins = plugins.disable::<RecorderPlugin>().add(UnrecordedPlugin);
    let mut app = headless_app_with(plugins);
    let world = app.world_mut();
    world.write_command(SceneCommand::Set(Box::new(scene)));
    world.write_command(RobotCommand::Show(true));
    app.step(SETTLING);
    let actor = ProgramActor::Robot {
        body: &robot.body,
        seed,
    };
    let told = carry_out(&mut app, program, &objects, actor, |_, _| {});
    let failure = told.failure.map(|failure| failure.class().to_owned());
    (told.steps.len(), failure)
}

impl BenchmarkLesson {
    /// A table before a robot with so many pieces, on which there is something to do for a program.
    fn trial_scene(
        &self,
        count: usize,
        program: &TaskProgram,
        body: &RobotBody,
        random: &mut Random,
    ) -> Option<SceneSpec> {
        (0..DRAWS).find_map(|_| {
            let drawn = before_robot(self.scene(count, WIDE, random)?);
            let scene = scattered(&drawn, &[], Some(body), random.bits())?;
            let (steps, _, impossible) = ProgramRun::rehearsed(program, &table_of(&scene));
            (impossible.is_none() && !steps.is_empty()).then_some(scene)
        })
    }
}

fn table_of(scene: &SceneSpec) -> TableScene {
    let assembly = assemble(scene, &mut IdAllocator::default());
    TableScene {
        table: scene.table,
        objects: assembly.objects,
        joints: assembly.joints,
    }
}

/// A table as it stands before the robot.
fn before_robot(table: TableScene) -> SceneSpec {
    SceneSpec {
        table: TABLE,
        ..table.items()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::LESSONS;

    fn robot() -> TrialRobot {
        TrialRobot::new(RobotPlugin::default()).unwrap()
    }

    #[test]
    fn nine_find_room_before_the_robot() {
        let robot = robot();
        let lesson = LESSONS
            .iter()
            .find(|lesson| lesson.family == "stack in an order");
        let lesson = lesson.unwrap();
        let program = lesson.program().unwrap();
        let scene = lesson.trial_scene(9, &program, &robot.body, &mut Random::new(1));
        let objects = table_of(&scene.unwrap()).objects;
        let blocks = objects.iter().filter(|it| it.id.starts_with("Block"));
        assert_eq!(blocks.count(), 9);
    }

    #[test]
    fn a_robot_does_what_was_understood() {
        let lesson = &LESSONS[0];
        let program = lesson.program().unwrap();
        let trials = RobotTrials::of(lesson, &program, &robot(), 1, 1);
        assert_eq!((trials.done(), trials.without_room), (1, 0), "{trials:?}");
        assert!(trials.steps > 0 && trials.failures().is_empty());
    }
}
