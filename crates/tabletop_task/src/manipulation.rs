//! Manipulations: the acts of a hand on an object, from grasp to release.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use tabletop_core::{Hand, SimTick};
use tabletop_geometry::Pose;

use crate::demonstration::{Demonstration, HandAct, HandDeed};

/// The handling of one object, by one hand or by several in turn.
#[derive(Clone, Debug, PartialEq)]
pub struct Manipulation {
    /// Id of the object.
    pub object: String,
    /// The hands, in the order in which they held it.
    pub hands: Vec<Hand>,
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
}

/// The ending of a manipulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Ending {
    /// The hand let go of it.
    Released,
    /// The hand removed it from the world.
    Destroyed,
    /// The recording ended while it was held.
    Held,
}

/// The hand that lets go. The original program names the hand that takes over instead, which holds nothing yet.
fn letting_go(
    held: &BTreeMap<Hand, (String, SimTick)>,
    named: Hand,
    next: Option<&HandAct>,
) -> Hand {
    if held.contains_key(&named) {
        return named;
    }
    let taken = next.and_then(|act| match &act.deed {
        HandDeed::Grasp(id) if act.hand == named => Some(id),
        HandDeed::Grasp(_) | HandDeed::Release | HandDeed::Destroy => None,
    });
    let holds = |(_, (object, _)): &(&Hand, &(String, SimTick))| Some(object) == taken;
    let holder = held.iter().find(holds).or_else(|| held.iter().next());
    holder.map_or(named, |(hand, _)| *hand)
}

/// Most ticks between release and grasp in a hand-over.
const HAND_OVER: u64 = 2;

impl Manipulation {
    /// The manipulations of a demonstration, in the order in which they ended.
    pub fn all(shown: &Demonstration) -> Vec<Self> {
        let mut held = BTreeMap::<Hand, (String, SimTick)>::new();
        let mut all = Vec::new();
        for (i, act) in shown.acts.iter().enumerate() {
            let end = |ending| move |(object, grasp)| (act.hand, object, grasp, act.tick, ending);
            let ended = match &act.deed {
                HandDeed::Grasp(id) => {
                    let before = held.insert(act.hand, (id.clone(), act.tick));
                    before.map(end(Ending::Released))
                }
                HandDeed::Release => {
                    let hand = letting_go(&held, act.hand, shown.acts.get(i + 1));
                    let released = held.remove(&hand);
                    released
                        .map(|(object, grasp)| (hand, object, grasp, act.tick, Ending::Released))
                }
                HandDeed::Destroy => held.remove(&act.hand).map(end(Ending::Destroyed)),
            };
            all.extend(ended);
        }
        let held = held
            .into_iter()
            .map(|(hand, (object, grasp))| (hand, object, grasp, shown.end, Ending::Held));
        all.extend(held.collect::<Vec<_>>());

        let mut manipulations = Vec::<Self>::new();
        for (hand, object, grasp, release, ending) in all {
            let Some(track) = shown.named(&object).map(|object| &object.track) else {
                continue;
            };
            let handed_over = manipulations.iter_mut().find(|earlier| {
                let between = grasp.0.saturating_sub(earlier.release.0);
                earlier.object == object
                    && earlier.ending == Ending::Released
                    && grasp >= earlier.release
                    && between <= HAND_OVER
            });
            if let Some(earlier) = handed_over {
                earlier.hands.push(hand);
                (earlier.release, earlier.ending) = (release, ending);
                continue;
            }
            let (Some(from), Some(to)) = (
                track.at(SimTick(grasp.0.saturating_sub(1))),
                track.at(release),
            ) else {
                continue;
            };
            manipulations.push(Self {
                object,
                hands: vec![hand],
                grasp,
                release,
                rest: release,
                ending,
                from,
                to,
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
