//! What a policy may be told besides the picture: the task in words, and where everything is.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use tabletop_controller::Sight;
use tabletop_core::{ObjectSpec, Table};
use tabletop_geometry::Pose;
use tabletop_program::TableScene;
use tabletop_recorder::object_fault;

/// The most objects that are believed.
const MOST_OBJECTS: usize = 200;
/// The longest side of a table, in units.
const LONGEST: f32 = 1000.0;

/// A task as a policy may be told it.
#[derive(Clone, Copy, Debug)]
pub struct ToldTask<'a> {
    /// The task in words.
    pub words: &'a str,
    /// The objects as they were when it began.
    pub objects: &'a [ObjectSpec],
}

/// A table of which all is known: for policies that need not see.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct KnownTable {
    table: Table,
    /// The objects when the task began.
    first: Vec<ObjectSpec>,
    /// Where those are now that are still there, by their ids.
    now: BTreeMap<String, Pose>,
}

impl KnownTable {
    pub fn new(told: &ToldTask, sight: &Sight) -> Self {
        let now = told.objects.iter().filter_map(|object| {
            let seen = sight.objects.get(&object.id)?;
            Some((object.id.clone(), seen.pose))
        });
        Self {
            table: sight.table,
            first: told.objects.to_vec(),
            now: now.collect(),
        }
    }

    /// As a text of JSON.
    pub fn text(&self) -> String {
        // Names and numbers always have one.
        serde_json::to_string(self).unwrap_or_default()
    }

    /// The one in a text that a stranger may have written; an error says what is wrong with it.
    pub fn read(text: &str) -> Result<Self, String> {
        let known: Self = serde_json::from_str(text).map_err(|error| error.to_string())?;
        if known.first.len() > MOST_OBJECTS {
            return Err(format!(
                "{} objects, expected at most {MOST_OBJECTS}",
                known.first.len()
            ));
        }
        let Table { xspan, yspan } = known.table;
        if [xspan, yspan]
            .iter()
            .any(|side| !(0.0..=LONGEST).contains(side))
        {
            return Err(format!("a table of {xspan} x {yspan} units"));
        }
        let [first, now] = known.scenes();
        let faulty = first.objects.iter().chain(&now.objects);
        let mut faults = faulty.filter_map(|object| Some((&object.id, object_fault(object)?)));
        match faults.next() {
            Some((id, fault)) => Err(format!("{id:?}: {fault}")),
            None => Ok(known),
        }
    }

    /// The table when the task began, and as it is now.
    pub fn scenes(&self) -> [TableScene; 2] {
        let scene = |objects| TableScene {
            table: self.table,
            objects,
            joints: Vec::new(),
        };
        let now = self.first.iter().filter_map(|object| {
            let pose = *self.now.get(&object.id)?;
            Some(ObjectSpec {
                pose,
                ..object.clone()
            })
        });
        [scene(self.first.clone()), scene(now.collect())]
    }
}
