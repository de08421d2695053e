//! Touches between bodies.

use std::collections::BTreeSet;

use bevy_rapier3d::rapier::prelude::{
    ColliderSet, ContactPair, RigidBody, RigidBodyHandle, RigidBodySet,
};

use super::{depth::Depths, engine::Engine};

/// Ratio of masses above which they count as uneven.
const UNEVEN: f32 = 1.5;

/// Touches of bodies, by their numbers.
pub(crate) struct Touches {
    pub depths: Depths,
    /// Bodies that touch one of a much different mass.
    pub uneven: BTreeSet<u32>,
    /// Bodies that touch something moved by a hand or a robot.
    pub handled: BTreeSet<u32>,
    /// Bodies that are near something moved by a hand or a robot.
    pub near_hands: BTreeSet<u32>,
    /// Those of them that are near something else, too.
    pub near_others: BTreeSet<u32>,
    /// True if any of them is awake, or a body near it moves.
    pub is_handling: bool,
}

impl Touches {
    pub fn of(engine: &Engine) -> Self {
        let (mut supported, mut touching) = (Vec::new(), Vec::new());
        let (mut uneven, mut handled) = (BTreeSet::new(), BTreeSet::new());
        let mut near_hands = BTreeSet::new();
        let mut is_handling = false;
        for pair in engine.narrow_phase.contact_pairs() {
            let [first, second] =
                bodies_of(pair, engine.colliders).map(|body| Mover::of(body, engine.bodies));
            let touches = pair.has_any_active_contact();
            match (first, second) {
                (Mover::Forces(a, first), Mover::Forces(b, second)) => {
                    let [lighter, heavier] = sorted(first.mass(), second.mass());
                    if touches {
                        touching.push((a, b));
                    }
                    if touches && heavier > UNEVEN * lighter {
                        uneven.extend([a, b]);
                    }
                }
                (Mover::Forces(a, body), Mover::Hand(hand))
                | (Mover::Hand(hand), Mover::Forces(a, body)) => {
                    is_handling |= !body.is_sleeping() || hand.is_moving();
                    near_hands.insert(a);
                    if touches {
                        supported.push(a);
                        handled.insert(a);
                    }
                }
                (Mover::Forces(a, _), Mover::Nothing) | (Mover::Nothing, Mover::Forces(a, _)) => {
                    if touches {
                        supported.push(a);
                    }
                }
                (Mover::Hand(_) | Mover::Nothing, Mover::Hand(_) | Mover::Nothing) => {}
            }
        }
        Self {
            depths: Depths::new(&supported, &touching),
            uneven,
            handled,
            near_others: near_others(engine, &near_hands),
            near_hands,
            is_handling,
        }
    }
}

/// Those of these bodies that are near a body that no hand or robot moves, with or without a predicted contact.
fn near_others(engine: &Engine, bodies: &BTreeSet<u32>) -> BTreeSet<u32> {
    if bodies.is_empty() {
        return BTreeSet::new();
    }
    let pairs = engine.narrow_phase.contact_pairs();
    let movers = pairs
        .map(|pair| bodies_of(pair, engine.colliders).map(|body| Mover::of(body, engine.bodies)));
    let free = movers.flat_map(|movers| match movers {
        [Mover::Forces(a, _), Mover::Forces(b, _)] => vec![a, b],
        [Mover::Forces(a, _), Mover::Nothing] | [Mover::Nothing, Mover::Forces(a, _)] => vec![a],
        [Mover::Hand(_), _] | [_, Mover::Hand(_)] | [Mover::Nothing, Mover::Nothing] => vec![],
    });
    free.filter(|body| bodies.contains(body)).collect()
}

fn sorted(a: f32, b: f32) -> [f32; 2] {
    [a.min(b), a.max(b)]
}

/// The mover of a body.
enum Mover<'a> {
    /// Forces. With the body's number.
    Forces(u32, &'a RigidBody),
    /// A hand or a robot.
    Hand(&'a RigidBody),
    /// Nothing.
    Nothing,
}

impl<'a> Mover<'a> {
    fn of(handle: Option<RigidBodyHandle>, bodies: &'a RigidBodySet) -> Self {
        match handle.and_then(|handle| Some((handle, bodies.get(handle)?))) {
            Some((handle, body)) if body.is_dynamic() => {
                Self::Forces(handle.into_raw_parts().0, body)
            }
            Some((_, body)) if body.is_kinematic() => Self::Hand(body),
            _ => Self::Nothing,
        }
    }
}

/// The bodies of a pair of shapes.
pub(crate) fn bodies_of(
    pair: &ContactPair,
    colliders: &ColliderSet,
) -> [Option<RigidBodyHandle>; 2] {
    [pair.collider1, pair.collider2].map(|collider| colliders.get(collider)?.parent())
}
