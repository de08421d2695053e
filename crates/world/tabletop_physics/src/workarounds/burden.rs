//! Burdens: a body that carries a much heavier one is solved as if it weighed a part of it.
//!
//! Rapier's contacts are springs, as stiff as the lighter of two bodies is heavy, so one that carries a thousand times its weight is pressed in. For the
//! length of a step it has the mass of a hundredth of its burden, with which its contacts hold; what it weighs on its support grows by no more than
//! a hundredth of what the support carries already. It falls and turns as before, and a light body that lies on a heavy one keeps its mass.

use std::collections::{BTreeMap, BTreeSet};

use bevy::prelude::*;
use bevy_rapier3d::{
    parry::bounding_volume::BoundingVolume as _,
    prelude::{
        RapierConfiguration, RapierContextColliders, RapierContextSimulation, RapierRigidBodySet,
    },
    rapier::prelude::{
        ColliderSet, ContactPair, MassProperties, NarrowPhase, RigidBodyHandle, RigidBodySet,
    },
};

use crate::{effort::bodies_of, unequal::is_ratio_above};

/// The burden, in masses of its own, that a body carries without help.
const BEARABLE: f32 = 100.0;

/// The least upward part of a contact's normal with which one body carries the other.
const UPWARD: f32 = 0.3;

/// Distance, in units, within which bodies whose contacts are not known yet lie on each other.
const MARGIN: f32 = 0.05;

/// The bodies that have another mass than their own in this step, in the order of their handles.
#[derive(Resource, Default)]
pub(crate) struct Burdened(Vec<RigidBodyHandle>);

/// The bodies that Rapier has not seen in a step yet.
#[derive(Resource, Clone, Debug, Default)]
pub(crate) struct NewBodies(pub Vec<RigidBodyHandle>);

/// Makes bodies with a great burden heavier for a step.
pub(crate) fn take_up(
    mut contexts: Query<(
        &RapierConfiguration,
        &RapierContextSimulation,
        &RapierContextColliders,
        &mut RapierRigidBodySet,
    )>,
    new: Res<NewBodies>,
    mut burdened: ResMut<Burdened>,
) {
    for (configuration, simulation, colliders, mut set) in &mut contexts {
        let awake = simulation.islands.active_bodies();
        let awake = awake.chain(new.0.iter().copied());
        let awake = awake.filter_map(|handle| set.bodies.get(handle));
        if !configuration.physics_pipeline_active || !is_ratio_above(BEARABLE, awake) {
            continue;
        }
        let mut burdens = Burdens::of(&simulation.narrow_phase, &colliders.colliders, &set.bodies);
        for [lower, upper] in met_first(&new, &colliders.colliders, &set.bodies) {
            burdens.add(Some(lower), upper, &set.bodies);
        }
        for (handle, lack) in burdens.unbearable(&set.bodies) {
            if let Some(body) = set.bodies.get_mut(handle) {
                body.set_additional_mass(lack, false);
                burdened.0.push(handle);
            }
        }
    }
}

/// Gives bodies their own masses back, after the step.
pub(crate) fn put_down(
    mut contexts: Query<(
        &RapierConfiguration,
        &RapierContextColliders,
        &mut RapierRigidBodySet,
    )>,
    mut burdened: ResMut<Burdened>,
    mut new: ResMut<NewBodies>,
) {
    let is_step =
        |(configuration, ..): (&RapierConfiguration, _, _)| configuration.physics_pipeline_active;
    if !new.0.is_empty() && contexts.iter().any(is_step) {
        new.0.clear();
    }
    if burdened.0.is_empty() {
        return;
    }
    for (_, colliders, mut set) in &mut contexts {
        for handle in burdened.0.drain(..) {
            if let Some(body) = set.bodies.get_mut(handle) {
                body.set_additional_mass_properties(MassProperties::default(), false);
                body.recompute_mass_properties_from_colliders(&colliders.colliders);
            }
        }
    }
}

/// The number and the generation of a body.
type Number = (u32, u32);

/// What bodies carry.
#[derive(Default)]
struct Burdens {
    /// The bodies on each body, in the order of their handles.
    loads: BTreeMap<Number, BTreeSet<Number>>,
    /// What carries each body; all that is not moved by forces counts as one.
    supports: BTreeMap<Number, BTreeSet<Option<Number>>>,
    masses: BTreeMap<Number, f32>,
}

impl Burdens {
    fn of(narrow_phase: &NarrowPhase, colliders: &ColliderSet, bodies: &RigidBodySet) -> Self {
        let mut burdens = Self::default();
        for pair in narrow_phase.contact_pairs() {
            if let Some([lower, Some(upper)]) = from_below(pair, colliders) {
                burdens.add(lower, upper, bodies);
            }
        }
        burdens
    }

    /// Notes that one body, or something that has none, carries another one.
    fn add(
        &mut self,
        lower: Option<RigidBodyHandle>,
        upper: RigidBodyHandle,
        bodies: &RigidBodySet,
    ) {
        let moved = |handle| {
            let body = bodies.get(handle).filter(|body| body.is_dynamic())?;
            Some((handle.into_raw_parts(), body.mass()))
        };
        let Some((upper, mass)) = moved(upper) else {
            return;
        };
        self.masses.insert(upper, mass);
        let lower = match lower.and_then(moved) {
            Some((lower, mass)) => {
                self.masses.insert(lower, mass);
                self.loads.entry(lower).or_default().insert(upper);
                Some(lower)
            }
            None => None,
        };
        self.supports.entry(upper).or_default().insert(lower);
    }

    /// The bodies whose burden is too great for their mass, in the order of their handles, with the mass that they lack, in kg.
    fn unbearable(&self, bodies: &RigidBodySet) -> Vec<(RigidBodyHandle, f32)> {
        let mut known = BTreeMap::new();
        let lacking = self.loads.keys().filter_map(|&number| {
            let handle = RigidBodyHandle::from_raw_parts(number.0, number.1);
            let own = self.masses[&number];
            let lack = self.burden(number, &mut known) / BEARABLE - own;
            let is_awake = bodies.get(handle).is_some_and(|body| !body.is_sleeping());
            (is_awake && lack > 0.0).then_some((handle, lack))
        });
        lacking.collect()
    }

    /// The mass, in kg, that a body carries. Each support of a body carries the same part of it.
    fn burden(&self, of: Number, known: &mut BTreeMap<Number, f32>) -> f32 {
        if let Some(burden) = known.get(&of) {
            return *burden;
        }
        // Bodies may carry each other.
        known.insert(of, 0.0);
        let loads = self.loads.get(&of).into_iter().flatten();
        let burden = loads
            .map(|&load| {
                let mass = self.masses[&load] + self.burden(load, known);
                mass / self.supports[&load].len() as f32
            })
            .sum();
        known.insert(of, burden);
        burden
    }
}

/// The bodies of a pair in touch, from below, if one carries the other.
fn from_below(pair: &ContactPair, colliders: &ColliderSet) -> Option<[Option<RigidBodyHandle>; 2]> {
    let mut manifolds = pair.solver_manifolds().iter();
    let rises = manifolds.find_map(|manifold| {
        let upward = manifold.data.normal.z;
        let carries = manifold.data.num_active_contacts() > 0 && upward.abs() > UPWARD;
        carries.then_some(upward > 0.0)
    })?;
    let [first, second] = bodies_of(pair, colliders);
    Some(match rises {
        true => [first, second],
        false => [second, first],
    })
}

/// Pairs of new bodies, from below, that may lie on each other: Rapier finds their contacts in the step.
fn met_first(
    new: &NewBodies,
    colliders: &ColliderSet,
    bodies: &RigidBodySet,
) -> Vec<[RigidBodyHandle; 2]> {
    let mut new: Vec<_> = new
        .0
        .iter()
        .filter_map(|&handle| {
            let body = bodies.get(handle).filter(|body| body.is_dynamic())?;
            let shapes = body.colliders().iter();
            let shapes = shapes.filter_map(|shape| colliders.get(*shape));
            let bounds = shapes.map(|shape| shape.compute_aabb().loosened(MARGIN / 2.0));
            Some((bounds.reduce(|all, part| all.merged(&part))?, handle))
        })
        .collect();
    new.sort_unstable_by(|(one, a), (other, b)| {
        let order = one.mins.x.total_cmp(&other.mins.x);
        order.then_with(|| a.into_raw_parts().cmp(&b.into_raw_parts()))
    });
    let mut met = Vec::new();
    for (place, (one, first)) in new.iter().enumerate() {
        let next = new[place + 1..].iter();
        for (other, second) in next.take_while(|(other, _)| other.mins.x <= one.maxs.x) {
            if one.mins.z + MARGIN >= other.maxs.z - MARGIN && one.intersects(other) {
                met.push([*second, *first]);
            } else if other.mins.z + MARGIN >= one.maxs.z - MARGIN && one.intersects(other) {
                met.push([*first, *second]);
            }
        }
    }
    met
}
