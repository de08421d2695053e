//! Effort where it is needed: the engine's precision in the next step, chosen from its state alone.
//!
//! The solver is most of a tick. An object that stands alone needs few sub-steps; one deep in a stack, or handled, needs many; a
//! landing needs many sweeps.

mod depth;
mod engine;
mod landing;
mod substeps;
mod touches;
mod waking;

use bevy::prelude::*;
use bevy_rapier3d::{
    prelude::*,
    rapier::prelude::{
        CCDSolver, ColliderSet, ContactPair, IntegrationParameters, PhysicsPipeline, RigidBody,
        RigidBodySet,
    },
};
use tabletop_core::Held;

pub use engine::Engine;
pub(crate) use engine::REACH;
pub(crate) use substeps::{BASE_SUBSTEPS, SUBSTEPS_OF_FREE};

use crate::{holding::JustReleased, settings::PhysicsSettings};
use landing::landing_speed;
use substeps::{MOST_SUBSTEPS, SubstepFactors, substeps, substeps_of_unmoved};
use touches::{Touches, bodies_of};

/// Distance at which contacts are predicted, in units.
pub(crate) const PREDICTION: f32 = 0.2;

/// The same at most, while something is fast: twice as far as a body moves in a tick after a fall of 100 units.
const FARTHEST_PREDICTION: f32 = 6.0;

/// The way at most, in units, of a body that is seen ahead when it approaches a hand or a link.
const WAY_TO_HANDS: f32 = 3.0;

/// Speed, in units/s, from which the way of a body to a hand or a link is seen ahead.
const SPEED_TO_HANDS: f32 = 1.0;

/// The same of a body that is near other things, too: Rapier would forget its contact with what it is leaving.
const SPEED_TO_HANDS_BESIDE_OTHERS: f32 = 12.0;

/// Angular speed, in rad/s, from which a body's way is not seen ahead: Rapier would not see where its edges go.
const MOST_TURNING: f32 = 1.0;

/// Speed, in units/s, from which collision detection is continuous.
const SPEED_OF_CCD: f32 = 6.0;

/// Largest decrease of an island's sub-steps from one tick to the next.
const DECAY: usize = 2;

/// Number of ticks for which everything has the most sub-steps after a hand or a robot was near something.
const HANDLING_TICKS: u32 = 30;

/// Number of ticks for which the engine sweeps as for a landing. Continuous collision detection stops a fast body a little above the surface
/// that it lands on, and the body falls the rest of the way in the next ticks.
const LANDING_TICKS: u32 = 4;

/// Number of ticks without handling and landings from which low stacks have sweeps of their own. A change of sweeps moves a stack a little, so
/// what may sleep is to sleep before it.
const CALM_TICKS: u32 = 30;

/// Numbers of the solver's sweeps over the contacts in a sub-step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Sweeps {
    /// Sweeps that correct speeds and depths, without friction.
    correcting: usize,
    /// Sweeps that correct speeds only, with friction.
    plain: usize,
}

/// Sweeps in most ticks. With more plain sweeps, friction would let towers creep.
const SWEEPS: Sweeps = Sweeps {
    correcting: 8,
    plain: 1,
};

/// Sweeps while everything awake stands in low stacks: with the fewest sub-steps they hold those as still.
const LOW_STACK_SWEEPS: Sweeps = Sweeps {
    correcting: 12,
    plain: 1,
};

/// Sweeps while hands or robots handle something: an object squeezed between them is stiffer this way.
const HANDLING_SWEEPS: Sweeps = Sweeps {
    correcting: 1,
    plain: 1,
};

/// Sweeps while something lands flat. Its corners must share the impact equally before friction acts on the rest, otherwise friction turns the
/// difference into a slide.
const LANDING_SWEEPS: Sweeps = Sweeps {
    correcting: 4,
    plain: 32,
};

/// The number of ticks for which the engine takes more care than its state calls for.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Resource)]
pub struct Care {
    handling: u32,
    landing: u32,
    /// The ticks without either, up to [`CALM_TICKS`].
    calm: u32,
}

pub(crate) fn spend_effort(
    mut contexts: Query<(
        &mut RapierContextSimulation,
        &RapierContextColliders,
        &mut RapierRigidBodySet,
        &RapierContextJoints,
    )>,
    released: Query<(), With<JustReleased>>,
    held: Query<&RapierRigidBodyHandle, With<Held>>,
    settings: Res<PhysicsSettings>,
    mut care: ResMut<Care>,
) {
    if !released.is_empty() {
        care.landing = LANDING_TICKS;
    }
    for (mut simulation, colliders, mut bodies, joints) in &mut contexts {
        let simulation = &mut *simulation;
        // It keeps the fixed shapes from step to step, and learns of changes only in steps in which something is fast: it would look for shapes
        // that are gone.
        simulation.ccd_solver = CCDSolver::new();
        if !joints.impulse_joints.is_empty() {
            // The pipeline keeps the grouping of joints from step to step, and a new pipeline would group them differently: a world that was
            // restored with one would go on differently.
            simulation.pipeline = PhysicsPipeline::new();
        }
        let mut engine = Engine {
            parameters: &mut simulation.integration_parameters,
            islands: &mut simulation.islands,
            broad_phase: &simulation.broad_phase,
            narrow_phase: &simulation.narrow_phase,
            bodies: &mut bodies.bodies,
            colliders: &colliders.colliders,
            joints: &joints.impulse_joints,
            gravity: settings.gravity,
        };
        engine.wake_what_is_hit(held.iter().map(|handle| handle.0));
        care.spend(engine);
    }
}

impl Care {
    /// Chooses the engine's precision in the next step.
    pub fn spend(&mut self, engine: Engine) {
        if engine.islands.num_active_bodies() == 0 {
            *self = Self::default();
            Mode::UNKNOWN.set(engine.parameters);
            return;
        }
        let touches = Touches::of(&engine);
        self.handling = ticks_left(self.handling, HANDLING_TICKS, touches.is_handling);
        let is_handling = self.handling > 0;

        let (mut landing, mut fastest, mut is_any_fast) = (0.0f32, 0.0f32, false);
        let mut awake = Vec::with_capacity(engine.islands.num_active_bodies());
        for handle in engine.islands.active_bodies() {
            let body = &engine.bodies[handle];
            if !body.is_dynamic() {
                awake.push((handle, None));
                continue;
            }
            let factors = SubstepFactors::of(handle, &engine, &touches);
            fastest = fastest.max(engine.speed_of_fall(body));
            is_any_fast |= is_handling || engine.fastest_point(body) > SPEED_OF_CCD;
            if !factors.is_jointed && !factors.is_handled {
                landing = landing.max(landing_speed(&engine, handle));
            }
            awake.push((handle, Some(factors)));
        }
        self.landing = ticks_left(self.landing, LANDING_TICKS, landing > 0.0);
        let is_landing = self.landing > 0;
        self.calm = match is_handling || is_landing {
            true => 0,
            false => CALM_TICKS.min(self.calm + 1),
        };
        let mut moving = awake.iter().filter_map(|(_, factors)| *factors);
        let are_low_stacks = self.calm == CALM_TICKS && moving.all(SubstepFactors::is_in_low_stack);

        for (handle, factors) in awake {
            let body = &engine.bodies[handle];
            let before = substeps(body);
            let needed = match factors {
                None => substeps_of_unmoved(body),
                Some(_) if is_handling => MOST_SUBSTEPS,
                Some(_) if are_low_stacks => BASE_SUBSTEPS.max(before.saturating_sub(DECAY)),
                Some(factors) => factors.substeps().max(before.saturating_sub(DECAY)),
            };
            let way = factors.map_or_else(|| body.soft_ccd_prediction(), |it| way_ahead(it, body));
            if needed != before || way != body.soft_ccd_prediction() {
                let body = &mut engine.bodies[handle];
                body.set_additional_solver_iterations(needed - BASE_SUBSTEPS);
                body.set_soft_ccd_prediction(way);
            }
        }

        let sweeps = match (is_landing, is_handling) {
            (true, _) => LANDING_SWEEPS,
            (false, true) => HANDLING_SWEEPS,
            (false, false) if are_low_stacks => LOW_STACK_SWEEPS,
            (false, false) => SWEEPS,
        };
        // A body beyond this distance is touched in one point, whatever its shape. The broad phase looks half as far for each of two bodies.
        // Rapier's own prediction for fast bodies (soft CCD) forgets the contact with what a body is leaving, or sliding along: what presses
        // it back in the same tick would press it in.
        let prediction = (landing.max(2.0 * fastest) * engine.parameters.dt)
            .clamp(PREDICTION, FARTHEST_PREDICTION);
        let mode = Mode {
            sweeps,
            prediction,
            recycles: !is_handling && !is_landing,
            // Among contacts that are seen far ahead, a merged one may lack the corner that touches.
            clusters: is_handling && prediction <= PREDICTION,
            is_continuous: is_any_fast,
        };
        mode.set(engine.parameters);
    }
}

/// How far the way of a body to a hand or a link is seen ahead, in units.
fn way_ahead(factors: SubstepFactors, body: &RigidBody) -> f32 {
    let speed_to_hands = match factors.is_near_others {
        true => SPEED_TO_HANDS_BESIDE_OTHERS,
        false => SPEED_TO_HANDS,
    };
    let is_seen_ahead = factors.is_near_hand
        && body.linvel().length() > speed_to_hands
        && body.angvel().length() < MOST_TURNING;
    match is_seen_ahead {
        true => WAY_TO_HANDS,
        false => 0.0,
    }
}

/// The ticks that are left of `ticks`, or all again.
fn ticks_left(ticks: u32, all: u32, begin_again: bool) -> u32 {
    match begin_again {
        true => all,
        false => ticks.saturating_sub(1),
    }
}

/// Settings of all bodies for a step.
struct Mode {
    sweeps: Sweeps,
    /// Distance at which contacts are predicted, in units.
    prediction: f32,
    /// True if contacts of bodies that have hardly moved are kept.
    recycles: bool,
    /// True if contacts of several parts with the same normal are merged.
    clusters: bool,
    /// True if collision detection is continuous.
    is_continuous: bool,
}

impl Mode {
    /// Settings while everything sleeps and new bodies may appear.
    const UNKNOWN: Self = Self {
        sweeps: SWEEPS,
        prediction: PREDICTION,
        recycles: false,
        clusters: false,
        is_continuous: true,
    };

    fn set(self, parameters: &mut IntegrationParameters) {
        parameters.num_internal_pgs_iterations = self.sweeps.correcting;
        parameters.num_internal_stabilization_iterations = self.sweeps.plain;
        parameters.normalized_prediction_distance = self.prediction;
        parameters.contact_recycling = self.recycles;
        parameters.contact_clustering = self.clusters;
        parameters.max_ccd_substeps = usize::from(self.is_continuous);
    }
}

/// The share of a pair's reported impulses that acted in the last step: the engine counts the impulses at the beginning of the
/// step as well as those of all sub-steps.
pub fn impulse_share(pair: &ContactPair, bodies: &RigidBodySet, colliders: &ColliderSet) -> f32 {
    let touching = bodies_of(pair, colliders).into_iter().flatten();
    let most = touching.filter_map(|body| Some(substeps(bodies.get(body)?)));
    let substeps = most.max().unwrap_or(BASE_SUBSTEPS) as f32;
    substeps / (substeps + 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn care_lasts_and_ends() {
        let mut ticks = ticks_left(0, 3, true);
        for left in [2, 1, 0, 0] {
            ticks = ticks_left(ticks, 3, false);
            assert_eq!(ticks, left);
        }
        assert_eq!(ticks_left(2, 3, true), 3);
    }
}
