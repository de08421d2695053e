//! The documentation as a book: one page with contents, search and the way from chapter to chapter, which a browser shows without network.

mod book;
mod chapter;
mod contents;
mod sources;

pub use book::{GENERATOR, book};
