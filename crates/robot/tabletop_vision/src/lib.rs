//! The robot's sight: poses of known objects from pictures, by analysis by synthesis.
//!
//! Known are the camera, the table, and each object's shape and colours. [`Eyes`] find the poses with which the drawn picture is the seen
//! one: guesses come from the pixels of an object's colour and the rays through them, and least squares on differences of pixels refine them to a
//! hundredth of a pixel, since smooth edges show where in a pixel an edge is. The pictures are those of [`tabletop_camera`], of which only the window of the object that is moved
//! is drawn anew. The same picture gives the same bits on every processor. Only [`PerceptionPlugin`], which looks
//! at the pictures of a simulated head camera, knows an ECS.
//!
//! ```
//! use bevy::math::Vec3;
//! use tabletop_camera::{Camera, DrawnSolid, Rasterizer, Scene};
//! use tabletop_core::{HeadCamera, Picture, Shape, Table};
//! use tabletop_geometry::{Pose, Rgb};
//! use tabletop_vision::{Eyes, KnownObject, KnownScenery};
//!
//! let table = Table::default();
//! let camera = Camera::of_head(&HeadCamera::default(), &table);
//! let cube = Shape::Block {
//!     span: Vec3::ONE,
//!     color: Rgb::RED,
//! };
//! let pose = Pose::from_degrees(Vec3::new(-2.0, -3.0, 0.5), Vec3::new(0.0, 0.0, 20.0));
//! let mut scene = Scene {
//!     solids: vec![DrawnSolid::of_table(&table, 1)],
//!     ..Scene::default()
//! };
//! let solids = cube.drawn();
//! scene.solids.extend(solids.iter().map(|solid| DrawnSolid::of(pose, solid, 2)));
//! let mut picture = Picture::default();
//! Rasterizer::default().draw(&scene, &camera, &mut picture);
//!
//! let mut eyes = Eyes::new(vec![KnownObject::of(&cube)], camera, table);
//! let seen = eyes.look(&picture, &KnownScenery::default()).objects[0];
//! assert!(seen.is_sure);
//! assert!(seen.pose.unwrap().location.distance(pose.location) < 0.01);
//! ```

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod adaptation;
mod arrangement;
mod calibration;
mod clutter;
mod description;
mod eyes;
mod guess;
mod guide;
mod identity;
mod known;
mod lighting;
mod normal;
mod perception;
mod pixels;
mod refine;
mod residual;
mod segment;
mod support;
mod symmetry;
mod transfer;

pub use calibration::calibrated;
pub use clutter::Clutter;
pub use description::{DescribedObject, Descriptions};
pub use eyes::{Eyes, KnownScenery, ObjectPercept, Percept, PoseDeviation, Visibility};
pub use known::{KnownObject, with_guides};
pub use perception::{PerceivedObject, Perception, PerceptionDemand, PerceptionPlugin};
pub use symmetry::YawSymmetry;
pub use transfer::ToneTransfer;
