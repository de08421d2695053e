//! The robot at the table: a Baxter, or another one that a `robot.ron` describes (report section 5). Its description, the bodies that its joints
//! carry, its looks and its cameras.
//!
//! [`Robot`](tabletop_core::Robot) is its state. It starts hidden: it can then neither be seen nor touched, but its camera works. A drive moves
//! it, in the simulation that of `tabletop_drive`.

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod articulation;
mod description;
mod draft;
mod hand_cameras;
pub mod look;
mod motor_gap;
mod plugin;
mod reach;
mod source;
mod survey;

pub use articulation::{
    link_entities::{
        FRICTION, LinkEntities, RobotLink, base, enable, make_passive, positions, spawn, teleport,
    },
    passive_links::PassiveLinks,
    tree::{
        Articulation, Body, Carrier, JointAxis, Positions, Posture, TreePosition, in_meters,
        in_units,
    },
};
pub use description::{Description, DescriptionError};
pub use draft::{DraftError, draft};
pub use hand_cameras::HandCameraCarrier;
pub use motor_gap::{MotorGap, MotorGapKind};
pub use plugin::RobotPlugin;
pub use reach::{end_effector_at, reach, reach_nearby};
pub use source::DescriptionSource;
pub use survey::{Shortcoming, Survey};

/// The names that most users of this crate need.
pub mod prelude {
    #[doc(hidden)]
    pub use crate::{Description, RobotLink, RobotPlugin};
}
