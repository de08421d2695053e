//! Steps of a program on a table.

use std::collections::BTreeMap;

use bevy::math::Vec3;
use tabletop_core::{ObjectSpec, SimTick};
use tabletop_geometry::Pose;
use tabletop_task::{
    Binding, Freedom, Goal, PlaceRange, Reference, Relation, Role, Symmetry, Task, TaskStep,
};

use crate::{
    instruction::{Instruction, TargetPlace},
    look::{color_of, is_called},
    noun::{HowMany, Noun, ObjectKind, Preposition, Spot},
    program::Sentence,
    scene::TableScene,
    words::KINDS,
};

/// A step of a program on a table: one object, and where it is to be.
#[derive(Clone, Debug, PartialEq)]
pub struct ConcreteStep {
    /// Id of the object.
    pub object: String,
    /// The relation that the step establishes.
    pub relation: Relation,
    /// The pose to which it brings the object; `None` if that is removed.
    pub pose: Option<Pose>,
}

impl ConcreteStep {
    /// It as a sentence, which is a program of its own.
    pub fn sentence(&self, scene: &TableScene) -> String {
        let what = named(scene, &self.object);
        let put = |to| Instruction::Put {
            what: what.clone(),
            to,
            first: None,
        };
        let at = |preposition, other: &str| {
            put(TargetPlace::Spot(Spot::at(
                preposition,
                named(scene, other),
            )))
        };
        let instruction = match &self.relation {
            Relation::On { object } => at(Preposition::On, object),
            Relation::Inside { object } => at(Preposition::Inside, object),
            Relation::Around { object } => at(Preposition::Around, object),
            Relation::Beside { object, side } => at(Preposition::Beside(*side), object),
            Relation::Aside => put(TargetPlace::Aside),
            Relation::InPlaceOf { object } => put(TargetPlace::PlaceOf {
                noun: named(scene, object),
            }),
            Relation::Slid {
                object, opening, ..
            } => {
                let what = named(scene, object);
                match *opening > 0.0 {
                    true => Instruction::Open { what },
                    false => Instruction::Close { what },
                }
            }
            Relation::Destroyed => Instruction::Remove { what, first: None },
            Relation::OnTable
            | Relation::Against { .. }
            | Relation::AlignedWith { .. }
            | Relation::Turned { .. }
            | Relation::LetGo
            | Relation::Held => {
                let at = self.pose.map_or(Vec3::ZERO, |pose| pose.location);
                let short = |x: f32| (x * 10.0).round() / 10.0 + 0.0;
                let (x, y) = (short(at.x), short(at.y));
                put(TargetPlace::Location { x, y })
            }
        };
        let instructions = vec![instruction];
        Sentence::Do { instructions }.to_string()
    }

    /// The task of doing it, and the objects of its roles.
    pub fn task(&self, scene: &TableScene) -> (Task, Binding) {
        let relations = self.task_relations(scene);
        let others = relations.iter().filter_map(Relation::object);
        let ids: Vec<_> = [self.object.as_str()].into_iter().chain(others).collect();
        let roles = ids.iter().filter_map(|id| {
            let shown = scene.object(id)?.clone();
            let noun = named(scene, id).to_string();
            let symmetry = Symmetry::of(&shown.shape);
            Some(Role {
                id: (*id).to_owned(),
                noun,
                shown,
                symmetry,
            })
        });
        let step = TaskStep {
            number: 1,
            sentence: self.sentence(scene),
            object: self.object.clone(),
            hands: Vec::new(),
            grasp: SimTick(0),
            release: SimTick(0),
            meanwhile: false,
            relations: relations.clone(),
            goal: self.goal(scene),
            tipping: None,
            load: Vec::new(),
            spilled: None,
            after: Vec::new(),
        };
        let task = Task {
            roles: roles.collect(),
            joints: scene.joints.clone(),
            steps: vec![step],
            ..Task::without_steps(scene.table)
        };
        let same: BTreeMap<_, _> = ids
            .iter()
            .map(|id| ((*id).to_owned(), (*id).to_owned()))
            .collect();
        (task, Binding(same))
    }

    /// The relations that a task of this step alone has. What is put aside goes to a place that later steps leave free, of which such a task knows nothing; what is
    /// put around a post rests on what is around that already.
    fn task_relations(&self, scene: &TableScene) -> Vec<Relation> {
        let mut relations = vec![match self.relation == Relation::Aside {
            true => Relation::OnTable,
            false => self.relation.clone(),
        }];
        if let Relation::Around { object: post } = &self.relation {
            let below = self.support(scene).filter(|below| below != post);
            relations.extend(below.map(|object| Relation::On { object }));
        }
        relations
    }

    /// The object on which its object is to rest.
    fn support(&self, scene: &TableScene) -> Option<String> {
        let after = scene.after(self);
        let view = after.view();
        view.standing.support(&self.object).map(str::to_owned)
    }

    fn goal(&self, scene: &TableScene) -> Option<Goal> {
        let (mut pose, object) = (self.pose?, scene.object(&self.object)?);
        let (reference, place) = match &self.relation {
            Relation::Inside { object } => {
                let object = object.clone();
                (Reference::Object { object }, PlaceRange::Inside)
            }
            Relation::Aside
            | Relation::OnTable
            | Relation::On { .. }
            | Relation::Around { .. }
            | Relation::Against { .. }
            | Relation::Beside { .. }
            | Relation::AlignedWith { .. }
            | Relation::InPlaceOf { .. }
            | Relation::Slid { .. }
            | Relation::Turned { .. }
            | Relation::LetGo
            | Relation::Destroyed
            | Relation::Held => (Reference::Table, PlaceRange::Exact),
        };
        let frame = match &reference {
            Reference::Object { object } => {
                // Anywhere in it will do: hands need room around the middle, not in a corner.
                let whole = scene.object(object)?.pose;
                pose.location = whole.location.with_z(pose.location.z);
                whole
            }
            Reference::Table | Reference::PlaceOf { .. } | Reference::Itself => Pose::IDENTITY,
        };
        Some(Goal {
            reference,
            pose: frame.inverse() * pose,
            up: frame.rotation.inverse() * Vec3::Z,
            freedom: Freedom::from(&Symmetry::of(&object.shape)),
            place,
        })
    }
}

impl TableScene {
    /// The table after a step, as far as geometry tells: what is in or on the object goes with it.
    pub fn after(&self, step: &ConcreteStep) -> Self {
        let view = self.view();
        let Some(object) = self.object(&step.object) else {
            return self.clone();
        };
        let rides = |other: &ObjectSpec| {
            other.id == object.id
                || view.is_upon(&other.id, &object.id)
                || view.is_inside(&other.id, &object.id)
        };
        let mut after = self.clone();
        match step.pose {
            None => after.objects.retain(|other| other.id != object.id),
            Some(pose) => {
                let motion = pose * object.pose.inverse();
                let moved = after.objects.iter_mut().filter(|other| rides(other));
                moved.for_each(|other| other.pose = motion * other.pose);
            }
        }
        after
    }
}

/// The name of an object: by colour and shape if that tells it apart from all others, else its id.
pub(crate) fn named(scene: &TableScene, id: &str) -> Noun {
    let named = Noun::named(id);
    let Some(object) = scene.object(id) else {
        return named;
    };
    let (Some(kind), color) = (kind_word(object), color_of(object)) else {
        return named;
    };
    let alike = scene
        .objects
        .iter()
        .filter(|other| is_called(other, kind) && (color.is_none() || color_of(other) == color));
    match alike.count() {
        1 => Noun::Described {
            quantity: HowMany::The,
            of: ObjectKind {
                color,
                ..ObjectKind::of(kind)
            },
        },
        _ => named,
    }
}

/// The word for an object's shape, if there is one.
pub(crate) fn kind_word(object: &ObjectSpec) -> Option<&'static str> {
    let (_, shape) = *object.all_descriptions().first()?;
    let shape = shape.to_lowercase();
    let known = KINDS.iter().find(|words| words.contains(&shape.as_str()));
    known.and_then(|words| words.first().copied())
}
