//! The choice of solver settings, and the ticks for which earlier states count too.

use bevy::prelude::*;
use bevy_rapier3d::rapier::prelude::{RigidBody, RigidBodyHandle};

use super::{
    engine::Engine,
    landing::landing_speed,
    mode::{
        FARTHEST_PREDICTION, HANDLING_SWEEPS, LANDING_SWEEPS, LOW_STACK_SWEEPS, Mode, PREDICTION,
        SWEEPS,
    },
    substeps::{BASE_SUBSTEPS, MOST_SUBSTEPS, SubstepFactors, substeps, substeps_of_unmoved},
    touches::Touches,
};

/// Longest contact prediction, in units, for a body that approaches a hand or a link.
const WAY_TO_HANDS: f32 = 3.0;

/// Speed, in units/s, from which contacts with a hand or a link are predicted.
const SPEED_TO_HANDS: f32 = 1.0;

/// The same speed for a body that is near other bodies, too: Rapier would forget its contact with the body that it is leaving.
const SPEED_TO_HANDS_BESIDE_OTHERS: f32 = 12.0;

/// Angular speed, in rad/s, from which no contacts are predicted: Rapier would not predict where its edges go.
const MOST_TURNING: f32 = 1.0;

/// Speed, in units/s, from which collision detection is continuous.
const SPEED_OF_CCD: f32 = 6.0;

/// Largest decrease of an island's sub-steps from one tick to the next.
const DECAY: usize = 2;

/// Number of ticks for which everything has the most sub-steps after a hand or a robot was near something.
const HANDLING_TICKS: u32 = 30;

/// Number of ticks for which the solver has the sweeps of a landing. Continuous collision detection stops a fast body a little above the surface
/// that it lands on, and the body falls the rest of the way in the next ticks.
const LANDING_TICKS: u32 = 4;

/// Number of ticks without handling and landings from which low stacks have sweeps of their own. A change of sweeps moves a stack a little, so
/// bodies that can sleep are to sleep before it.
const CALM_TICKS: u32 = 30;

/// The number of ticks for which the solver settings are finer than the present state needs.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Resource)]
pub struct Care {
    handling: u32,
    landing: u32,
    /// The ticks without either, up to [`CALM_TICKS`].
    calm: u32,
}

impl Care {
    /// Chooses the solver settings of the next step.
    pub fn spend(&mut self, engine: Engine) {
        if engine.islands.num_active_bodies() == 0 {
            *self = Self::default();
            Mode::UNKNOWN.set(engine.parameters);
            return;
        }
        let touches = Touches::of(&engine);
        let mut motion = Motion::default();
        let mut awake = Vec::with_capacity(engine.islands.num_active_bodies());
        for handle in engine.islands.active_bodies() {
            let is_dynamic = engine.bodies[handle].is_dynamic();
            let factors = is_dynamic.then(|| SubstepFactors::of(handle, &engine, &touches));
            if let Some(factors) = factors {
                motion.add(&engine, handle, factors);
            }
            awake.push((handle, factors));
        }
        self.pass_tick(touches.is_handling, motion.landing > 0.0);
        let mut moving = awake.iter().filter_map(|(_, factors)| *factors);
        let are_low_stacks = self.calm == CALM_TICKS && moving.all(SubstepFactors::is_in_low_stack);

        for (handle, factors) in awake {
            let body = &engine.bodies[handle];
            let before = substeps(body);
            let needed = match factors {
                None => substeps_of_unmoved(body),
                Some(_) if self.is_handling() => MOST_SUBSTEPS,
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
        let prediction = engine.affordable(motion.prediction(engine.parameters.dt));
        let mode = self.mode(motion, are_low_stacks, prediction);
        mode.set(engine.parameters);
    }

    /// Sets the finest solver settings from the next step on, for an object that was released.
    pub(crate) fn expect_landing(&mut self) {
        self.landing = LANDING_TICKS;
    }

    fn pass_tick(&mut self, handles: bool, lands: bool) {
        self.handling = ticks_left(self.handling, HANDLING_TICKS, handles);
        self.landing = ticks_left(self.landing, LANDING_TICKS, lands);
        self.calm = match self.is_handling() || self.is_landing() {
            true => 0,
            false => CALM_TICKS.min(self.calm + 1),
        };
    }

    fn is_handling(self) -> bool {
        self.handling > 0
    }

    fn is_landing(self) -> bool {
        self.landing > 0
    }

    fn mode(self, motion: Motion, are_low_stacks: bool, prediction: f32) -> Mode {
        let sweeps = match (self.is_landing(), self.is_handling()) {
            (true, _) => LANDING_SWEEPS,
            (false, true) => HANDLING_SWEEPS,
            (false, false) if are_low_stacks => LOW_STACK_SWEEPS,
            (false, false) => SWEEPS,
        };
        let fastest_point = motion.fastest_point;
        Mode {
            sweeps,
            prediction,
            recycles: !self.is_handling() && !self.is_landing(),
            // Among contacts predicted far ahead, a cluster may lack the corner that touches.
            clusters: self.is_handling() && prediction <= PREDICTION,
            is_continuous: fastest_point.is_some_and(|it| self.is_handling() || it > SPEED_OF_CCD),
        }
    }
}

/// The greatest speeds of the bodies that move freely, in units/s.
#[derive(Clone, Copy, Default)]
struct Motion {
    /// Of a body that lands flat, or 0.
    landing: f32,
    /// Of a body at the end of the step, if nothing stops it.
    fall: f32,
    /// The same of any point of a body, if one moves freely.
    fastest_point: Option<f32>,
}

impl Motion {
    /// Distance of contact prediction. A body beyond it is touched in one point, with any shape. The broad phase looks half as far for each of
    /// two bodies. Rapier's own prediction for fast bodies (soft CCD) forgets the contact with a body that is left or slid along: a body that
    /// presses back in the same tick would press in.
    fn prediction(self, dt: f32) -> f32 {
        (self.landing.max(2.0 * self.fall) * dt).clamp(PREDICTION, FARTHEST_PREDICTION)
    }

    fn add(&mut self, engine: &Engine, handle: RigidBodyHandle, factors: SubstepFactors) {
        let body = &engine.bodies[handle];
        let point = engine.fastest_point(body);
        self.fall = self.fall.max(engine.speed_of_fall(body));
        self.fastest_point = Some(self.fastest_point.map_or(point, |most| most.max(point)));
        if !factors.is_jointed && !factors.is_handled {
            self.landing = self.landing.max(landing_speed(engine, handle));
        }
    }
}

/// Distance of the contact prediction for a body near a hand or a link, in units.
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
