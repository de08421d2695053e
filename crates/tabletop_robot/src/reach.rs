//! Where a limb's angles bring its end effector, and which angles bring it to a pose.

use bevy::prelude::*;
use tabletop_core::{LimbId, Robot};
use tabletop_geometry::{Pose, UNITS_PER_METER};
use tabletop_kinematics::Target;

use crate::articulation::{
    link_entities::base,
    tree::{Articulation, in_meters, in_units},
};

/// Angles of a limb, in rad, that bring its end effector to a pose in the table's frame, near its present angles.
///
/// # Errors
/// It cannot reach the pose; the error says how near it comes.
pub fn reach(world: &mut World, limb: LimbId, pose: Pose) -> Result<Vec<f64>, String> {
    search(world, limb, pose, usize::MAX)
}

/// [`reach`], but the search begins at the present angles alone: for poses so near that it would be of no use to begin anywhere else, and which
/// are refused much sooner.
///
/// # Errors
/// The search does not get there.
pub fn reach_nearby(world: &mut World, limb: LimbId, pose: Pose) -> Result<Vec<f64>, String> {
    search(world, limb, pose, 1)
}

fn search(world: &mut World, limb: LimbId, pose: Pose, starts: usize) -> Result<Vec<f64>, String> {
    let limb_layout = world.resource::<Articulation>().layout.limb(limb).clone();
    let arm = limb_layout.name;
    if !pose.location.is_finite() || !pose.rotation.is_finite() {
        return Err(format!(
            "the {arm} arm cannot reach for {pose:?}: not a pose"
        ));
    }
    let base = base(world);
    let robot = world.resource::<Robot>();
    let (chain, end_effector) = world.resource::<Articulation>().chain(limb);
    let target = in_meters(base.inverse() * pose) * end_effector.inverse();
    chain
        .solve_from(
            &Target::Pose(target),
            &robot.positions_of(&limb_layout.joints),
            starts,
        )
        .map_err(|unreachable| {
            format!(
                "the {arm} arm cannot reach {:.3}: it comes no nearer than {:.3} units and {:.1}°",
                pose.location,
                unreachable.miss.position * UNITS_PER_METER,
                unreachable.miss.rotation.to_degrees()
            )
        })
}

/// The pose, in the table's frame, of a limb's end effector at these angles, in rad.
pub fn end_effector_at(world: &mut World, limb: LimbId, angles: &[f64]) -> Pose {
    let base = base(world);
    let (chain, end_effector) = world.resource::<Articulation>().chain(limb);
    base * in_units(chain.tip(angles) * end_effector)
}
