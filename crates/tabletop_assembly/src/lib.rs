//! The content of a task file, taken apart into single objects with unique ids and the joints between them.
//!
//! ```
//! use tabletop_assembly::{IdAllocator, assemble};
//! use tabletop_core::prelude::*;
//!
//! let ball = Shape::Sphere { radius: 0.5, color: Rgb::RED };
//! let ball = SceneItem::Object(ObjectSpec::new("ball", Pose::IDENTITY, 1.0, ball));
//! let scene = SceneSpec { items: vec![ball.clone(), ball], ..Default::default() };
//! let objects = assemble(&scene, &mut IdAllocator::default()).objects;
//! assert_eq!([&objects[0].id, &objects[1].id], ["ball", "ball#0"]);
//! ```

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod assembly;
mod ids;

pub use assembly::{Assembly, assemble};
pub use ids::{IdAllocator, with_unique_ids};
