//! Policies by the kind of their decisions.

use tabletop_core::HeadCamera;

use crate::{picture_policy::PicturePolicy, remote_policy::RemotePolicy};

/// A policy that acts for the robot.
pub enum ActingPolicy {
    /// It decides by pictures which object is to be put where.
    Places(Box<dyn PicturePolicy>),
    /// So does this one, which somebody serves.
    ServedPlaces(Box<RemotePolicy>),
    /// It moves the robot's joints.
    Motions(Box<RemotePolicy>),
}

impl ActingPolicy {
    /// The policy that decides by pictures of the head camera.
    pub fn picture_policy(&self) -> Option<&dyn PicturePolicy> {
        match self {
            Self::Places(policy) => Some(&**policy),
            Self::ServedPlaces(policy) => Some(&**policy),
            Self::Motions(_) => None,
        }
    }

    /// The policy that somebody serves.
    pub const fn served(&self) -> Option<&RemotePolicy> {
        match self {
            Self::Places(_) => None,
            Self::ServedPlaces(policy) | Self::Motions(policy) => Some(policy),
        }
    }

    /// Gives the head camera's pictures the size that it needs.
    pub fn resize(&self, head: &mut HeadCamera) {
        let size = self.picture_policy().and_then(PicturePolicy::picture_size);
        if let Some([width, height]) = size {
            (head.width, head.height) = (width, height);
        }
    }
}
