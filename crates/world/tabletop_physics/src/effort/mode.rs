//! Settings of all bodies for a step.

use bevy_rapier3d::rapier::prelude::IntegrationParameters;

/// Distance at which contacts are predicted, in units.
pub(crate) const PREDICTION: f32 = 0.2;

/// The same at most, while something is fast: twice as far as a body moves in a tick after a fall of 100 units.
pub(super) const FARTHEST_PREDICTION: f32 = 6.0;

/// Numbers of the solver's sweeps over the contacts in a sub-step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Sweeps {
    /// Sweeps that correct speeds and depths, without friction.
    correcting: usize,
    /// Sweeps that correct speeds only, with friction.
    plain: usize,
}

/// Sweeps in most ticks. With more plain sweeps, friction would let towers creep.
pub(super) const SWEEPS: Sweeps = Sweeps {
    correcting: 8,
    plain: 1,
};

/// Sweeps while everything awake stands in low stacks: with the fewest sub-steps they hold those as still.
pub(super) const LOW_STACK_SWEEPS: Sweeps = Sweeps {
    correcting: 12,
    plain: 1,
};

/// Sweeps while hands or robots handle something: an object squeezed between them is stiffer this way.
pub(super) const HANDLING_SWEEPS: Sweeps = Sweeps {
    correcting: 1,
    plain: 1,
};

/// Sweeps while something lands flat. Its corners must share the impact equally before friction acts on the rest, otherwise friction turns the
/// difference into a slide.
pub(super) const LANDING_SWEEPS: Sweeps = Sweeps {
    correcting: 4,
    plain: 32,
};

/// Settings of all bodies for a step.
pub(super) struct Mode {
    pub sweeps: Sweeps,
    /// Distance at which contacts are predicted, in units.
    pub prediction: f32,
    /// True if contacts of bodies that have hardly moved are kept.
    pub recycles: bool,
    /// True if contacts of several parts with the same normal are merged.
    pub clusters: bool,
    /// True if collision detection is continuous.
    pub is_continuous: bool,
}

impl Mode {
    /// Settings while everything sleeps and new bodies may appear.
    pub const UNKNOWN: Self = Self {
        sweeps: SWEEPS,
        prediction: PREDICTION,
        recycles: false,
        clusters: false,
        is_continuous: true,
    };

    pub fn set(self, parameters: &mut IntegrationParameters) {
        parameters.num_internal_pgs_iterations = self.sweeps.correcting;
        parameters.num_internal_stabilization_iterations = self.sweeps.plain;
        parameters.normalized_prediction_distance = self.prediction;
        parameters.contact_recycling = self.recycles;
        parameters.contact_clustering = self.clusters;
        parameters.max_ccd_substeps = usize::from(self.is_continuous);
    }
}
