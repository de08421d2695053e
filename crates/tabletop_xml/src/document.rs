//! A file as a tree of elements, each with its place, of bounded size.

pub(crate) mod build;
pub(crate) mod decode;
mod prolog;
pub(crate) mod syntax;
pub(crate) mod tree;
