//! Limbs by their bodies.

use tabletop_core::{LimbName, RobotLayout};

/// The limb that a body of the robot belongs to.
pub(crate) fn limb_of(layout: &RobotLayout, body: &str) -> Option<LimbName> {
    let mut limbs = layout.limbs.iter();
    let limb = limbs.find(|limb| body.starts_with(limb.name.as_str()))?;
    Some(limb.name)
}
