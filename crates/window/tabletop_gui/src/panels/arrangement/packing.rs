//! Places of panels beside each other on the desk.

use bevy_egui::egui::{Pos2, Rect, Vec2, pos2};

use crate::widgets::style::GAP;

/// A side of the desk, from which panels are packed towards the other one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum DeskSide {
    Left,
    Right,
}

/// Panels that lie on the desk, none over another.
pub(super) struct PanelPacking {
    desk: Rect,
    packed: Vec<Rect>,
}

impl PanelPacking {
    pub const fn new(desk: Rect) -> Self {
        Self {
            desk,
            packed: Vec::new(),
        }
    }

    /// Packs a panel where it is nearest to its side, and there as high as it can be. Returns its upper left corner; `None` if there is no
    /// room.
    pub fn pack(&mut self, size: Vec2, side: DeskSide) -> Option<Pos2> {
        let distances = self.packed.iter().map(|other| match side {
            DeskSide::Left => other.right() - self.desk.left(),
            DeskSide::Right => self.desk.right() - other.left(),
        });
        let mut distances: Vec<_> = distances.chain([0.0]).collect();
        let bottoms = self.packed.iter().map(|other| other.bottom());
        let mut tops: Vec<_> = bottoms.chain([self.desk.top()]).collect();
        distances.sort_by(f32::total_cmp);
        tops.sort_by(f32::total_cmp);
        let tops = &tops;
        let mut places = distances.into_iter().flat_map(|distance| {
            let left = match side {
                DeskSide::Left => self.desk.left() + distance + GAP,
                DeskSide::Right => self.desk.right() - distance - GAP - size.x,
            };
            let places = tops.iter().map(move |top| pos2(left, top + GAP));
            places.map(|place| Rect::from_min_size(place, size))
        });
        let place = places.find(|place| self.is_free(*place))?;
        self.packed.push(place);
        Some(place.min)
    }

    /// True if all of a place is on the desk and beside the others. The first panel may be larger than the desk.
    fn is_free(&self, place: Rect) -> bool {
        let is_on_desk = self.desk.contains_rect(place);
        let mut others = self.packed.iter();
        self.packed.is_empty() || (is_on_desk && others.all(|other| !overlap(*other, place)))
    }
}

/// True if two panels lie over each other, not just at each other.
fn overlap(a: Rect, b: Rect) -> bool {
    a.intersect(b).is_positive()
}

#[cfg(test)]
mod tests {
    use bevy_egui::egui::vec2;

    use super::{
        DeskSide::{Left, Right},
        *,
    };

    fn packing() -> PanelPacking {
        PanelPacking::new(Rect::from_min_size(Pos2::ZERO, vec2(1000.0, 700.0)))
    }

    #[test]
    fn panels_that_are_too_many_for_a_column_go_on_in_another_one() {
        let mut packing = packing();
        for number in 0..9 {
            let (column, row) = ((number / 3) as f32, (number % 3) as f32);
            let expected = pos2(GAP + column * (300.0 + GAP), GAP + row * (200.0 + GAP));
            assert_eq!(packing.pack(vec2(300.0, 200.0), Left), Some(expected));
        }
        assert_eq!(packing.pack(vec2(300.0, 200.0), Left), None);
    }

    #[test]
    fn a_panel_goes_below_narrower_ones_if_nothing_is_in_its_way() {
        let mut packing = packing();
        let mut place = |width, height| packing.pack(vec2(width, height), Left);
        let second = GAP + 300.0 + GAP;
        assert_eq!(place(300.0, 120.0), Some(pos2(GAP, GAP)));
        assert_eq!(place(300.0, 600.0), Some(pos2(second, GAP)));
        let below = GAP + 120.0 + GAP;
        assert_eq!(place(250.0, 120.0), Some(pos2(GAP, below)));
        let third = second + 300.0 + GAP;
        assert_eq!(place(320.0, 90.0), Some(pos2(third, GAP)), "it is too wide");
        let lowest = below + 120.0 + GAP;
        assert_eq!(place(300.0, 400.0), Some(pos2(GAP, lowest)));
        assert_eq!(place(330.0, 400.0), Some(pos2(third, GAP + 90.0 + GAP)));
    }

    #[test]
    fn both_sides_share_the_desk() {
        let mut packing = packing();
        let right = 1000.0 - GAP - 300.0;
        let tall = vec2(300.0, 600.0);
        assert_eq!(packing.pack(tall, Right), Some(pos2(right, GAP)));
        assert_eq!(packing.pack(tall, Left), Some(pos2(GAP, GAP)));
        let beside = right - GAP - 300.0;
        assert_eq!(packing.pack(tall, Right), Some(pos2(beside, GAP)));
        assert_eq!(packing.pack(tall, Left), None);
    }

    #[test]
    fn the_first_panel_may_be_larger_than_the_desk() {
        let mut packing = packing();
        let corner = Some(pos2(GAP, GAP));
        assert_eq!(packing.pack(vec2(2000.0, 2000.0), Left), corner);
    }
}
