//! A world for the tests of scenarios.

use std::path::Path;

use bevy::prelude::*;
use tabletop_core::{
    Bonds, Hand, ObjectSpec, Robot, RobotLayout, SceneSpec, Shape, SimCommand, Table,
};
use tabletop_geometry::{Pose, Rgb};

use crate::{
    Outcome, Program, Scenario, ScenarioRun,
    seen::{ScenarioObject, Seen},
};

/// A world that holds still unless a test moves it.
pub struct Stage {
    pub run: ScenarioRun,
    pub specs: Vec<ObjectSpec>,
    pub poses: Vec<Pose>,
    pub holders: Vec<Option<Hand>>,
    pub selected: Hand,
    pub paused: bool,
    pub robot: Robot,
    pub bonds: Bonds,
}

impl Stage {
    pub fn new(steps: &str) -> Self {
        let text = format!("(steps: [{steps}])");
        let load = |_: &Path| Ok(SceneSpec::default());
        let program =
            Scenario::parse("s.ron", &text).and_then(|scenario| Program::new(&scenario, load, 0));
        let program = match program {
            Ok(program) => program,
            Err(error) => panic!("{error}"),
        };
        let shape = Shape::Block {
            span: Vec3::ONE,
            color: Rgb::GRAY,
        };
        let block = |id: &str| ObjectSpec::new(id, Pose::IDENTITY, 1.0, shape.clone());
        Self {
            run: ScenarioRun::new(program),
            specs: vec![block("low"), block("high")],
            poses: vec![Pose::at(Vec3::Z * 0.5), Pose::at(Vec3::Z * 1.5)],
            holders: vec![None, None],
            selected: Hand::Any,
            paused: false,
            robot: Robot::default(),
            bonds: Bonds::default(),
        }
    }

    pub fn tick_refused(&mut self, refusal: Option<&str>) -> Vec<SimCommand> {
        let mut world = World::new();
        let objects = self
            .specs
            .iter()
            .enumerate()
            .map(|(index, spec)| ScenarioObject {
                entity: world.spawn_empty().id(),
                spec,
                pose: self.poses[index],
                holder: self.holders[index],
            });
        let seen = Seen {
            objects: objects.collect(),
            table: Some(Table::default()),
            joints: Vec::new(),
            selected: self.selected,
            paused: self.paused,
            robot: &self.robot,
            bonds: &self.bonds,
            layout: RobotLayout::baxter(),
        };
        self.run.tick(&seen, refusal)
    }

    pub fn tick(&mut self) -> Option<SimCommand> {
        self.tick_refused(None).into_iter().next()
    }

    /// Ticks until it is over; returns their number.
    pub fn finish(&mut self) -> u64 {
        (0..10_000)
            .find(|_| {
                self.tick();
                *self.run.outcome() != Outcome::Running
            })
            .unwrap_or(10_000)
    }

    pub fn failure(&mut self) -> String {
        self.finish();
        match self.run.outcome() {
            Outcome::Failed(error) => error.to_string(),
            other @ (Outcome::Running | Outcome::Done) => format!("{other:?}"),
        }
    }
}
