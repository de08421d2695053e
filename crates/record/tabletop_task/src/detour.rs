//! Detours: acts on the way that do not matter.

use serde::{Deserialize, Serialize};
use tabletop_core::SimTick;

use crate::{
    arrangement::Placed,
    demonstration::Demonstration,
    manipulation::{Ending, Manipulation},
    operation::OperationDeed,
    symmetry::Symmetry,
};

/// A manipulation, or a part of one, that leaves no trace in the result.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Detour {
    /// Id of the object.
    pub object: String,
    /// The reason why it does not matter.
    pub kind: DetourKind,
    /// The tick in which the object was grasped.
    pub grasp: SimTick,
    /// The tick in which the object was released.
    pub release: SimTick,
}

/// The reason why a detour does not matter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DetourKind {
    /// It was grasped and released in place.
    InPlace,
    /// It was moved and brought back to where it had stood.
    AwayAndBack,
    /// It was put down, and nothing that happened before it was grasped again needed this.
    PutDown,
    /// It went from one hand to another.
    HandedOver,
}

/// Largest displacement of an object that is still in its place, in units.
pub(crate) const IN_PLACE: f32 = 0.15;
/// Largest turn of an object that is still in its place, in rad.
const UNTURNED: f32 = 0.05;

/// Takes the detours out of the manipulations, which stay in order.
pub fn fold(shown: &Demonstration, manipulations: &mut Vec<Manipulation>) -> Vec<Detour> {
    let mut detours: Vec<_> = manipulations
        .iter()
        .filter(|manipulation| manipulation.hands.len() > 1)
        .map(|manipulation| detour(manipulation, DetourKind::HandedOver))
        .collect();
    drop_means(shown, manipulations);
    while let Some(detour) = fold_one(shown, manipulations) {
        detours.push(detour);
    }
    detours.sort_by_key(|detour| (detour.grasp, detour.release));
    detours
}

/// Drops the manipulations of what was brought back after something was poured or tipped from it: they are no detours.
fn drop_means(shown: &Demonstration, manipulations: &mut Vec<Manipulation>) {
    let spills: Vec<_> = manipulations
        .iter()
        .filter_map(|one| Some((one.spilled.as_ref()?.from.clone(), one.grasp)))
        .collect();
    manipulations.retain(|one| {
        let mut spills = spills.iter();
        let has_spilled = spills.any(|(from, grasp)| *from == one.object && *grasp == one.grasp);
        !(has_spilled && one.ending == Ending::Released && is_back(shown, one))
    });
}

fn fold_one(shown: &Demonstration, manipulations: &mut Vec<Manipulation>) -> Option<Detour> {
    for i in 0..manipulations.len() {
        let manipulation = &manipulations[i];
        if manipulation.ending == Ending::Released && is_back(shown, manipulation) {
            let kind = match farthest(shown, manipulation) < IN_PLACE {
                true => DetourKind::InPlace,
                false => DetourKind::AwayAndBack,
            };
            let back = manipulations.remove(i);
            let mut later = manipulations[i..].iter_mut();
            if let Some(next) = later.find(|next| next.object == back.object) {
                // What is hardly moved several times may be moved by much.
                next.from = back.from;
            }
            return Some(detour(&back, kind));
        }
        let rest = &manipulations[i + 1..];
        let next = rest
            .iter()
            .position(|next| next.object == manipulation.object);
        let Some(next) = next.map(|next| i + 1 + next) else {
            continue;
        };
        let between = &manipulations[i + 1..next];
        if manipulation.ending == Ending::Released
            && between
                .iter()
                .all(|other| is_apart(shown, manipulation, other))
            && !is_operated(shown, manipulation, &manipulations[next])
        {
            let first = manipulations.remove(i);
            let last = &mut manipulations[next - 1];
            last.from = first.from;
            return Some(detour(&first, DetourKind::PutDown));
        }
    }
    None
}

fn detour(manipulation: &Manipulation, kind: DetourKind) -> Detour {
    Detour {
        object: manipulation.object.clone(),
        kind,
        grasp: manipulation.grasp,
        release: manipulation.release,
    }
}

/// True if an object looks the same after a manipulation as before it.
fn is_back(shown: &Demonstration, manipulation: &Manipulation) -> bool {
    let Some(object) = shown.named(&manipulation.object) else {
        return false;
    };
    let symmetry = Symmetry::of(&object.spec.shape);
    let (moved, turned) = symmetry.difference(manipulation.from, manipulation.to);
    moved < IN_PLACE && turned < UNTURNED
}

/// Largest distance of an object from where it was, in units.
fn farthest(shown: &Demonstration, manipulation: &Manipulation) -> f32 {
    let Some(object) = shown.named(&manipulation.object) else {
        return 0.0;
    };
    let poses = object.track.between(manipulation.grasp, manipulation.rest);
    poses
        .map(|pose| pose.location.distance(manipulation.from.location))
        .fold(0.0, f32::max)
}

/// True if an object was operated, fastened or loosened between its two manipulations.
fn is_operated(shown: &Demonstration, one: &Manipulation, next: &Manipulation) -> bool {
    let spec = shown.named(&one.object).map(|object| &object.spec);
    let has_control = |control: &str| spec.is_some_and(|spec| spec.control(control).is_some());
    let is_meant = |deed: &OperationDeed| match deed {
        OperationDeed::Trigger { control } => has_control(control),
        OperationDeed::PointTo { .. } | OperationDeed::Cut { .. } => false,
        OperationDeed::Fasten(bond) | OperationDeed::Loosen(bond) => {
            bond.guest == one.object || bond.host == one.object
        }
    };
    let between = one.release..=next.grasp;
    let mut operations = shown.operations.iter();
    operations.any(|done| between.contains(&done.tick) && is_meant(&done.deed))
}

/// True if neither has made room for the other nor carries it: the places of one are not above or below those of the other.
fn is_apart(shown: &Demonstration, one: &Manipulation, other: &Manipulation) -> bool {
    let [ones, others] = [one, other].map(|manipulation| places(shown, manipulation));
    ones.iter()
        .all(|one| others.iter().all(|other| !one.shares_column_with(other)))
}

/// The object at its places before and after a manipulation.
pub(crate) fn places(shown: &Demonstration, manipulation: &Manipulation) -> Vec<Placed> {
    let Some(object) = shown.named(&manipulation.object) else {
        return Vec::new();
    };
    let place = |pose| Placed::new(&object.spec.shape, pose);
    match manipulation.ending {
        Ending::Released => vec![place(manipulation.from), place(manipulation.to)],
        Ending::Destroyed | Ending::Held => vec![place(manipulation.from)],
    }
}
