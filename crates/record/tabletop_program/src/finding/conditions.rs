//! Conditions that hold on a table, and may have been meant.

use tabletop_core::JointKind;

use crate::{
    condition::Condition,
    finding::nouns::NounGuess,
    noun::{Noun, ObjectKind, Preposition, Restriction, Spot, TableSide},
    scene::SceneView,
    selection::ANYTHING,
};

/// The most nouns by which an object of a condition is called.
const NOUNS: usize = 2;

/// The conditions that hold on a table.
pub(crate) fn conditions(view: &SceneView) -> Vec<Condition> {
    let guess = NounGuess { view };
    let nouns = |id: &str| guess.single(id).into_iter().take(NOUNS);
    let holders = view
        .scene
        .joints
        .iter()
        .filter_map(|joint| match joint.kind {
            JointKind::Slider { .. } => joint.objects.first(),
            JointKind::PushButton { .. }
            | JointKind::Hinge { .. }
            | JointKind::Shears { .. }
            | JointKind::Ball
            | JointKind::Fixed => None,
        });
    let lids = holders.flat_map(|id| {
        let is_open = view.sliding_part(id).is_some_and(|part| part.is_open());
        nouns(id).map(move |what| match is_open {
            true => Condition::IsOpen { what },
            false => Condition::IsClosed { what },
        })
    });
    let mut all: Vec<_> = lids.collect();
    let ids: Vec<_> = view
        .scene
        .objects
        .iter()
        .map(|object| object.id.as_str())
        .collect();
    for id in ids.iter().filter(|id| view.is_movable(id)) {
        for spot in spots(&guess, &ids, id) {
            all.extend(nouns(id).map(|what| Condition::Is {
                what,
                not: false,
                spot: spot.clone(),
            }));
        }
    }
    for id in &ids {
        let how = [Preposition::Inside, Preposition::On];
        let spots = nouns(id).flat_map(|noun: Noun| how.map(|how| Spot::at(how, noun.clone())));
        let empty = spots.map(|spot| ObjectKind {
            restriction: Some(Restriction::Where { not: false, spot }),
            ..ObjectKind::of(ANYTHING)
        });
        let count = |of: &ObjectKind| guess.selection().members(of).map_or(0, |all| all.len());
        all.extend(
            empty
                .filter(|of| count(of) == 0)
                .map(|of| Condition::ThereIsNo { of }),
        );
    }
    all.extend(majorities(&guess, &ids));
    all
}

/// The places at which an object is.
fn spots(guess: &NounGuess, ids: &[&str], id: &str) -> Vec<Spot> {
    let selection = guess.selection();
    let others = ids.iter().filter(|other| **other != id).flat_map(|other| {
        let how = [Preposition::Inside, Preposition::On, Preposition::Around];
        let how = how
            .into_iter()
            .filter(|how| selection.is_related(id, *how, other));
        how.flat_map(|how| {
            let nouns = guess.single(other).into_iter().take(NOUNS);
            nouns.map(move |noun| Spot::at(how, noun))
        })
    });
    let at = guess.view.location(id);
    let sides = TableSide::ALL.into_iter().filter(|side| side.has(at));
    let sides = [None].into_iter().chain(sides.map(Some));
    let is_on_table = guess.view.standing.is_on_table(id);
    let tables = sides
        .filter(|_| is_on_table)
        .map(|side| Spot::Table { side });
    others.chain(tables).collect()
}

/// That there are more objects of one kind and colour than of another.
fn majorities(guess: &NounGuess, ids: &[&str]) -> Vec<Condition> {
    let mut kinds = Vec::new();
    for kind in ids.iter().flat_map(|id| guess.kinds(id)) {
        let is_plain = kind.size.is_none() && kind.is != ANYTHING && kind.color.is_some();
        if is_plain && !kinds.contains(&kind) {
            kinds.push(kind);
        }
    }
    let count = |of: &ObjectKind| guess.selection().members(of).map_or(0, |all| all.len());
    let pairs = kinds.iter().flat_map(|of| {
        let fewer = kinds
            .iter()
            .filter(|than| than.is == of.is && count(of) > count(than));
        fewer.map(|than| Condition::ThereAreMore {
            of: of.clone(),
            than: than.clone(),
        })
    });
    pairs.collect()
}
