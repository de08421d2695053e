//! Recordings as pages that a browser shows without network: what was done, a player of the pictures, plots and numbers of one recording, or a
//! table of many; and how often a policy did tasks.

mod chapter;
mod html;
mod judgement_page;
mod overview;
mod page;
mod plot;
mod timeline;

pub use chapter::Chapter;
pub use judgement_page::judgement_page;
pub use overview::OverviewRow;
pub use page::{GENERATOR, overview_page, recording_page};
