//! Geometry of solids without a physics step: nearest points and distances.

mod convex;
mod nearby;
mod pressure;
mod touch;

pub(crate) use convex::placed_parts;
pub use convex::{Convex, Nearest, convex_parts, depth, nearest, pushed_out, to_rapier};
pub use nearby::{Nearby, nearby};
pub use pressure::{Pressure, pressures_on};
pub use touch::is_touching;
