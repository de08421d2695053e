//! The robot's eye: the view of its head camera, as a picture with depth and object numbers, with or without a window.
//!
//! Everything is computed on the processor in IEEE arithmetic, each row by itself, so the same scene gives the same bytes
//! on every run, however many threads draw. Objects are not meshes. Faces are found row by row from the planes through the
//! eye and their edges; cylinders and balls by intersecting each ray with the exact surface. Only visible surfaces are lit. (The rasteriser crate
//! `euc` 0.5 draws the same blocks at a seventh of the speed.) Figures are triangles, lit at their corners.
//! [`Rasterizer`] draws any [`Scene`] for any [`Camera`]; it knows no ECS:
//!
//! ```
//! use tabletop_camera::{Camera, DrawnSolid, Rasterizer, Scene};
//! use tabletop_core::{HeadCamera, Picture, Table};
//!
//! let table = Table::default();
//! let camera = Camera::of_head(&HeadCamera::default(), &table);
//! let mut picture = Picture::default();
//! let scene = Scene {
//!     solids: vec![DrawnSolid::of_table(&table, 1)],
//!     ..Scene::default()
//! };
//! Rasterizer::default().draw(&scene, &camera, &mut picture);
//!
//! let straight_ahead = picture.index(99, 74).unwrap();
//! assert_eq!(picture.objects[straight_ahead], 1);
//! assert!((picture.depth[straight_ahead] - 11.592 / 0.8296).abs() < 0.1);
//! assert_eq!(picture.color(99, 74), Some([255, 255, 255]));
//! ```
//!
//! [`CameraPlugin`] takes the head camera's picture at the end of each tick for which one was asked:
//!
//! ```
//! use bevy::prelude::*;
//! use tabletop_camera::CameraPlugin;
//! use tabletop_core::{PictureDemand, SensorImage, prelude::*};
//!
//! let mut app = App::new();
//! app.add_plugins((MinimalPlugins, CorePlugin::default(), CameraPlugin)).start();
//! let table = app.world_mut().spawn(Table::default()).id();
//! app.world().resource::<PictureDemand>().ask();
//! app.step(1);
//!
//! let image = app.world().resource::<SensorImage>();
//! assert_eq!(image.shown_at(99, 74), Some(table));
//! ```

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod camera;
mod camera_spec;
mod color;
mod hand_cameras;
mod head_camera;
mod raster;
mod scene;
mod studio;
mod visible_world;

pub use camera::{Camera, PictureWindow};
pub use camera_spec::{CameraPlace, CameraSpec};
pub use raster::{PictureLayers, Rasterizer};
pub use scene::{DrawnFigure, DrawnSolid, Facets, Scene};
pub use studio::{SeenThing, Shot, Studio, StudioError};
pub use visible_world::{FiguresSeen, VisibleWorld};

/// The names that most users of this crate need.
pub mod prelude {
    #[doc(hidden)]
    pub use crate::{Camera, CameraPlugin, DrawnFigure, DrawnSolid, Facets, Rasterizer, Scene};
}

use bevy::prelude::*;
use tabletop_core::{
    HeadCamera, Markers, PictureDemand, PictureSystems, RestingSystems, SensorImage,
};
use tabletop_history::RollbackApp;

/// Takes the head camera's picture on demand: of [`HeadCamera`], on [`PictureDemand`], into [`SensorImage`]; and with it those of
/// the hand cameras that [`HandImages`](tabletop_core::HandImages) are asked for.
/// Needs [`CorePlugin`](tabletop_core::CorePlugin).
#[derive(Clone, Copy, Debug, Default)]
pub struct CameraPlugin;

impl Plugin for CameraPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<HeadCamera>()
            .init_resource::<Markers>()
            .init_resource::<PictureDemand>()
            .init_resource::<SensorImage>()
            .init_resource::<head_camera::HeadCameraRenderer>()
            .init_resource::<hand_cameras::HandCameraRenderer>()
            .init_resource::<visible_world::FigureCount>()
            .derived_component::<visible_world::DrawnFacets>()
            .derived_component::<visible_world::ObjectSolids>()
            .add_observer(visible_world::prepare_object)
            .add_observer(visible_world::prepare_figure)
            .add_observer(visible_world::remove_figure)
            .add_systems(
                FixedUpdate,
                (
                    head_camera::render_head_camera,
                    hand_cameras::render_hand_cameras,
                )
                    .in_set(PictureSystems::Draw)
                    .in_set(RestingSystems),
            );
    }
}
