//! The extent of a table's top.

use bevy::math::Vec2;
use tabletop_core::Table;

pub(crate) trait Spans {
    /// Its extent along X and Y, in units.
    fn spans(&self) -> Vec2;
}

impl Spans for Table {
    fn spans(&self) -> Vec2 {
        Vec2::new(self.xspan, self.yspan)
    }
}
