//! Input by keys and mouse.

pub(crate) mod around;
pub(crate) mod axis_turn;
pub(crate) mod clear_view;
pub(crate) mod drag;
pub(crate) mod focus;
pub(crate) mod history_keys;
pub(crate) mod jog;
pub(crate) mod key_moves;
pub(crate) mod keys;
pub(crate) mod measure;
pub(crate) mod mechanism_keys;
pub(crate) mod mouse;
pub(crate) mod navigate;
pub(crate) mod object_keys;
pub(crate) mod operable;
pub(crate) mod pick;
pub(crate) mod plane;
pub(crate) mod pointer;
pub(crate) mod recording_keys;
pub(crate) mod regarded;
pub(crate) mod robot_keys;
pub(crate) mod script_control;
pub(crate) mod snapshot;
pub(crate) mod travel;
pub(crate) mod turns;
pub(crate) mod wheel;
