//! The simulator as a library: its plugins, worlds without a window, and the files inside the program.
//!
//! ```
//! use tabletop_core::prelude::*;
//! use tabletop_sim::headless_app;
//!
//! let mut app = headless_app();
//! app.world_mut()
//!     .write_command(SceneCommand::Load("tablesetup/default.xml".into()));
//! app.step(60);
//! assert!(app.world().resource::<ObjectIndex>().get("RedBlock").is_some());
//! ```

mod episodes;
pub mod final_state;
mod headless;
mod plugins;
pub mod progress;
mod reset;
pub mod robots;
pub mod scene_dump;
pub mod settings;
pub mod shipped;
pub mod task_files;

pub use episodes::run_episodes;
pub use headless::{headless_app, headless_app_with, headless_world};
pub use plugins::TabletopSimPlugins;
pub use reset::{ResetPlugin, remember_beginning, reset};
pub use settings::RecordedSettingsPlugin;
pub use shipped::ShippedFilesPlugin;
