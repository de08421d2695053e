//! The files of a task: those that it may name, and their bytes.

mod arena;
mod file_tree;

pub(crate) use arena::Arena;
pub(crate) use file_tree::{FileTree, TaskPath, read_file};

/// Largest size of a task file with all that it includes, in bytes: 16 MiB.
pub const MAX_FILE_BYTES: usize = 16 << 20;
