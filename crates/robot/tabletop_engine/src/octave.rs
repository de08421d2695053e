//! Scripts in the Matlab language, and how GNU Octave and MATLAB differ in running them.

pub(crate) mod hint;
pub(crate) mod script_folder;
pub(crate) mod stubs;
pub(crate) mod warning_stack;
