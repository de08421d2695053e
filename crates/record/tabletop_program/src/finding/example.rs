//! Demonstrations as examples of programs: what was done with which object, and the table before and after each deed.

use std::collections::BTreeSet;

use tabletop_core::SimTick;
use tabletop_task::{Demonstration, Relation, Task, TaskStep};

use crate::{
    program::TaskProgram,
    run::{Impossible, ProgramRun},
    scene::{SceneView, TableScene},
};

/// An example of a program: what was done on a table, step by step.
#[derive(Clone, Debug)]
pub struct Example {
    pub(crate) deeds: Vec<ExampleDeed>,
    /// The table before each deed, and at the end.
    pub(crate) tables: Vec<TableScene>,
}

/// What was done with an object.
#[derive(Clone, Debug)]
pub(crate) struct ExampleDeed {
    pub object: String,
    /// The relations that it established, the most telling first.
    pub relations: Vec<Relation>,
}

/// An example with all that follows from it.
pub(crate) struct ExampleView<'e> {
    pub deeds: &'e [ExampleDeed],
    pub views: Vec<SceneView<'e>>,
}

/// Number of ticks after which what was released lies still.
const SETTLING: u64 = 60;

impl Example {
    /// The example that a demonstration of a task is. `None` if it shows what no program says: turns, triggered controls, and what was not put down.
    pub fn of(shown: &Demonstration, task: &Task) -> Option<Self> {
        let is_sayable = |step: &TaskStep| {
            let relation = step.relations.first();
            step.tipping.is_none() && step.spilled.is_none() && relation.is_some_and(is_sayable)
        };
        if !task.operations.is_empty() || !task.steps.iter().all(is_sayable) {
            return None;
        }
        let ends = task.steps.iter().enumerate().map(|(i, step)| {
            let next = task.steps.get(i + 1).map(|next| next.grasp);
            let rest = SimTick(step.release.0 + SETTLING);
            // The table is still until the next grasp, if that comes later.
            next.filter(|next| *next > step.release)
                .map_or(rest, |next| SimTick(next.0 - 1))
                .min(shown.end)
        });
        let ticks = [shown.start].into_iter().chain(ends);
        let deeds = task.steps.iter().map(|step| ExampleDeed {
            object: step.object.clone(),
            relations: step.relations.clone(),
        });
        Some(Self {
            deeds: deeds.collect(),
            tables: ticks.map(|tick| TableScene::at(shown, tick)).collect(),
        })
    }

    /// What a program does on a table.
    ///
    /// # Errors
    /// It cannot be done there.
    pub fn of_program(program: &TaskProgram, scene: &TableScene) -> Result<Self, Impossible> {
        let (steps, _, failure) = ProgramRun::rehearsed(program, scene);
        if let Some(failure) = failure {
            return Err(failure);
        }
        let mut tables = vec![scene.clone()];
        for step in &steps {
            let after = tables.last().map(|table| table.after(step));
            tables.extend(after);
        }
        let deeds = steps.into_iter().map(|step| ExampleDeed {
            object: step.object,
            relations: vec![step.relation],
        });
        Ok(Self {
            deeds: deeds.collect(),
            tables,
        })
    }

    /// The number of its steps.
    pub fn steps(&self) -> usize {
        self.deeds.len()
    }

    pub(crate) fn view(&self) -> ExampleView<'_> {
        ExampleView {
            deeds: &self.deeds,
            views: self.tables.iter().map(TableScene::view).collect(),
        }
    }

    /// The objects that were handled, and those to which they were put.
    pub(crate) fn touched(&self) -> BTreeSet<&str> {
        let deeds = self.deeds.iter();
        deeds
            .flat_map(|deed| {
                let others = deed.relations.iter().filter_map(Relation::object);
                others.chain([deed.object.as_str()])
            })
            .collect()
    }
}

impl TableScene {
    /// The table of a demonstration at the end of a tick.
    fn at(shown: &Demonstration, tick: SimTick) -> Self {
        let there = shown.objects.iter().filter(|object| {
            object.created <= tick && object.deleted.is_none_or(|deleted| tick < deleted)
        });
        let objects = there.map(|object| {
            let mut spec = object.spec.clone();
            spec.pose = object.track.at(tick).unwrap_or(spec.pose);
            spec
        });
        Self {
            table: shown.table,
            objects: objects.collect(),
            joints: shown.joints.clone(),
        }
    }

    /// The table at the beginning of a demonstration.
    pub fn at_beginning(shown: &Demonstration) -> Self {
        Self::at(shown, shown.start)
    }
}

/// True if an instruction can establish a relation.
fn is_sayable(relation: &Relation) -> bool {
    match relation {
        Relation::OnTable
        | Relation::On { .. }
        | Relation::Inside { .. }
        | Relation::Around { .. }
        | Relation::Beside { .. }
        | Relation::InPlaceOf { .. }
        | Relation::Aside
        | Relation::Slid { .. }
        | Relation::Destroyed => true,
        Relation::Against { .. }
        | Relation::AlignedWith { .. }
        | Relation::Turned { .. }
        | Relation::LetGo
        | Relation::Held => false,
    }
}
