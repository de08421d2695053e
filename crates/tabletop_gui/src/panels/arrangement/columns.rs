//! Columns of panels at a side of the desk.

use bevy_egui::egui::{Vec2, vec2};

use crate::widgets::style::GAP;

/// Panels that are stacked from the top downwards, in columns: the first is at the side, and each next one nearer to the middle.
pub(super) struct PanelColumns {
    /// The height of the desk.
    height: f32,
    /// The size of each column.
    columns: Vec<Vec2>,
}

impl PanelColumns {
    pub const fn new(height: f32) -> Self {
        Self {
            height,
            columns: Vec::new(),
        }
    }

    /// The width of all columns and of the gaps at their sides.
    pub fn width(&self) -> f32 {
        self.before(self.columns.len())
    }

    /// The width of the first columns, and of the gaps at their sides.
    fn before(&self, number: usize) -> f32 {
        self.columns[..number].iter().map(|c| c.x + GAP).sum()
    }

    /// Stacks a panel: below an earlier column that is no narrower, or in another one if that takes no more than this width. Returns its
    /// distances from the side and from the top.
    pub fn stack(&mut self, size: Vec2, room: f32) -> Option<Vec2> {
        let has_room = |column: &Vec2| size.x <= column.x && GAP + column.y + size.y <= self.height;
        let column = match self.columns.iter().position(has_room) {
            Some(column) => column,
            None if GAP + size.x <= room || self.columns.is_empty() => {
                self.columns.push(vec2(size.x, 0.0));
                self.columns.len() - 1
            }
            None => return None,
        };
        let place = vec2(GAP + self.before(column), GAP + self.columns[column].y);
        self.columns[column].y += size.y + GAP;
        Some(place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROOM: f32 = 1000.0;

    #[test]
    fn a_stack_that_is_too_tall_goes_on_in_another_column() {
        let mut columns = PanelColumns::new(700.0);
        for number in 0..9 {
            let (column, row) = ((number / 3) as f32, (number % 3) as f32);
            let expected = vec2(GAP + column * (300.0 + GAP), GAP + row * (200.0 + GAP));
            assert_eq!(columns.stack(vec2(300.0, 200.0), ROOM), Some(expected));
        }
        assert_eq!(columns.width(), 3.0 * (300.0 + GAP));
    }

    #[test]
    fn a_panel_that_fits_below_an_earlier_column_goes_there() {
        let mut columns = PanelColumns::new(700.0);
        let mut place = |width, height| columns.stack(vec2(width, height), ROOM);
        let second = GAP + 300.0 + GAP;
        assert_eq!(place(300.0, 120.0), Some(vec2(GAP, GAP)));
        assert_eq!(place(300.0, 600.0), Some(vec2(second, GAP)));
        assert_eq!(place(250.0, 120.0), Some(vec2(GAP, GAP + 120.0 + GAP)));
        let third = second + 300.0 + GAP;
        assert_eq!(place(301.0, 60.0), Some(vec2(third, GAP)), "it is too wide");
    }

    #[test]
    fn a_panel_finds_no_place_where_another_column_would_be_too_wide() {
        let mut columns = PanelColumns::new(700.0);
        assert!(columns.stack(vec2(300.0, 600.0), ROOM).is_some());
        assert_eq!(columns.stack(vec2(300.0, 600.0), 300.0), None);
        assert!(columns.stack(vec2(200.0, 80.0), 0.0).is_some());
    }
}
