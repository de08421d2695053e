//! Towers that are moved, as proposals.

use crate::{
    finding::{example::ExampleView, nouns::NounGuess},
    goal::{GoalKind, ObjectGoal},
    instruction::Instruction,
    scene::SceneView,
};

/// Towers that may be moved from a deed on: from where its object is to another of the places that are used, by way of a third.
pub(crate) fn towers_moved(example: &ExampleView, at: usize) -> Vec<Instruction> {
    let (Some(view), Some(deed)) = (example.views.get(at), example.deeds.get(at)) else {
        return Vec::new();
    };
    let guess = NounGuess { view };
    let is_handled = |id: &str| example.deeds.iter().any(|deed| deed.object == id);
    let objects = view.scene.objects.iter().map(|object| object.id.as_str());
    let places: Vec<_> = objects.filter(|id| !is_handled(id)).collect();
    let is_used = |id: &str| {
        let mut after = example.deeds.iter().zip(&example.views[1..]).skip(at);
        after.any(|(deed, after)| is_at(after, &deed.object, id))
    };
    let used: Vec<_> = places.iter().copied().filter(|id| is_used(id)).collect();
    let from = places.iter().copied();
    let from = from.filter(|id| is_at(view, &deed.object, id));
    let mut all = Vec::new();
    for from in from {
        let others: Vec<_> = used.iter().copied().filter(|id| *id != from).collect();
        for (to, by) in others
            .iter()
            .flat_map(|to| others.iter().map(move |by| (to, by)))
        {
            let nouns = [from, to, by].map(|id| guess.single(id).into_iter().next());
            if let [Some(from), Some(to), Some(by)] = nouns
                && to != by
            {
                all.push(Instruction::MoveTower { from, to, by });
            }
        }
    }
    all
}

fn is_at(view: &SceneView, id: &str, place: &str) -> bool {
    let goals = [
        GoalKind::Upon(place.to_owned()),
        GoalKind::Around(place.to_owned()),
    ];
    let mut goals = goals.into_iter();
    id != place && goals.any(|goal| ObjectGoal::new(id, goal).is_met(view))
}
