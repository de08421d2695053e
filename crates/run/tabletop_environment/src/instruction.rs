//! Instructions: programs of tasks in sentences, drawn for each episode, and how far the world is from what they say.

use std::path::Path;

use bevy::prelude::*;
use tabletop_core::{Hands, ObjectIndex, Random, Robot, SceneSpec};
use tabletop_geometry::Pose;
use tabletop_program::{ProgramRun, SentenceError, TableScene, TaskProgram};
use tabletop_scenario::{Check, Gap, Judge, Verdict, table_scene};
use tabletop_scene::{IdAllocator, assemble};

/// The table of all instructions.
pub(crate) const SETUP: &str = "shipped:tablesetup/instructions.xml";

/// What may be said of it. Each is a goal: once it is done, there is nothing left to do for it, however it was done.
pub(crate) const INSTRUCTIONS: [&str; 16] = [
    "Put every red block into the box.",
    "Put every green block into the box.",
    "Put every blue block into the box.",
    "Put every red block on the plate.",
    "Put any green block on the plate.",
    "Put two blocks into the box.",
    "Put three blocks into the box.",
    "Put the largest block into the box.",
    "Put the two smallest blocks on the plate.",
    "Put the largest red block on the smallest blue block.",
    "Put every block into the box until there are four blocks that are in the box.",
    "Put all red blocks on each other, the largest first.",
    "Put all green blocks on each other on the plate, the largest first.",
    "Put every green block on the left side of the table.",
    "Put every blue block on the right side of the table.",
    "Put the largest blue block on the plate, then put every red block into the box.",
];

/// What an instruction wants of the world.
#[derive(Clone, Debug)]
pub(crate) struct ToldGoal {
    /// The sentences.
    pub sentences: String,
    /// The program at the beginning of the episode.
    begun: ProgramRun,
    /// Ids of the objects, a verdict each.
    objects: Vec<String>,
    /// The poses of the objects when they were last looked at, and what that came to.
    seen: Option<(Vec<(String, Pose)>, Outlook)>,
}

/// What is left to do.
#[derive(Clone, Debug)]
struct Outlook {
    verdicts: Vec<Verdict>,
    /// Id of the object that is to be moved next.
    next: Option<String>,
}

impl ToldGoal {
    /// A sentence that can be done on a scene and is not done there, drawn at random. `None` if the one that was drawn is no such.
    pub fn draw(scene: &SceneSpec, random: &mut Random) -> Result<Option<Self>, SentenceError> {
        let sentences = random.one_of(INSTRUCTIONS);
        let program: TaskProgram = sentences.parse()?;
        let assembly = assemble(scene, &mut IdAllocator::default());
        let scene = TableScene {
            table: scene.table,
            objects: assembly.objects,
            joints: assembly.joints,
        };
        let begun = ProgramRun::begin(&program, &scene);
        let (steps, _, impossible) = begun.clone().rehearse(&scene);
        let goal = Self {
            sentences: program.to_string(),
            begun,
            objects: scene.objects.into_iter().map(|object| object.id).collect(),
            seen: None,
        };
        Ok((impossible.is_none() && !steps.is_empty()).then_some(goal))
    }

    /// The number of verdicts.
    pub const fn len(&self) -> usize {
        self.objects.len()
    }

    /// For each object where it is and where the program wants it, with the program's sentence if it is to be moved. The world is at the goal if
    /// nothing is left to do, everything is at rest and nothing is held.
    pub fn judge(&mut self, judge: &Judge, world: &mut World) -> Result<Vec<Verdict>> {
        let scene = table_scene(world)?;
        let poses: Vec<_> = scene
            .objects
            .iter()
            .map(|object| (object.id.clone(), object.pose))
            .collect();
        let outlook = match self.seen.take() {
            Some((seen, outlook)) if seen == poses => outlook,
            Some(_) | None => self.outlook(&scene),
        };
        let mut verdicts = outlook.verdicts.clone();
        self.seen = Some((poses, outlook));
        let moves = judge.judge(world, &[Check::AllAtRest])?;
        let moves = moves.into_iter().find_map(|verdict| verdict.failure);
        if let (Some(first), Some(failure)) = (verdicts.first_mut(), moves.or_else(|| held(world)))
        {
            first.failure.get_or_insert(failure);
        }
        Ok(verdicts)
    }

    /// Id of the object that is to be moved next.
    pub fn next(&self) -> Option<&str> {
        let (_, outlook) = self.seen.as_ref()?;
        outlook.next.as_deref()
    }

    fn outlook(&self, scene: &TableScene) -> Outlook {
        let (steps, after, impossible) = self.begun.clone().rehearse(scene);
        let place = |scene: &TableScene, id: &str| Some(scene.object(id)?.pose.location);
        let verdicts = self.objects.iter().map(|id| {
            let achieved = place(scene, id).unwrap_or_default();
            let desired = place(&after, id).unwrap_or(achieved);
            let step = steps.iter().find(|step| step.object == *id);
            Verdict {
                failure: step.map(|step| step.sentence(scene)),
                gap: Gap { achieved, desired },
            }
        });
        let mut verdicts: Vec<_> = verdicts.collect();
        if let (Some(first), Some(reason)) = (verdicts.first_mut(), impossible) {
            first.failure.get_or_insert(reason.to_string());
        }
        Outlook {
            verdicts,
            next: steps.into_iter().next().map(|step| step.object),
        }
    }
}

/// The failure that something is held, if it is.
fn held(world: &World) -> Option<String> {
    let (hands, robot) = (world.resource::<Hands>(), world.resource::<Robot>());
    let index = world.resource::<ObjectIndex>();
    let is_held = |entity: &Entity| {
        let mut limbs = robot.limbs.iter();
        hands.holder_of(*entity).is_some() || limbs.any(|limb| limb.holds.contains(entity))
    };
    index
        .iter()
        .any(|entity| is_held(&entity))
        .then(|| "expected everything to be let go".to_owned())
}

/// The path that errors name.
pub(crate) fn setup() -> &'static Path {
    Path::new(SETUP)
}

#[cfg(test)]
mod tests {
    use tabletop_sim::shipped::read_faultless_task;

    use super::*;

    #[test]
    fn what_was_done_is_a_goal_that_was_not_there_before() {
        let scene = read_faultless_task(setup(), &[]).unwrap();
        let assembly = assemble(&scene, &mut IdAllocator::default());
        let table = TableScene {
            table: scene.table,
            objects: assembly.objects,
            joints: assembly.joints,
        };
        for sentences in INSTRUCTIONS {
            let program: TaskProgram = sentences.parse().unwrap();
            assert_eq!(program.to_string(), sentences, "it is said otherwise");
            let begun = ProgramRun::begin(&program, &table);
            let (steps, after, impossible) = begun.clone().rehearse(&table);
            assert_eq!(impossible, None, "{sentences}");
            assert!(!steps.is_empty(), "{sentences}: there is nothing to do");
            let (steps, _, impossible) = begun.rehearse(&after);
            assert_eq!((steps, impossible), (Vec::new(), None), "{sentences}");
        }
    }

    #[test]
    fn a_seed_decides_what_is_said() {
        let scene = read_faultless_task(setup(), &[]).unwrap();
        let said = |seed| {
            let goal = ToldGoal::draw(&scene, &mut Random::new(seed)).unwrap();
            goal.map(|goal| goal.sentences)
        };
        let all: std::collections::BTreeSet<_> = (0..200).map(said).collect();
        assert_eq!(all.len(), INSTRUCTIONS.len());
        assert_eq!(said(7), said(7));
    }
}
