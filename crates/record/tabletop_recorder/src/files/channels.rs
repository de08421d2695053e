//! The files beside the pictures.

/// The files of a frame beside its picture, of the same pixels, as PNG files of 16 bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Channels {
    /// `<frame>.depth.png`: how far away it is, in tenths of a millimetre along the axis of view; 0 where nothing is.
    pub depth: bool,
    /// `<frame>.ids.png`: what it is; 0 where nothing is, 1 for the table, n + 1 for the object of the recording's n-th `create`
    /// line, 65535 for anything else.
    pub ids: bool,
}
