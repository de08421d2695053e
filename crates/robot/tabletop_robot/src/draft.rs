//! A first `robot.ron` for a URDF: what its tree says, and questions where it says nothing.

mod anatomy;
mod fingers;
mod hand;
mod home;
mod pads;
#[cfg(test)]
mod tests;
mod text;

use bevy::math::DAffine3;
use tabletop_kinematics::{ArmChain, ModelError, RobotModel};
use thiserror::Error;

use crate::{Description, DescriptionError, DescriptionSource};
use anatomy::{Anatomy, Branch};
use hand::DraftHand;
use home::home;
use text::{DraftLimb, LayoutDraft};

/// Height of the shoulder, in m above the robot's origin, from which on the robot stands on the floor and not on the table.
const STANDING: f64 = 0.45;

/// Height, in m, of the shoulder of such a robot above the table.
const SHOULDER: f64 = 0.35;

/// Reason why there is no first `robot.ron` for a URDF.
#[derive(Debug, Error)]
pub enum DraftError {
    /// The URDF cannot be used.
    #[error(transparent)]
    Urdf(#[from] ModelError),
    /// It has nothing that looks like a limb.
    #[error(
        "no limb was found: neither three moving joints in a row nor one that carries fingers; write the robot.ron by hand (docs/robot.md)"
    )]
    NoLimb,
    /// What was found makes no robot.
    #[error("what was found makes no robot: {0}; write the robot.ron by hand (docs/robot.md)")]
    Unusable(Box<DescriptionError>),
}

/// The text of a first `robot.ron` for the URDF of a source, which is `urdf` seen from the new file. It loads; what it only guesses stands under a
/// comment with a question.
///
/// # Errors
/// The URDF has a fault, or no limbs were found in it.
pub fn draft(source: &DescriptionSource, urdf: &str) -> Result<String, DraftError> {
    let mut model = RobotModel::from_urdf(&source.urdf)?;
    let Anatomy {
        limbs,
        neck,
        shared,
        others,
    } = Anatomy::of(&model);
    if limbs.is_empty() {
        return Err(DraftError::NoLimb);
    }
    let still = shared.iter().map(|&joint| {
        let joint = model.joint(joint);
        let [least, largest] = joint.limits;
        (joint.name.clone(), 0.0_f64.max(least).min(largest))
    });
    let still: Vec<_> = still.collect();
    for (&joint, (_, position)) in shared.iter().zip(&still) {
        model.hold(joint, *position);
    }
    let table = table_below(&model, &limbs);
    let found = limbs.iter().filter_map(|branch| {
        let hand = DraftHand::of(&model, source, branch)?;
        let chain = ArmChain::between(&model, &model.link(model.root()).name, &hand.link).ok()?;
        let tool = DAffine3::from_mat3_translation(hand.axes, hand.at);
        Some(DraftLimb {
            home: home(&chain, tool, table),
            branch,
            hand,
        })
    });
    let draft = LayoutDraft {
        model: &model,
        urdf,
        limbs: found.collect(),
        neck,
        still,
        others,
        table,
    };
    let text = draft.to_string();
    let source = DescriptionSource {
        layout: Some(text.clone()),
        ..source.clone()
    };
    Description::read(source).map_err(|error| DraftError::Unusable(Box::new(error)))?;
    Ok(text)
}

/// Height of the table's top in the robot's frame, in m: a robot without legs stands on it.
fn table_below(model: &RobotModel, limbs: &[Branch]) -> f64 {
    let frames = model.frames(&model.zero());
    let shoulders = limbs.iter().filter_map(|limb| limb.joints.first());
    let heights = shoulders.map(|&joint| frames[model.joint(joint).child].translation.z);
    let highest = heights.fold(f64::NEG_INFINITY, f64::max);
    match highest > STANDING {
        true => highest - SHOULDER,
        false => 0.0,
    }
}
