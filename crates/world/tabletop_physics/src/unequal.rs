//! Warnings of masses that are too far apart.

use std::collections::BTreeSet;

use bevy::prelude::*;
use bevy_rapier3d::prelude::{RapierContextColliders, RapierContextSimulation, RapierRigidBodySet};
use tabletop_core::ObjectSpec;

use crate::effort::bodies_of;

/// Ratio of the masses of two objects in touch up to which their contacts hold.
const MOST: f32 = 10_000.0;

/// Warns, once for each pair, of objects that touch much heavier ones.
pub(crate) fn warn_of_unequal_masses(
    contexts: Query<(
        &RapierContextSimulation,
        &RapierContextColliders,
        &RapierRigidBodySet,
    )>,
    objects: Query<&ObjectSpec>,
    mut known: Local<BTreeSet<[String; 2]>>,
) {
    for (simulation, colliders, set) in &contexts {
        let awake = simulation.islands.active_bodies();
        if !is_ratio_above(MOST, awake.filter_map(|handle| set.bodies.get(handle))) {
            continue;
        }
        let pairs = simulation.narrow_phase.contact_pairs();
        let touching = pairs.filter(|pair| pair.has_any_active_contact());
        let mut unequal: Vec<_> = touching
            .filter_map(|pair| {
                let objects = bodies_of(pair, &colliders.colliders).map(|body| {
                    let object = objects.get(set.rigid_body_entity(body?)?).ok()?;
                    (!object.is_fixed()).then_some(object)
                });
                let [Some(first), Some(second)] = objects else {
                    return None;
                };
                let [light, heavy] = match first.mass <= second.mass {
                    true => [first, second],
                    false => [second, first],
                };
                let is_unequal = heavy.mass > MOST * light.mass;
                is_unequal.then(|| [light.id.to_string(), heavy.id.to_string()])
            })
            .collect();
        unequal.sort_unstable();
        for pair in unequal {
            if known.contains(&pair) {
                continue;
            }
            let [light, heavy] = &pair;
            warn!(
                "{heavy} touches {light} and is more than {MOST} times as heavy: how they move each other is inexact"
            );
            known.insert(pair);
        }
    }
}

/// True if the heaviest of the bodies that forces move is heavier than this many times the lightest.
pub(crate) fn is_ratio_above<'a>(
    ratio: f32,
    bodies: impl Iterator<Item = &'a bevy_rapier3d::rapier::prelude::RigidBody>,
) -> bool {
    let masses = bodies
        .filter(|body| body.is_dynamic())
        .map(|body| body.mass());
    let (least, most) = masses.fold((f32::INFINITY, 0.0_f32), |(least, most), mass| {
        (least.min(mass), most.max(mass))
    });
    most > ratio * least
}
