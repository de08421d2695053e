//! A step of a program, done by a hand tick by tick: up, across, down.

use std::{
    collections::BTreeSet,
    f32::consts::{PI, TAU},
};

use bevy::math::Vec3;
use tabletop_core::{Hand, HandCommand};
use tabletop_geometry::{PlacedSolid, Pose};
use tabletop_task::{Arrangement, Relation, angle_between};

use crate::{
    scene::{TableScene, solids_at},
    step::ConcreteStep,
};

/// How far the hand goes in a tick, in units, and how far it turns, in rad.
const PACE: (f32, f32) = (0.15, 0.08);
/// Room above everything on the way across, in units.
const CLEAR: f32 = 0.3;
/// Number of ticks that a hand takes to grasp.
const PAUSE: u32 = 15;
/// Number of ticks without motion after which the object has arrived, the most that a hand waits for that, and the largest motion in a tick, in units,
/// that is none.
const STILL: u32 = 4;
const MOST_WAITING: u32 = 90;
const SAME: f32 = 1e-3;

/// A step that a hand does.
#[derive(Clone, Debug)]
pub struct HandStep {
    object: String,
    hand: Hand,
    /// The poses of the object, one after each tick, from its first one on.
    way: Vec<Pose>,
    /// True if the object is to be removed.
    destroys: bool,
    phase: HandPhase,
}

/// The object of a step as it is before a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HandledObject {
    /// Where it is; `None` if it is not there.
    pub location: Option<Vec3>,
    /// True if the hand holds it.
    pub is_held: bool,
}

/// What the hand does in a tick.
#[derive(Clone, Debug, PartialEq)]
pub enum HandProgress {
    /// It gives these commands, and goes on in the next tick.
    GoesOn(Vec<HandCommand>),
    /// The step is over.
    Over(Result<(), HandFailure>),
}

/// The reason why a hand could not do a step.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum HandFailure {
    /// The object is missing.
    #[error("{0} is no longer there")]
    Gone(String),
    /// The hand does not hold the object, or holds it no longer.
    #[error("the hand does not hold {0}")]
    NotHeld(String),
}

#[derive(Clone, Debug)]
enum HandPhase {
    Beginning,
    Grasping {
        left: u32,
    },
    /// Towards the pose of this number.
    Moving(usize),
    Arriving {
        last: Option<Vec3>,
        still: u32,
        ticks: u32,
    },
    Ended(Result<(), HandFailure>),
}

impl HandStep {
    /// A step that this hand is to do on a table.
    pub fn begin(scene: &TableScene, step: &ConcreteStep, hand: Hand) -> Self {
        let id = step.object.as_str();
        let object = scene.object(id);
        let way = object.and_then(|object| {
            let (here, goal) = (object.pose, step.pose?);
            let corners = match matches!(step.relation, Relation::Slid { .. }) {
                true => vec![goal],
                false => over(scene, id, here, goal),
            };
            let mut way = vec![here];
            for corner in corners {
                let last = way.last().copied().unwrap_or(here);
                way.extend(between(last, corner));
            }
            Some(way)
        });
        Self {
            object: id.to_owned(),
            hand,
            way: way.unwrap_or_default(),
            destroys: step.pose.is_none(),
            phase: match object {
                Some(_) => HandPhase::Beginning,
                None => HandPhase::Ended(Err(HandFailure::Gone(id.to_owned()))),
            },
        }
    }

    /// Id of its object.
    pub fn object(&self) -> &str {
        &self.object
    }

    /// What the hand does in the tick that begins.
    pub fn tick(&mut self, now: HandledObject) -> HandProgress {
        let hand = self.hand;
        let commands = match &mut self.phase {
            HandPhase::Beginning => {
                self.phase = HandPhase::Grasping { left: PAUSE - 1 };
                let object = self.object.clone();
                vec![HandCommand::Grasp { hand, object }]
            }
            HandPhase::Grasping { left: left @ 1.. } => {
                *left -= 1;
                Vec::new()
            }
            HandPhase::Grasping { left: 0 } if !now.is_held => {
                return HandProgress::Over(Err(self.not_held()));
            }
            HandPhase::Grasping { left: 0 } if self.destroys => {
                self.phase = HandPhase::Ended(Ok(()));
                vec![HandCommand::Destroy(hand)]
            }
            HandPhase::Grasping { left: 0 } => self.go(1, now),
            HandPhase::Moving(next) => {
                let next = *next;
                self.go(next, now)
            }
            HandPhase::Arriving { last, still, ticks } => {
                let is_same = last
                    .zip(now.location)
                    .is_none_or(|(last, here)| last.distance(here) < SAME);
                *still = if is_same { *still + 1 } else { 0 };
                *last = now.location;
                *ticks += 1;
                match *still >= STILL || *ticks >= MOST_WAITING {
                    false => Vec::new(),
                    true => {
                        let done = now.is_held.then_some(()).ok_or_else(|| self.not_held());
                        self.phase = HandPhase::Ended(done);
                        vec![HandCommand::Release(hand)]
                    }
                }
            }
            HandPhase::Ended(done) => return HandProgress::Over(done.clone()),
        };
        HandProgress::GoesOn(commands)
    }

    fn not_held(&self) -> HandFailure {
        HandFailure::NotHeld(self.object.clone())
    }

    /// The commands that lead to the pose of this number. None after the last one: from then on it waits.
    fn go(&mut self, number: usize, now: HandledObject) -> Vec<HandCommand> {
        match self.way.get(number - 1..=number) {
            Some([from, to]) => {
                self.phase = HandPhase::Moving(number + 1);
                commands(self.hand, *from, *to)
            }
            Some(_) | None => {
                self.phase = HandPhase::Arriving {
                    last: now.location,
                    still: 0,
                    ticks: 0,
                };
                Vec::new()
            }
        }
    }
}

/// The corners of the way from one pose to another, over everything else.
fn over(scene: &TableScene, id: &str, from: Pose, to: Pose) -> Vec<Pose> {
    let placed = scene.objects.iter();
    let arrangement =
        Arrangement::new(placed.map(|object| (object.id.as_str(), &object.shape, object.pose)));
    let on = stack_above(&arrangement, id);
    let is_carried = |other: &str| {
        other == id || on.contains(other) || arrangement.containers(other).contains(&id)
    };
    let solids_of = |carried: bool| {
        let objects = scene.objects.iter();
        let objects = objects.filter(move |other| is_carried(&other.id) == carried);
        let solids: Vec<PlacedSolid> = objects
            .flat_map(|object| solids_at(object, object.pose))
            .collect();
        solids
    };
    let heights = |carried: bool| solids_of(carried).into_iter().map(|solid| solid.heights());
    let highest = heights(false).map(|[_, top]| top).fold(0.0, f32::max);
    let lowest = heights(true)
        .map(|[bottom, _]| bottom)
        .fold(f32::INFINITY, f32::min);
    // Where it hangs below its origin, turned or not.
    let below = (from.location.z - lowest).max(0.0);
    let height = (highest + below + CLEAR).max(from.location.z);
    let above = |pose: Pose| {
        let location = pose.location.with_z(height.max(pose.location.z));
        Pose::new(location, pose.rotation)
    };
    vec![above(from), above(to), to]
}

/// The objects that stand on an object, directly or on each other.
fn stack_above<'a>(arrangement: &'a Arrangement, id: &str) -> BTreeSet<&'a str> {
    let mut found = BTreeSet::new();
    let mut unvisited = arrangement.standing_on(id);
    while let Some(above) = unvisited.pop() {
        if found.insert(above) {
            unvisited.extend(arrangement.standing_on(above));
        }
    }
    found
}

/// The poses after one on an even way to another, in steps of a tick.
fn between(from: Pose, to: Pose) -> impl Iterator<Item = Pose> {
    let length = from.location.distance(to.location) / PACE.0;
    let turn = angle_between(from.rotation, to.rotation) / PACE.1;
    let steps = length.max(turn).ceil().max(1.0) as u32;
    (1..=steps).map(move |step| {
        let part = step as f32 / steps as f32;
        match step == steps {
            true => to,
            false => Pose::new(
                from.location.lerp(to.location, part),
                from.rotation.slerp(to.rotation, part).normalize(),
            ),
        }
    })
}

/// The commands that bring what a hand holds from one pose to the next.
fn commands(hand: Hand, from: Pose, to: Pose) -> Vec<HandCommand> {
    let (axis, angle) = (to.rotation * from.rotation.inverse()).to_axis_angle();
    let angle = (angle + PI).rem_euclid(TAU) - PI;
    let degrees = angle.to_degrees();
    let turns = (angle.abs() > 1e-4).then_some(HandCommand::Turn {
        hand,
        axis,
        degrees,
    });
    let location = to.location;
    let moves = (from.location != location).then_some(HandCommand::MoveTo { hand, location });
    turns.into_iter().chain(moves).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::program::TaskProgram;

    /// A table with a red block on it, and its step to the right.
    fn step() -> (TableScene, ConcreteStep) {
        let shape = tabletop_core::Shape::Block {
            span: Vec3::ONE,
            color: tabletop_geometry::Rgb::RED,
        };
        let block = tabletop_core::ObjectSpec::new("Red", Pose::at(Vec3::Z * 0.5), 1.0, shape);
        let scene = TableScene {
            objects: vec![block],
            ..TableScene::default()
        };
        let program: TaskProgram = "Put the red block on the table at (3, 0).".parse().unwrap();
        let (mut steps, ..) = crate::ProgramRun::rehearsed(&program, &scene);
        (scene, steps.remove(0))
    }

    /// The commands of a step whose object is held or not, and follows the hand at once; and how it ended.
    fn done(is_held: bool) -> (Vec<HandCommand>, Result<(), HandFailure>) {
        let (scene, step) = step();
        let mut hand = HandStep::begin(&scene, &step, Hand::Left);
        let (mut given, mut at) = (Vec::new(), Vec3::Z * 0.5);
        loop {
            match hand.tick(HandledObject {
                location: Some(at),
                is_held,
            }) {
                HandProgress::Over(done) => return (given, done),
                HandProgress::GoesOn(commands) => {
                    if let Some(HandCommand::MoveTo { location, .. }) = commands.last() {
                        at = *location;
                    }
                    given.extend(commands);
                }
            }
        }
    }

    #[test]
    fn a_hand_goes_up_across_and_down() {
        let (given, done) = done(true);
        assert_eq!(done, Ok(()));
        assert!(matches!(
            given[0],
            HandCommand::Grasp {
                hand: Hand::Left,
                ..
            }
        ));
        assert_eq!(given.last(), Some(&HandCommand::Release(Hand::Left)));
        let way: Vec<_> = given
            .iter()
            .filter_map(|command| match command {
                HandCommand::MoveTo { location, .. } => Some(*location),
                HandCommand::Select(_)
                | HandCommand::Grasp { .. }
                | HandCommand::MoveBy { .. }
                | HandCommand::Turn { .. }
                | HandCommand::Release(_)
                | HandCommand::Destroy(_) => None,
            })
            .collect();
        let top = way.iter().map(|at| at.z).fold(0.0, f32::max);
        assert!(top >= 0.5 + CLEAR, "{top}");
        assert!(
            way.windows(2)
                .all(|pair| pair[0].distance(pair[1]) <= PACE.0 + 1e-4)
        );
        let last = way.last().unwrap();
        assert!(last.distance(Vec3::new(3.0, 0.0, 0.5)) < 0.1, "{last}");
    }

    #[test]
    fn what_is_not_held_is_a_failure() {
        let (given, done) = done(false);
        assert_eq!(given.len(), 1);
        assert_eq!(done, Err(HandFailure::NotHeld("Red".into())));
        let (scene, mut step) = step();
        step.object = "Blue".into();
        let mut hand = HandStep::begin(&scene, &step, Hand::Any);
        let gone = HandProgress::Over(Err(HandFailure::Gone("Blue".into())));
        assert_eq!(hand.tick(HandledObject::default()), gone);
    }
}
