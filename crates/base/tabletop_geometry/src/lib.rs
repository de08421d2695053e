//! Geometry: poses, twists, coloured solids, their bounds and distances, and the rays that meet them.
//!
//! Everything is in the table's frame or in one that is said: right-handed, **Z up**, lengths in units of 10 cm, angles in radians.

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod bounds;
mod color;
mod placed_solid;
mod polyhedron;
mod pose;
mod ray;
mod solid;
mod triangles;
mod turn;
mod twist;

pub use bounds::{Bounds, PAIR_GAP};
pub use color::{ColorError, NAMED_COLORS, Rgb};
pub use placed_solid::PlacedSolid;
pub use polyhedron::{MOST_SIDES, Polyhedron, PolyhedronError, ROUND_SIDES};
pub use pose::{Pose, UNITS_PER_METER, degrees_from_quat, quat_from_degrees};
pub use solid::{Primitive, Solid};
pub use triangles::Triangles;
pub use turn::{turn_about, turn_about_x, turn_about_y, turn_about_z};
pub use twist::Twist;
