//! Mappings: which key of an observation is which picture, state or text, and which number of an action moves what.

mod check;
mod columns;
mod comparison;
mod error;
mod policy_mapping;
mod reading;

pub use columns::{ActionColumn, PosePart, ScaledJoint, StateColumn};
pub use comparison::RobotNames;
pub use error::MappingError;
pub use policy_mapping::{MappedActions, MappedCamera, MappedImage, MappedState, PolicyMapping};

/// A mapping that tests change.
#[cfg(test)]
const EXAMPLE: &str = "PolicyMapping(
    images: [(key: \"image\", camera: OnLimb(limb: \"arm\", at: (0, 0, 1), fov: 1), size: (8, 8))],
    states: [(key: \"state\", columns: [Joint(name: \"elbow\"), Constant(1)])],
    prompt: \"prompt\",
    actions: Columns(rate: 20, horizon: 4, columns: [Position(name: \"elbow\"), Ignored]),
)";
