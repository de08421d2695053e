//! What is understood of lessons.

use std::cmp::Reverse;

use tabletop_core::Random;
use tabletop_program::{Example, Meaning, SentenceError, TableScene, TaskProgram};
use tabletop_task::{Demonstration, Task};

use crate::{
    lesson::{BenchmarkLesson, SEEN, WIDE},
    pictures::{is_in_view, watched},
    showing::shown,
};

/// How a learner comes to know demonstrations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Teacher {
    /// It is told where everything is.
    Telling,
    /// It sees pictures of the head camera, and knows what the objects are.
    Showing,
}

impl Teacher {
    /// The size of the table of demonstrations, in units.
    const fn table(self) -> (f32, f32) {
        match self {
            Self::Telling => WIDE,
            Self::Showing => SEEN,
        }
    }

    /// True if the learner can come to know all of a demonstration.
    fn can_show(self, shown: &Demonstration) -> bool {
        match self {
            Self::Telling => true,
            Self::Showing => is_in_view(shown),
        }
    }

    fn example(self, shown: &Demonstration) -> Option<Example> {
        match self {
            Self::Telling => told(shown),
            Self::Showing => told(&watched(shown)?),
        }
    }
}

fn told(shown: &Demonstration) -> Option<Example> {
    Example::of(shown, &Task::of(shown))
}

/// What was understood of a lesson after each demonstration.
#[derive(Clone, Debug)]
pub struct Score {
    /// The lesson.
    pub lesson: &'static BenchmarkLesson,
    /// What was understood after one, two and three demonstrations.
    pub results: Vec<TeachingResult>,
}

/// What was understood after some demonstrations.
#[derive(Clone, Debug)]
pub struct TeachingResult {
    /// The program that was found, in sentences.
    pub found: String,
    /// True if it does the same as the true one on all other tables.
    pub is_right: bool,
    /// True if one of the programs that were named beside it does.
    pub is_named: bool,
    /// The number of those.
    pub alternatives: usize,
}

/// The most demonstrations of a lesson.
const DEMONSTRATIONS: usize = 3;
/// The numbers of objects in demonstrations and in trials.
const SHOWN: [usize; 3] = [4, 3, 5];
const TRIED: (usize, usize) = (2, 9);
/// The teacher chooses the first table from so many, and later ones, which are to correct what was understood, from more.
const CHOSEN_FROM: usize = 6;
const CORRECTED_ON: usize = 12;
/// How often a table is drawn on which the program can be done.
const DRAWS: usize = 240;

impl Score {
    /// Teaches a lesson in this way, and tries what is understood on so many other tables.
    ///
    /// # Errors
    /// The lesson's program is none.
    pub fn of(
        lesson: &'static BenchmarkLesson,
        teacher: Teacher,
        seed: u64,
        tables: usize,
    ) -> Result<Self, SentenceError> {
        let program = lesson.program()?;
        let mut random = Random::new(seed);
        let tried = lesson.tables(&program, tables, &mut random);
        let mut examples = Vec::<Example>::new();
        let mut results = Vec::new();
        let mut understood = None;
        for number in 0..DEMONSTRATIONS {
            let count = SHOWN[number % SHOWN.len()];
            let before = understood.as_ref();
            let example = lesson.example(teacher, &program, count, before, &mut random);
            examples.extend(example);
            let meaning = Meaning::of(&examples);
            let is_same = |other: &TaskProgram| {
                let mut tables = tried.iter();
                !tried.is_empty() && tables.all(|scene| other.acts_like(&program, scene))
            };
            let found = meaning.program.as_ref();
            results.push(TeachingResult {
                found: found.map_or(String::new(), ToString::to_string),
                is_right: found.is_some_and(is_same),
                is_named: meaning
                    .alternatives
                    .iter()
                    .any(|other| is_same(&other.program)),
                alternatives: meaning.alternatives.len(),
            });
            understood = meaning.program;
        }
        Ok(Self { lesson, results })
    }
}

impl BenchmarkLesson {
    /// A demonstration with so many objects, or a few more if there would be too little to do: on a table on which what has been understood
    /// would do something else, if there is one, and else on the one on which there is most to do.
    fn example(
        &self,
        teacher: Teacher,
        program: &TaskProgram,
        count: usize,
        understood: Option<&TaskProgram>,
        random: &mut Random,
    ) -> Option<Example> {
        let mut others = Vec::new();
        let mut left = match understood {
            Some(_) => CORRECTED_ON,
            None => CHOSEN_FROM,
        };
        for draw in 0..DRAWS {
            let more = draw / (DRAWS / 4);
            let scene = self.scene(count.max(self.least) + more, teacher.table(), random);
            let shown = scene.and_then(|scene| Some((shown(program, &scene, random)?, scene)));
            let Some((shown, scene)) = shown.filter(|(shown, _)| teacher.can_show(shown)) else {
                continue;
            };
            let Some(steps) = told(&shown).map(|example| example.steps()) else {
                continue;
            };
            if understood.is_some_and(|it| !it.acts_like(program, &scene)) {
                let correction = teacher.example(&shown);
                if correction.is_some() {
                    return correction;
                }
            } else {
                others.push((Reverse(steps), shown));
            }
            left -= 1;
            if left == 0 {
                break;
            }
        }
        others.sort_by_key(|(steps, _)| *steps);
        others.iter().find_map(|(_, shown)| teacher.example(shown))
    }

    /// Other tables on which the program can be done.
    fn tables(&self, program: &TaskProgram, count: usize, random: &mut Random) -> Vec<TableScene> {
        let (least, most) = TRIED;
        let least = least.max(self.least);
        let numbers = (0..count).map(|i| least + i % (most - least + 1));
        let tables = numbers.filter_map(|number| {
            let mut draws = (0..DRAWS).filter_map(|_| self.scene(number, WIDE, random));
            draws.find(|scene| Example::of_program(program, scene).is_ok())
        });
        tables.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::LESSONS;

    /// What a program does is known as its work: else no teacher could ever be understood.
    #[test]
    fn each_program_explains_what_it_does() {
        for lesson in &LESSONS {
            let program = lesson.program().unwrap();
            let tables = lesson.tables(&program, 2, &mut Random::new(7));
            assert!(!tables.is_empty(), "{}", lesson.sentences);
            for scene in tables {
                assert!(program.acts_like(&program, &scene), "{}", lesson.sentences);
            }
        }
    }
}
