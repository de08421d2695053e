//! Pushes: objects that were moved by others in hands.

use serde::{Deserialize, Serialize};
use tabletop_core::SimTick;
use tabletop_geometry::Pose;

use crate::{
    demonstration::{Demonstration, ShownObject},
    detour::IN_PLACE,
    manipulation::Manipulation,
    noun::Nouns,
    spot::spot,
};

/// A displacement of an object that no hand held, and that none moved afterwards.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Push {
    /// Id of the object.
    pub object: String,
    /// Id of the object in the hand meanwhile.
    pub by: String,
    /// The tick in which that was grasped.
    pub tick: SimTick,
    /// Length of the displacement, in units.
    pub distance: f32,
    /// The push in one sentence.
    pub sentence: String,
}

/// The pushes of a demonstration with these manipulations.
pub(crate) fn pushes(shown: &Demonstration, manipulations: &[Manipulation]) -> Vec<Push> {
    let nouns = Nouns::of(shown);
    let objects = shown.objects.iter();
    objects
        .flat_map(|object| pushes_of(shown, manipulations, object, &nouns))
        .collect()
}

fn pushes_of(
    shown: &Demonstration,
    manipulations: &[Manipulation],
    object: &ShownObject,
    nouns: &Nouns,
) -> Vec<Push> {
    let id = &object.spec.id;
    let is_jointed = shown.joints.iter().any(|joint| joint.objects.contains(id));
    if is_jointed || object.deleted.is_some() {
        return Vec::new();
    }
    let own = manipulations.iter().filter(|one| one.object == *id);
    let mut since = own.map(|one| one.rest).max().unwrap_or(object.created);
    let mut found = Vec::new();
    let others = manipulations.iter().filter(|one| one.object != *id);
    for carried in others {
        if carried.grasp <= since {
            continue;
        }
        let before = SimTick(carried.grasp.0.saturating_sub(1)).max(since);
        let rest = object.track.rest_after(carried.release, shown.end);
        let Some([from, to]) = poses(object, before, rest) else {
            continue;
        };
        let distance = from.location.distance(to.location);
        if distance < IN_PLACE || is_carried_along(shown, object, carried, before) {
            continue;
        }
        since = rest;
        let [pushing, pushed] = [&carried.object, id].map(|id| nouns.of_object(id));
        found.push(Push {
            object: id.clone(),
            by: carried.object.clone(),
            tick: carried.grasp,
            distance,
            sentence: format!(
                "On its way, {pushing} moves {pushed} by {distance:.1}, to {}.",
                spot(to.location)
            ),
        });
    }
    found
}

fn poses(object: &ShownObject, from: SimTick, to: SimTick) -> Option<[Pose; 2]> {
    Some([object.track.at(from)?, object.track.at(to)?])
}

/// True if an object goes with one that is carried: it is of its load, or stays where it is beside it.
fn is_carried_along(
    shown: &Demonstration,
    object: &ShownObject,
    carried: &Manipulation,
    before: SimTick,
) -> bool {
    if carried.load.contains(&object.spec.id) {
        return true;
    }
    let place = |tick| {
        let base = shown.named(&carried.object)?.track.at(tick)?;
        Some((base.inverse() * object.track.at(tick)?).location)
    };
    let places = place(before).zip(place(carried.release));
    places.is_some_and(|(one, other)| one.distance(other) < IN_PLACE)
}
