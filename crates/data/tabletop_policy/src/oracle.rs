//! The oracle: a policy that is told what a task says and where everything is, and decides by the program of the task what is to be put where.

use bevy::math::Vec3;
use tabletop_core::ObjectSpec;
use tabletop_geometry::Pose;
use tabletop_program::{ConcreteStep, NextStep, ProgramRun, TableScene, TaskProgram};
use tabletop_task::{Relation, Symmetry};
use tabletop_wire::{MappedActions, NumpyArray, Served, WireMap, WireValue};

use crate::{
    heading::heading,
    known_table::KnownTable,
    place_numbers::{action_metadata, numbers_of},
    policy::{Decision, ObjectPlace},
};

/// The keys of an observation: those of `assets/policies/oracle.ron`.
const OBJECTS: &str = "objects";
const PROMPT: &str = "prompt";

/// Distances from the middle of a container, in units, at which fingers find room, the first that is free.
const ASIDE: [f32; 3] = [0.0, 0.45, -0.45];
/// The distance, in units, of origins in a container from which on both have room.
const APART: f32 = 0.6;

/// A policy that is told all there is to know, and decides by the task's sentences (`docs/policies.md`).
#[derive(Clone, Copy, Debug, Default)]
pub struct OraclePolicy;

impl Served for OraclePolicy {
    fn metadata(&self) -> WireMap {
        let texts = [OBJECTS, PROMPT].map(|key| {
            let dtype = [("dtype".to_owned(), "text".into())];
            (key.to_owned(), WireMap::from(dtype).into())
        });
        WireMap::from(
            [
                ("server", WireValue::from("tabletop")),
                ("observation", WireMap::from(texts).into()),
                ("action", action_metadata().into()),
                ("rate", WireValue::Nil),
                ("horizon", WireValue::Integer(1)),
            ]
            .map(|(key, value)| (key.to_owned(), value)),
        )
    }

    fn answer(&self, observation: &WireMap) -> Result<WireMap, String> {
        let table = KnownTable::read(text(observation, OBJECTS)?);
        let table = table.map_err(|fault| format!("{OBJECTS:?}: {fault}"))?;
        let program: Result<TaskProgram, _> = text(observation, PROMPT)?.parse();
        let program = program.map_err(|fault| format!("{PROMPT:?}: {fault}"))?;
        let [first, now] = table.scenes();
        let decision = match ProgramRun::begin(&program, &first).next_on(&now) {
            // What cannot be done is not begun.
            NextStep::Done | NextStep::Impossible(_) => Decision::Done,
            NextStep::Step(step) => decided(&step, &now)?,
        };
        let numbers = numbers_of(&decision);
        let actions = NumpyArray::of_floats(&[1, MappedActions::OF_PLACES], &numbers);
        Ok(WireMap::from([("actions".to_owned(), actions.into())]))
    }
}

fn text<'o>(observation: &'o WireMap, key: &str) -> Result<&'o str, String> {
    match observation.get(key) {
        Some(WireValue::Text(text)) => Ok(text),
        Some(other) => Err(format!("{key:?}: {}, expected a text", other.kind())),
        None => {
            let keys: Vec<_> = observation.keys().take(20).collect();
            Err(format!("{key:?} is missing; there are only {keys:?}"))
        }
    }
}

/// A step as a move.
fn decided(step: &ConcreteStep, table: &TableScene) -> Result<Decision, String> {
    let no_move = || format!("{} That is no move.", step.sentence(table));
    let object = table.object(&step.object).ok_or_else(no_move)?;
    let pose = step.pose.ok_or_else(no_move)?;
    let pose = match &step.relation {
        Relation::Inside { object: container } => {
            let container = table.object(container).ok_or_else(no_move)?;
            inside(object, pose, container, table)
        }
        Relation::On { .. }
        | Relation::OnTable
        | Relation::Around { .. }
        | Relation::Against { .. }
        | Relation::Beside { .. }
        | Relation::AlignedWith { .. }
        | Relation::InPlaceOf { .. }
        | Relation::Aside => pose,
        Relation::Slid { .. }
        | Relation::Turned { .. }
        | Relation::LetGo
        | Relation::Destroyed
        | Relation::Held => return Err(no_move()),
    };
    let symmetry = Symmetry::of(&object.shape);
    let place = |pose: Pose| ObjectPlace {
        location: pose.location,
        yaw: heading(&symmetry, pose).yaw(),
    };
    Ok(Decision::Move {
        pick: place(object.pose),
        place: place(pose),
    })
}

/// The pose in a container, as near to its middle as there is room, with its sides along the walls.
fn inside(object: &ObjectSpec, pose: Pose, container: &ObjectSpec, table: &TableScene) -> Pose {
    let spots = ASIDE
        .iter()
        .flat_map(|x| ASIDE.map(|y| Vec3::new(*x, y, 0.0)));
    let spots = spots.map(|spot| (container.pose * spot).with_z(pose.location.z));
    let others = table.objects.iter();
    let others = others.filter(|other| ![&object.id, &container.id].contains(&&other.id));
    let others: Vec<_> = others.map(|other| other.pose.location).collect();
    let is_free = |spot: &Vec3| others.iter().all(|other| other.distance(*spot) > APART);
    let location = spots.clone().find(is_free).unwrap_or(pose.location);
    Pose::new(location, container.pose.rotation)
}

#[cfg(test)]
mod tests {
    use tabletop_controller::{SeenObject, Sight};
    use tabletop_core::Shape;
    use tabletop_geometry::Rgb;

    use super::*;
    use crate::{known_table::ToldTask, place_numbers::decision_of};

    fn block(id: &str, color: Rgb, x: f32) -> ObjectSpec {
        let span = Vec3::splat(0.4);
        let pose = Pose::at(Vec3::new(x, 0.0, 0.2));
        ObjectSpec::new(id, pose, 0.1, Shape::Block { span, color })
    }

    /// The answer to a task with these objects, of which the first has been put elsewhere.
    fn answer(
        words: &str,
        objects: &[ObjectSpec],
        first: Option<Vec3>,
    ) -> Result<Decision, String> {
        let seen = objects.iter().map(|object| {
            let (shape, pose, is_fixed) = (object.shape.clone(), object.pose, false);
            let seen = SeenObject {
                shape,
                pose,
                is_fixed,
            };
            (object.id.clone(), seen)
        });
        let mut sight = Sight {
            objects: seen.collect(),
            ..Sight::default()
        };
        if let (Some(at), Some(seen)) = (first, sight.objects.get_mut(&objects[0].id)) {
            seen.pose.location = at;
        }
        let told = ToldTask { words, objects };
        let table = KnownTable::new(&told, &sight).text();
        let observation = [(OBJECTS, table.as_str().into()), (PROMPT, words.into())];
        let observation = observation.map(|(key, text)| (key.to_owned(), text));
        let answer = OraclePolicy.answer(&observation.into())?;
        let numbers: Vec<_> = answer["actions"].array().unwrap().numbers().collect();
        Ok(decision_of(&numbers))
    }

    #[test]
    fn it_decides_what_the_sentence_says() {
        let objects = [block("Red", Rgb::RED, 1.0), block("Blue", Rgb::BLUE, -2.0)];
        let words = "Put the red block on the blue block.";
        let Ok(Decision::Move { pick, place }) = answer(words, &objects, None) else {
            panic!("it is to be put");
        };
        assert_eq!(pick.location, Vec3::new(1.0, 0.0, 0.2));
        assert!(place.location.distance(Vec3::new(-2.0, 0.0, 0.6)) < 1e-3);
        assert_eq!(pick.yaw.unwrap().fold, 4);
        let there = Some(Vec3::new(-2.0, 0.0, 0.6));
        assert_eq!(answer(words, &objects, there), Ok(Decision::Done));
        // What cannot be done is over.
        let words = "Put the green block on the blue block.";
        assert_eq!(answer(words, &objects, None), Ok(Decision::Done));
        let refusal = answer("Remove the red block.", &objects, None).unwrap_err();
        assert_eq!(refusal, "Remove the red block. That is no move.");
    }

    #[test]
    fn a_second_block_in_a_box_has_room_beside_the_first() {
        let walls = Shape::Box {
            span: Vec3::new(2.0, 2.0, 0.5),
            thickness: 0.1,
            color: Rgb::GRAY,
        };
        let pose = Pose::from_degrees(Vec3::new(4.0, 0.0, 0.25), Vec3::Z * 30.0);
        let objects = [
            block("Red", Rgb::RED, 1.0),
            block("Blue", Rgb::BLUE, -2.0),
            ObjectSpec::new("Box", pose, 1.0, walls),
        ];
        let words = "Put every block into the box.";
        let Ok(Decision::Move { place, .. }) = answer(words, &objects, None) else {
            panic!("the first is to be put");
        };
        let middle = Vec3::new(4.0, 0.0, 0.3);
        assert!(place.location.distance(middle) < 1e-3, "{place:?}");
        let Ok(Decision::Move { place, .. }) = answer(words, &objects, Some(middle)) else {
            panic!("the second is to be put");
        };
        let off = place.location.distance(middle);
        assert!((0.6..0.7).contains(&off), "{place:?}");
    }

    #[test]
    fn nonsense_is_refused_with_its_place() {
        let objects = [block("Red", Rgb::RED, 1.0)];
        let refused = |observation: &[(&str, &str)], fault: &str| {
            let observation = observation.iter();
            let observation: WireMap = observation
                .map(|(key, text)| ((*key).to_owned(), (*text).into()))
                .collect();
            let refusal = OraclePolicy.answer(&observation).unwrap_err();
            assert!(refusal.contains(fault), "{refusal}");
        };
        refused(&[], "\"objects\" is missing");
        refused(&[(OBJECTS, "{")], "\"objects\": EOF");
        let told = ToldTask {
            words: "",
            objects: &objects,
        };
        let table = KnownTable::new(&told, &Sight::default()).text();
        refused(&[(OBJECTS, &table)], "\"prompt\" is missing");
        refused(&[(OBJECTS, &table), (PROMPT, "Dance.")], "\"prompt\": ");
        let huge = table.replacen("0.4", "1e30", 1);
        assert_ne!(huge, table);
        refused(&[(OBJECTS, &huge)], "\"objects\": \"Red\": ");
    }
}
