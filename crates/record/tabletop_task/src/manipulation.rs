//! Manipulations: the acts of hands and grippers on an object, from grasp to release.

use serde::{Deserialize, Serialize};
use tabletop_core::{Manipulator, SimTick};
use tabletop_geometry::Pose;

use crate::demonstration::{ActDeed, Demonstration, ShownAct};

/// The handling of one object, by one hand or gripper or by several in turn.
#[derive(Clone, Debug, PartialEq)]
pub struct Manipulation {
    /// Id of the object.
    pub object: String,
    /// The hands and grippers, in the order in which they held it.
    pub hands: Vec<Manipulator>,
    /// The tick in which it was grasped.
    pub grasp: SimTick,
    /// The tick in which it was released or removed.
    pub release: SimTick,
    /// The tick by which it has come to rest.
    pub rest: SimTick,
    /// Its ending.
    pub ending: Ending,
    /// Pose of the object before.
    pub from: Pose,
    /// Pose in which the object came to rest.
    pub to: Pose,
    /// Ids of the objects that went along with it, each after what it is on or in.
    pub load: Vec<String>,
    /// The object from which it was poured or tipped, if no hand held it.
    pub spilled: Option<Spill>,
}

/// The way in which an object was on another one, from which it was poured or tipped.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Spill {
    /// The object from which it came, by its role.
    pub from: String,
    /// True if it was in that, rather than on it.
    pub was_inside: bool,
}

/// The ending of a manipulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Ending {
    /// It was let go.
    Released,
    /// It was removed from the world.
    Destroyed,
    /// The recording ended while it was held.
    Held,
}

/// An object in a hand or gripper, from grasp to release.
#[derive(Clone, Debug, PartialEq)]
struct HeldPeriod {
    by: Manipulator,
    object: String,
    grasp: SimTick,
    release: SimTick,
    ending: Ending,
}

/// The hand that lets go. The original program names the hand that takes over instead, which holds nothing yet.
fn letting_go(held: &[HeldPeriod], named: Manipulator, next: Option<&ShownAct>) -> Manipulator {
    if held.iter().any(|hold| hold.by == named) {
        return named;
    }
    let taken = next.and_then(|act| match &act.deed {
        ActDeed::Grasp(id) if act.by == named => Some(id),
        ActDeed::Grasp(_) | ActDeed::Release(_) | ActDeed::Destroy => None,
    });
    let holder = held.iter().find(|hold| Some(&hold.object) == taken);
    let holder = holder.or_else(|| held.iter().min_by_key(|hold| hold.by));
    holder.map_or(named, |hold| hold.by)
}

/// What hands and grippers held, in the order in which they took it. A hand holds one object at a time, a gripper whatever is between its
/// fingers.
fn holds(shown: &Demonstration) -> Vec<HeldPeriod> {
    let mut held = Vec::<HeldPeriod>::new();
    let mut all = Vec::new();
    for (i, act) in shown.acts.iter().enumerate() {
        let (ending, by, object) = match &act.deed {
            ActDeed::Grasp(id) => {
                let is_whole = matches!(act.by, Manipulator::Hand(_));
                (Ending::Released, act.by, (!is_whole).then_some(id))
            }
            ActDeed::Release(None) => {
                let by = letting_go(&held, act.by, shown.acts.get(i + 1));
                (Ending::Released, by, None)
            }
            ActDeed::Release(Some(id)) => (Ending::Released, act.by, Some(id)),
            ActDeed::Destroy => (Ending::Destroyed, act.by, None),
        };
        let is_ended = |hold: &mut HeldPeriod| {
            hold.by == by && object.is_none_or(|object| *object == hold.object)
        };
        all.extend(held.extract_if(.., is_ended).map(|hold| HeldPeriod {
            release: act.tick,
            ending,
            ..hold
        }));
        if let ActDeed::Grasp(id) = &act.deed {
            held.push(HeldPeriod {
                by: act.by,
                object: id.clone(),
                grasp: act.tick,
                release: shown.end,
                ending: Ending::Held,
            });
        }
    }
    all.extend(held);
    all.sort_by_key(|hold| hold.grasp);
    all
}

/// Most ticks between release and grasp in a hand-over.
const HAND_OVER: u64 = 2;

impl Manipulation {
    /// The manipulations of a demonstration, in the order in which they ended.
    pub fn all(shown: &Demonstration) -> Vec<Self> {
        let mut manipulations = Vec::<Self>::new();
        for hold in holds(shown) {
            let Some(track) = shown.named(&hold.object).map(|object| &object.track) else {
                continue;
            };
            let handed_over = manipulations.iter_mut().find(|earlier| {
                earlier.object == hold.object
                    && earlier.ending == Ending::Released
                    && hold.grasp.0 <= earlier.release.0.saturating_add(HAND_OVER)
            });
            if let Some(earlier) = handed_over {
                if hold.release >= earlier.release {
                    (earlier.release, earlier.ending) = (hold.release, hold.ending);
                    earlier.to = track.at(hold.release).unwrap_or(earlier.to);
                    earlier.hands.push(hold.by);
                    earlier.hands.dedup();
                }
                continue;
            }
            let (Some(from), Some(to)) = (
                track.at(SimTick(hold.grasp.0.saturating_sub(1))),
                track.at(hold.release),
            ) else {
                continue;
            };
            manipulations.push(Self {
                object: hold.object,
                hands: vec![hold.by],
                grasp: hold.grasp,
                release: hold.release,
                rest: hold.release,
                ending: hold.ending,
                from,
                to,
                load: Vec::new(),
                spilled: None,
            });
        }
        manipulations.sort_by_key(|manipulation| manipulation.release);
        for i in 0..manipulations.len() {
            let (object, release) = (&manipulations[i].object, manipulations[i].release);
            let next = manipulations
                .iter()
                .filter(|next| next.object == *object && next.grasp >= release)
                .map(|next| SimTick(next.grasp.0.saturating_sub(1)))
                .min();
            let until = next.unwrap_or(shown.end).max(release);
            let track = shown.named(object).map(|object| &object.track);
            let rest = match manipulations[i].ending {
                Ending::Released => track.map_or(release, |track| track.rest_after(release, until)),
                Ending::Destroyed | Ending::Held => release,
            };
            let to = track.and_then(|track| track.at(rest));
            manipulations[i].rest = rest;
            manipulations[i].to = to.unwrap_or(manipulations[i].to);
        }
        manipulations
    }
}
