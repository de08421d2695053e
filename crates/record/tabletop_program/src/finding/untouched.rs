//! Objects like those that were moved which were left where they are.

use std::{collections::BTreeSet, fmt};

use crate::{
    finding::{example::Example, nouns::NounGuess},
    noun::{HowMany, Noun, ObjectKind},
    scene::SceneView,
    selection::ANYTHING,
};

/// Objects like those that were moved which were left where they are.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Untouched {
    /// The kind that they are, such as `every red block`.
    pub of: String,
    /// Their ids.
    pub objects: Vec<String>,
}

impl fmt::Display for Untouched {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { of, objects } = self;
        write!(f, "Not moved, but of {of}: {}.", objects.join(", "))
    }
}

/// The objects that are like all that were moved and were left where they are, by their kinds.
pub(crate) fn untouched(example: &Example) -> Vec<Untouched> {
    let Some(scene) = example.tables.first() else {
        return Vec::new();
    };
    let view = scene.view();
    let guess = NounGuess { view: &view };
    let touched = example.touched();
    let moved: BTreeSet<_> = example
        .deeds
        .iter()
        .map(|deed| deed.object.as_str())
        .collect();
    let kinds = common_kinds(&view, &moved);
    let left = kinds.into_iter().filter_map(|of| {
        let mut members = guess.selection().members(&of).ok()?;
        members.retain(|id| !touched.contains(id.as_str()) && view.is_movable(id));
        let quantity = HowMany::Every;
        let noun = Noun::Described { quantity, of };
        (!members.is_empty()).then(|| Untouched {
            of: noun.to_string(),
            objects: members,
        })
    });
    left.collect()
}

/// The kinds that all these objects are, without those of anything.
fn common_kinds(view: &SceneView, ids: &BTreeSet<&str>) -> Vec<ObjectKind> {
    let guess = NounGuess { view };
    let mut ids = ids.iter();
    let mut kinds = ids.next().map_or(Vec::new(), |id| guess.kinds(id));
    for id in ids {
        let own = guess.kinds(id);
        kinds.retain(|kind| own.contains(kind));
    }
    kinds.retain(|kind| kind.size.is_none() && kind.is != ANYTHING);
    kinds
}
