//! Recordings as pages that a browser shows without network: what was done, a player of the pictures, plots and numbers of one recording, or a
//! table of many.

mod chapter;
mod html;
mod overview;
mod page;
mod plot;
mod timeline;

pub use chapter::Chapter;
pub use overview::OverviewRow;
pub use page::{GENERATOR, overview_page, recording_page};
