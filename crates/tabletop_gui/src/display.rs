//! Display settings (report 2.3, figure 3), what the display offers, and what becomes of a choice that it does not offer.

mod antialiasing;
mod mode;
mod offer;
mod resolution;
mod settings;
#[cfg(test)]
mod tests;

pub use antialiasing::Antialiasing;
pub use mode::ScreenMode;
pub use offer::DisplayOffer;
pub use resolution::Resolution;
pub use settings::{CONCERN, DisplaySettings};

pub use crate::panels::display::{DisplayDialog, DisplayRequest, TITLE};
