//! The inference of a task from a demonstration.

use std::{
    collections::{BTreeMap, BTreeSet},
    path::Path,
};

use tabletop_recorder::RecorderError;

use crate::{
    demonstration::Demonstration,
    detour::fold,
    furniture::Furniture,
    goal::Goal,
    load::{CarriedObject, add_loads},
    manipulation::{Ending, Manipulation},
    noun::Nouns,
    order::partial_order,
    push::pushes,
    relation::{Relation, established},
    requirement::Requirements,
    role::Role,
    step::TaskStep,
    symmetry::Symmetry,
    task::Task,
    tipping::Tipping,
};

impl Task {
    /// Reads a recording and infers its task.
    ///
    /// # Errors
    /// A file cannot be read, or has a line that no recorder writes; the error names the file.
    pub fn read(folder: impl AsRef<Path>) -> Result<Self, RecorderError> {
        Self::read_with(folder, &Furniture::default())
    }

    /// The same, with furniture that completes a recording of the original program.
    ///
    /// # Errors
    /// As of [`Task::read`].
    pub fn read_with(
        folder: impl AsRef<Path>,
        furniture: &Furniture,
    ) -> Result<Self, RecorderError> {
        Ok(Self::of(&Demonstration::read(folder, furniture)?))
    }

    /// The task of a demonstration.
    pub fn of(shown: &Demonstration) -> Self {
        let mut manipulations = Manipulation::all(shown);
        add_loads(shown, &mut manipulations);
        let pushes = pushes(shown, &manipulations);
        let detours = fold(shown, &mut manipulations);
        let relations: Vec<_> = (0..manipulations.len())
            .map(|i| established(shown, &manipulations[i], &manipulations[i + 1..]))
            .collect();
        let order = partial_order(shown, &manipulations, &relations);
        let steps = (0..manipulations.len()).map(|i| {
            let manipulation = &manipulations[i];
            let before = i.checked_sub(1).map(|before| &manipulations[before]);
            TaskStep {
                number: i + 1,
                sentence: String::new(),
                object: manipulation.object.clone(),
                hands: manipulation.hands.clone(),
                grasp: manipulation.grasp,
                release: manipulation.release,
                meanwhile: before.is_some_and(|before| manipulation.grasp < before.release)
                    && !order[i].contains(&i.wrapping_sub(1)),
                relations: relations[i].clone(),
                goal: Goal::of(shown, manipulation, &relations[i]),
                load: CarriedObject::all(shown, manipulation, &relations[i]),
                spilled: manipulation.spilled.clone(),
                tipping: tipping(shown, manipulation),
                after: order[i].iter().map(|step| step + 1).collect(),
            }
        });
        let steps: Vec<_> = steps.collect();
        let mut task = Self {
            table: shown.table,
            roles: cast(shown, &steps),
            joints: shown.joints.clone(),
            steps,
            detours,
            pushes,
            operations: shown.operations.clone(),
            vocabulary: vocabulary(shown),
            nouns: nouns(shown),
        };
        task.phrase(&Requirements::default());
        task
    }
}

/// The way in which a manipulation tips its object over.
fn tipping(shown: &Demonstration, manipulation: &Manipulation) -> Option<Tipping> {
    let is_released = manipulation.ending == Ending::Released;
    let object = shown.named(&manipulation.object).filter(|_| is_released)?;
    Tipping::of(&object.spec.shape, manipulation.from, manipulation.to)
}

fn nouns(shown: &Demonstration) -> BTreeMap<String, String> {
    let nouns = Nouns::of(shown);
    let ids = shown.objects.iter().map(|object| &object.spec.id);
    ids.map(|id| (id.clone(), nouns.of_object(id))).collect()
}

fn vocabulary(shown: &Demonstration) -> BTreeMap<String, BTreeSet<String>> {
    let mut all = BTreeMap::<String, BTreeSet<String>>::new();
    for object in &shown.objects {
        let id = [("id", object.spec.id.as_str())];
        for (name, value) in id.into_iter().chain(object.spec.all_descriptions()) {
            let values = all.entry(name.to_owned()).or_default();
            values.insert(value.to_owned());
        }
    }
    all
}

/// The roles of these steps.
fn cast(shown: &Demonstration, steps: &[TaskStep]) -> Vec<Role> {
    let nouns = Nouns::of(shown);
    let mut ids = Vec::<&str>::new();
    for step in steps {
        let load = step.load.iter().map(|load| load.object.as_str());
        let spilled = step.spilled.iter().map(|spill| spill.from.as_str());
        let others = step.relations.iter().filter_map(Relation::object);
        let named = [step.object.as_str()].into_iter().chain(others);
        for id in named.chain(load).chain(spilled) {
            if !ids.contains(&id) {
                ids.push(id);
            }
        }
    }
    let role = |id: &str| {
        let object = shown.named(id)?;
        let mut spec = object.spec.clone();
        spec.pose = object.track.at(shown.start).unwrap_or(spec.pose);
        Some(Role {
            id: id.to_owned(),
            noun: nouns.of_object(id),
            symmetry: Symmetry::of(&spec.shape),
            shown: spec,
        })
    };
    ids.into_iter().filter_map(role).collect()
}
