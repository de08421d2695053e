//! Memories of earlier steps, which Rapier must not have.

use bevy_rapier3d::{
    prelude::{RapierContextJoints, RapierContextSimulation},
    rapier::prelude::{CCDSolver, PhysicsPipeline},
};

/// Lets Rapier forget earlier steps.
pub(crate) fn forget(simulation: &mut RapierContextSimulation, joints: &RapierContextJoints) {
    // It keeps the fixed shapes from step to step, and learns of changes only in steps in which something is fast: it would look for shapes
    // that are gone.
    simulation.ccd_solver = CCDSolver::new();
    if !joints.impulse_joints.is_empty() {
        // The pipeline keeps the grouping of joints from step to step, and a new pipeline would group them differently: a world that was
        // restored with one would go on differently.
        simulation.pipeline = PhysicsPipeline::new();
    }
}
