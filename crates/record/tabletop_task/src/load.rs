//! Loads: objects that go along with the one that is moved, because they are on it or in it.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};
use tabletop_core::SimTick;

use crate::{
    arrangement::Arrangement,
    demonstration::Demonstration,
    detour::IN_PLACE,
    goal::Goal,
    manipulation::{Ending, Manipulation, Spill},
    relation::{Relation, standing},
};

/// An object that goes along with the one that a step moves, and is on it or in it in the end.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CarriedObject {
    /// The role of the object.
    pub object: String,
    /// What it is then on, in and around.
    pub relations: Vec<Relation>,
    /// Its place there.
    pub goal: Goal,
}

impl CarriedObject {
    /// The load of a manipulation, in an order in which it could be put there.
    ///
    /// What slides along a joint takes along whatever is there, so it needs none.
    pub(crate) fn all(
        shown: &Demonstration,
        manipulation: &Manipulation,
        relations: &[Relation],
    ) -> Vec<Self> {
        if matches!(relations.first(), Some(Relation::Slid { .. })) {
            return Vec::new();
        }
        let after = shown.at(manipulation.rest);
        let load = manipulation.load.iter().filter_map(|id| {
            let relations = standing(&after, id);
            let pose = after.pose(id)?;
            Some(Self {
                object: id.clone(),
                goal: Goal::at(shown, &after, id, &relations, [pose, pose])?,
                relations,
            })
        });
        load.collect()
    }
}

/// Notes the loads of all manipulations, and adds a manipulation for everything that was poured or tipped from another object.
pub(crate) fn add_loads(shown: &Demonstration, manipulations: &mut Vec<Manipulation>) {
    let loads: Vec<_> = manipulations
        .iter()
        .map(|one| load(shown, manipulations, one))
        .collect();
    let spilled: Vec<_> = manipulations
        .iter()
        .flat_map(|one| spilled(shown, manipulations, one))
        .collect();
    for (one, load) in manipulations.iter_mut().zip(loads) {
        one.load = load;
    }
    manipulations.extend(spilled);
    // What is spilled has gone before its carrier is put down.
    manipulations.sort_by_key(|one| (one.release, one.spilled.is_none()));
}

/// What is on or in the object of a manipulation in the end, and was so before or was put there meanwhile.
fn load(shown: &Demonstration, all: &[Manipulation], one: &Manipulation) -> Vec<String> {
    if one.ending == Ending::Destroyed {
        return Vec::new();
    }
    let before = before(shown, one);
    let carried = before.load(&one.object);
    let joined = joined(shown, &one.object);
    let is_load = |id: &&str| {
        let own = || all.iter().filter(|own| own.object == **id);
        let is_put = own().any(|own| (one.grasp..=one.release).contains(&own.release));
        let is_held = own().any(|own| own.grasp <= one.release && own.release > one.release);
        !joined.contains(*id) && !is_held && (is_put || carried.contains(id))
    };
    let after = shown.at(one.rest);
    let load = after.load(&one.object).into_iter().filter(is_load);
    load.map(str::to_owned).collect()
}

/// What was on or in the object of a manipulation before, and lies elsewhere in the end, though no hand has taken it.
fn spilled(shown: &Demonstration, all: &[Manipulation], one: &Manipulation) -> Vec<Manipulation> {
    if one.ending == Ending::Destroyed {
        return Vec::new();
    }
    let before = before(shown, one);
    let joined = joined(shown, &one.object);
    let carried = before.load(&one.object).into_iter();
    let spilled = carried.filter(|id| !joined.contains(*id)).filter_map(|id| {
        let own = || all.iter().filter(|own| own.object == id);
        if own().any(|own| own.grasp <= one.rest && own.release >= one.grasp) {
            return None;
        }
        let track = &shown.named(id)?.track;
        let next = own().map(|own| own.grasp).filter(|next| *next > one.rest);
        let until = next.min().map_or(shown.end, |next| SimTick(next.0 - 1));
        let rest = track.rest_after(one.release, until);
        let (from, to) = (before.pose(id)?, track.at(rest)?);
        let is_gone = !shown.at(rest).load(&one.object).contains(&id);
        let has_moved = from.location.distance(to.location) > IN_PLACE;
        (is_gone && has_moved).then(|| Manipulation {
            object: id.to_owned(),
            hands: one.hands.clone(),
            grasp: one.grasp,
            release: rest.min(one.release),
            rest,
            ending: Ending::Released,
            from,
            to,
            load: Vec::new(),
            spilled: Some(Spill {
                from: one.object.clone(),
                was_inside: before.containers(id).contains(&one.object.as_str()),
            }),
        })
    });
    spilled.collect()
}

/// The arrangement before a manipulation.
fn before(shown: &Demonstration, one: &Manipulation) -> Arrangement {
    shown.at(SimTick(one.grasp.0.saturating_sub(1)))
}

/// The objects that joints connect with an object, and the object itself.
fn joined<'s>(shown: &'s Demonstration, id: &'s str) -> BTreeSet<&'s str> {
    let mut joined = BTreeSet::from([id]);
    loop {
        let known = joined.len();
        for joint in &shown.joints {
            let [one, other] = joint.objects.each_ref().map(String::as_str);
            if joined.contains(one) || joined.contains(other) {
                joined.extend([one, other]);
            }
        }
        if joined.len() == known {
            return joined;
        }
    }
}
