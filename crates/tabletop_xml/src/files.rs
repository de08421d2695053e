//! The files that a task is made of: which it may name, and their bytes.

mod arena;
mod file_tree;

pub(crate) use arena::Arena;
pub(crate) use file_tree::{FileTree, TaskPath, read_file};

/// The most bytes that a task file can have, with all that it includes: 16 MiB.
pub const MAX_FILE_BYTES: usize = 16 << 20;
