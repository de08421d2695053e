//! The files of a recording.

pub(crate) mod bounds;
pub(crate) mod channels;
pub(crate) mod destination;
pub(crate) mod durability;
pub(crate) mod event;
pub(crate) mod folder;
pub(crate) mod format;
pub(crate) mod frame;
pub(crate) mod hand_pictures;
pub(crate) mod intent;
pub(crate) mod joints;
pub(crate) mod json;
pub(crate) mod limits;
pub(crate) mod log_file;
pub(crate) mod new_recording;
pub(crate) mod notes;
pub(crate) mod picture;
pub(crate) mod properties;
pub(crate) mod recording_files;
pub(crate) mod recording_writer;
pub(crate) mod segment_mark;
pub(crate) mod session;
pub(crate) mod states;
pub(crate) mod whole_recording;
