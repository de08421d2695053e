//! Objects like those that were moved which were left where they are.

use std::collections::BTreeSet;

use crate::{
    finding::{example::Example, nouns::NounGuess},
    noun::{HowMany, Noun, ObjectKind},
    scene::SceneView,
    selection::ANYTHING,
};

/// The objects that are like all that were moved and were left where they are, by what they are.
pub(crate) fn untouched(example: &Example) -> Vec<(String, Vec<String>)> {
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
        (!members.is_empty()).then(|| (noun.to_string(), members))
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
