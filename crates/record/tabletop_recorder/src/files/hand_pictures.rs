//! The pictures of hand cameras in a recording.

use tabletop_core::HandCamera;

/// The hand cameras whose pictures a recording holds, too. Where one does, a moving joint of the robot is reason enough for
/// the pictures of a frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum HandPictures {
    /// None.
    #[default]
    None,
    /// All that the robot has.
    OfAll,
    /// These.
    Of(Vec<HandCamera>),
}
