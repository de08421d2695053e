//! The files that a task is made of: which it may name, and their bytes.

mod arena;
mod file_tree;

pub(crate) use arena::Arena;
pub(crate) use file_tree::{FileTree, TaskPath, read_file};
