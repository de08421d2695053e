//! Lessons: a true program, and the tables on which it is shown and tried.

use bevy::math::Vec3;
use tabletop_core::{ObjectSpec, Random};
use tabletop_geometry::PlacedSolid;
use tabletop_program::{SentenceError, TableScene, TaskProgram};

use crate::props::{PieceSpec, Prop, ring};

/// A program that is taught.
#[derive(Debug)]
pub struct BenchmarkLesson {
    /// The family of the program.
    pub family: &'static str,
    /// The program, in sentences.
    pub sentences: &'static str,
    pub(crate) props: &'static [Prop],
    /// What the objects are that it is about, and what is there beside them. Where some begin in their place, these are not all those of one look.
    pub(crate) pieces: &'static [PieceSpec],
    pub(crate) start: Start,
    /// The fewest objects with which it can be shown.
    pub(crate) least: usize,
}

/// Where pieces are at first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Start {
    Scattered,
    /// Those with even numbers are on or in the first prop.
    HalfThere,
    /// All are on or in the first prop, or on the table at random.
    SomeThere,
    /// Those with even numbers are at the left, each with a twin somewhere at the right.
    Twins,
    /// Rings around the first peg.
    Rings,
}

/// A wide table, and one that the head camera sees as a whole, in units.
pub(crate) const WIDE: (f32, f32) = (30.0, 18.0);
pub(crate) const SEEN: (f32, f32) = (20.0, 12.0);
/// Room around pieces, in units.
const CLEAR: f32 = 0.6;
/// How often a place is drawn before a table is given up.
const DRAWS: usize = 400;

impl BenchmarkLesson {
    /// The true program.
    ///
    /// # Errors
    /// Its sentences are none.
    pub fn program(&self) -> Result<TaskProgram, SentenceError> {
        self.sentences.parse()
    }

    /// A table of this size with so many pieces, if there is room.
    pub(crate) fn scene(
        &self,
        count: usize,
        table: (f32, f32),
        random: &mut Random,
    ) -> Option<TableScene> {
        let mut scene = TableScene::default();
        (scene.table.xspan, scene.table.yspan) = table;
        let mut taken = Vec::<(Vec3, f32)>::new();
        let mut first = Vec3::ZERO;
        for (number, prop) in self.props.iter().enumerate() {
            let at = place(random, table, &mut taken, prop.reach(), (-1.0, 1.0))?;
            let (objects, joints) = prop.objects(number, at, random.one_of([true, false]));
            scene.objects.extend(objects);
            scene.joints.extend(joints);
            if number == 0 {
                first = at;
            }
        }
        if self.start == Start::Rings {
            scene
                .objects
                .extend((0..count).map(|number| ring(number, first)));
            return Some(scene);
        }
        for number in 0..count {
            let kinds = self.pieces.len();
            // Each kind is there, and then any.
            let kind = match number < kinds {
                true => number,
                false => (random.bits() % kinds as u64) as usize,
            };
            let piece = self.pieces.get(kind)?;
            let is_even = number % 2 == 0;
            let is_there = match self.start {
                Start::HalfThere => is_even,
                Start::SomeThere => random.one_of([true, false]),
                Start::Scattered | Start::Twins | Start::Rings => false,
            };
            match self.start {
                Start::Twins => {
                    let model = place(random, table, &mut taken, 1.0, (-0.9, -0.15))?;
                    let twin = place(random, table, &mut taken, 1.0, (0.15, 0.9))?;
                    let mut twin = piece.object(number, twin);
                    twin.id = format!("Twin{}", twin.id);
                    scene.objects.extend([piece.object(number, model), twin]);
                }
                Start::Scattered | Start::HalfThere | Start::SomeThere | Start::Rings => {
                    let object = match is_there {
                        true => {
                            let spot = first + spot_within(number);
                            let mut object = piece.object(number, spot);
                            object.pose.location.z += floor(scene.objects.first()?);
                            object
                        }
                        false => piece
                            .object(number, place(random, table, &mut taken, 1.0, (-1.0, 1.0))?),
                    };
                    scene.objects.push(object);
                }
            }
        }
        shuffle(&mut scene.objects, random);
        Some(scene)
    }
}

/// The height on which things lie in or on a prop.
fn floor(prop: &ObjectSpec) -> f32 {
    let solids = prop.shape.colliding();
    let solids = solids.iter().map(|solid| PlacedSolid::of(solid, prop.pose));
    let tops = solids.map(|solid| solid.heights()[1]);
    tops.fold(f32::INFINITY, f32::min)
}

/// A place in a prop, by a piece's number.
fn spot_within(number: usize) -> Vec3 {
    let (column, row) = ((number / 2) % 3, (number / 2) / 3);
    Vec3::new(column as f32 * 1.25 - 1.25, 0.6 - row as f32 * 1.25, 0.0)
}

/// A free place on a part of the table, as shares of its width.
fn place(
    random: &mut Random,
    table: (f32, f32),
    taken: &mut Vec<(Vec3, f32)>,
    reach: f32,
    (low, high): (f32, f32),
) -> Option<Vec3> {
    let half = Vec3::new(table.0, table.1, 0.0) / 2.0 - reach;
    for _ in 0..DRAWS {
        let x = random.between((low * table.0 / 2.0, high * table.0 / 2.0));
        let y = random.between((-half.y, half.y));
        let at = Vec3::new(x.clamp(-half.x, half.x), y, 0.0);
        let is_free = |(other, its): &(Vec3, f32)| other.distance(at) > its + reach + CLEAR;
        if taken.iter().all(is_free) {
            taken.push((at, reach));
            return Some(at);
        }
    }
    None
}

/// Brings things into an order at random.
pub(crate) fn shuffle<T>(things: &mut [T], random: &mut Random) {
    for i in (1..things.len()).rev() {
        things.swap(i, (random.bits() % (i as u64 + 1)) as usize);
    }
}
