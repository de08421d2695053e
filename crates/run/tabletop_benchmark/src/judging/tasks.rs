//! The tasks by which policies are judged.

use bevy::math::Vec3;
use tabletop_core::{ObjectSpec, SceneItem, SceneSpec, Shape, Table};
use tabletop_geometry::{Pose, Rgb};
use tabletop_program::{SentenceError, TaskProgram};

use crate::props::{holder, plate};

/// A task by which policies are judged.
#[derive(Clone, Copy, Debug)]
pub struct JudgedTask {
    /// Its name.
    pub name: &'static str,
    /// What is to be done, in sentences of task programs. A policy is told these, and they decide whether it is done.
    pub sentences: &'static str,
    /// The same in other words.
    pub(super) other_words: &'static [&'static str],
    things: &'static [TaskThing],
    /// Simulated time in which a policy that moves joints must have done it, in s.
    pub seconds: u64,
}

/// What is on the table of a task.
#[derive(Clone, Copy, Debug)]
enum TaskThing {
    Block(&'static str, Rgb),
    /// A block on the thing before it.
    Upper(&'static str, Rgb),
    Box,
    Plate,
}

/// The table, in units.
const TABLE: Table = Table {
    xspan: 20.0,
    yspan: 12.0,
};
/// The edge of blocks, which fit between the fingers of every robot inside the program, in units.
const EDGE: f32 = 0.4;
/// The mass of blocks, in kg.
const MASS: f32 = 0.1;
const BOX: Vec3 = Vec3::new(2.0, 2.0, 0.5);
const PLATE: Vec3 = Vec3::new(1.4, 1.4, 0.1);
/// Distance between things before they are put at random places.
const APART: f32 = 2.5;

const RED: TaskThing = TaskThing::Block("Red", Rgb::RED);
const BLUE: TaskThing = TaskThing::Block("Blue", Rgb::BLUE);
const GREEN: TaskThing = TaskThing::Block("Green", Rgb::GREEN);
const YELLOW: TaskThing = TaskThing::Block("Yellow", Rgb::YELLOW);
const ANOTHER_RED: TaskThing = TaskThing::Block("AnotherRed", Rgb::RED);

/// The tasks, with 30 s for each step.
pub static JUDGED_TASKS: [JudgedTask; 9] = [
    JudgedTask {
        name: "stack",
        sentences: "Put the red block on the blue block.",
        other_words: &[
            "Lay the red block onto the blue block.",
            "Place the red cube on top of the blue cube.",
            "Set the red brick on the blue brick.",
        ],
        things: &[RED, BLUE],
        seconds: 30,
    },
    JudgedTask {
        name: "stack-among-others",
        sentences: "Put the red block on the blue block.",
        other_words: &[
            "Lay the red block onto the blue block.",
            "Place the red cube on top of the blue cube.",
            "Set the red brick on the blue brick.",
        ],
        things: &[RED, BLUE, GREEN, YELLOW],
        seconds: 30,
    },
    JudgedTask {
        name: "tower",
        sentences: "Put the red block on the blue block.\nPut the green block on the red block.",
        other_words: &[
            "Place the red cube on the blue cube. Place the green cube on the red cube.",
            "Set the red brick on the blue brick. Set the green brick on the red brick.",
        ],
        things: &[RED, BLUE, GREEN],
        seconds: 60,
    },
    JudgedTask {
        name: "take-down",
        sentences: "Put the red block on the table.",
        other_words: &[
            "Place the red cube on the table.",
            "Set the red brick on the table.",
        ],
        things: &[BLUE, TaskThing::Upper("Red", Rgb::RED)],
        seconds: 30,
    },
    JudgedTask {
        name: "other-tower",
        sentences: "Put the blue block on the green block.",
        other_words: &[
            "Place the blue cube on the green cube.",
            "Set the blue brick on top of the green brick.",
        ],
        things: &[BLUE, TaskThing::Upper("Red", Rgb::RED), GREEN],
        seconds: 60,
    },
    JudgedTask {
        name: "plate",
        sentences: "Put the green block on the plate.",
        other_words: &[
            "Place the green cube on the dish.",
            "Set the green brick on the plate.",
        ],
        things: &[GREEN, RED, TaskThing::Plate],
        seconds: 30,
    },
    JudgedTask {
        name: "beside",
        sentences: "Put the red block to the left of the blue block.",
        other_words: &[
            "Place the red cube to the left of the blue cube.",
            "Put the red brick left of the blue brick.",
        ],
        things: &[RED, BLUE],
        seconds: 30,
    },
    JudgedTask {
        name: "box",
        sentences: "Put the red block into the box.",
        other_words: &[
            "Place the red cube in the container.",
            "Drop the red block into the box.",
        ],
        things: &[RED, GREEN, TaskThing::Box],
        seconds: 30,
    },
    JudgedTask {
        name: "sort",
        sentences: "Put every red block into the box.",
        other_words: &[
            "Place all red cubes in the container.",
            "Put all the red bricks into the box.",
        ],
        things: &[RED, ANOTHER_RED, GREEN, TaskThing::Box],
        seconds: 60,
    },
];

impl JudgedTask {
    /// The task of this name.
    pub fn named(name: &str) -> Option<&'static Self> {
        JUDGED_TASKS.iter().find(|task| task.name == name)
    }

    /// What is to be done.
    ///
    /// # Errors
    /// Its sentences are none.
    pub fn program(&self) -> Result<TaskProgram, SentenceError> {
        self.sentences.parse()
    }

    /// What is to be done, in one line.
    pub fn words(&self) -> String {
        self.sentences.replace('\n', " ")
    }

    /// Its things in a row.
    pub(super) fn scene(&self) -> SceneSpec {
        let mut objects = Vec::<ObjectSpec>::new();
        let (mut at, mut top) = (Vec3::NEG_X * APART, 0.0);
        for thing in self.things {
            match thing {
                TaskThing::Upper(..) => {}
                TaskThing::Block(..) | TaskThing::Box | TaskThing::Plate => {
                    (at, top) = (at + Vec3::X * APART, 0.0);
                }
            }
            objects.push(match thing {
                TaskThing::Block(id, color) | TaskThing::Upper(id, color) => {
                    let pose = Pose::at(at.with_z(top + EDGE / 2.0));
                    top += EDGE;
                    let span = Vec3::splat(EDGE);
                    let color = *color;
                    ObjectSpec::new(*id, pose, MASS, Shape::Block { span, color })
                }
                TaskThing::Box => holder("Box", BOX, Rgb::GRAY, at),
                TaskThing::Plate => plate("Plate", PLATE, Rgb::WHITE, at),
            });
        }
        SceneSpec {
            table: TABLE,
            items: objects.into_iter().map(SceneItem::Object).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn names_are_different_and_sentences_are_sentences() {
        let names: BTreeSet<_> = JUDGED_TASKS.iter().map(|task| task.name).collect();
        assert_eq!(names.len(), JUDGED_TASKS.len());
        for task in &JUDGED_TASKS {
            let program = task.program().unwrap();
            assert_eq!(program.to_string(), task.sentences);
            assert!(task.other_words.len() > 1, "{}", task.name);
            for other in task.other_words {
                assert_ne!(*other, task.words());
                let told: TaskProgram = other.parse().unwrap();
                assert_eq!(told, program, "{other}");
            }
        }
    }
}
