//! The simulator without a window.

use bevy::prelude::*;
use tabletop_core::StepApp as _;

use crate::TabletopSimPlugins;

/// A started simulator without window, ready to be [stepped](tabletop_core::StepApp::step).
pub fn headless_app() -> App {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, TabletopSimPlugins)).start();
    app
}
