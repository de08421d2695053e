//! Display settings (report 2.3, figure 3), the display's offer, and the replacement of settings that it does not offer.

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
