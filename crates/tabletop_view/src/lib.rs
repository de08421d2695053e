//! What the window shows: the table, the objects on it and what else has a figure, in the light of the original program, through the user's
//! camera.
//!
//! What the selected hand holds is outlined, with the plane in which the mouse drags it, its axes and its shadow line.
//!
//! The view only reads. For each object and figure it makes a picture of its own, a [`Visual`], which follows the object smoothly
//! at any frame rate; no entity of the simulation is touched.
//!
//! ```no_run
//! use bevy::prelude::*;
//! use tabletop_core::prelude::*;
//! use tabletop_view::ViewPlugin;
//!
//! App::new()
//!     .add_plugins((DefaultPlugins, CorePlugin::default(), ViewPlugin))
//!     .add_systems(Startup, |mut commands: Commands| {
//!         commands.spawn(Table::default());
//!     })
//!     .run();
//! ```

mod aids;
mod camera;
mod held;
mod markers;
mod mesh;
mod motion;
mod polyhedron;
mod section;
mod sheet;
mod silhouette;
mod surface;
mod viewpoint;
mod visual;

pub use surface::Surface;
pub use viewpoint::{Steering, Viewpoint};
pub use visual::Visual;

use bevy::prelude::*;

/// Draws the simulation and moves the user's camera. Needs Bevy's renderer and [`CorePlugin`](tabletop_core::CorePlugin).
#[derive(Clone, Copy, Debug, Default)]
pub struct ViewPlugin;

impl Plugin for ViewPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins((
            surface::plugin,
            visual::plugin,
            markers::plugin,
            camera::plugin,
            sheet::plugin,
            aids::plugin,
        ));
    }
}
