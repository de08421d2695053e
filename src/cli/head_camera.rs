//! The head camera of pictures that nothing else is known of.

use crate::core::{HeadCamera, Picture};

/// A camera whose pictures have the size of one.
pub(super) fn taking(camera: &HeadCamera, picture: &Picture) -> HeadCamera {
    HeadCamera {
        width: picture.width,
        height: picture.height,
        ..*camera
    }
}
