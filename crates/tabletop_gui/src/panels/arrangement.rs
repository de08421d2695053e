//! The arrangement of panels: which are open, and their places (report section 2.4).

use std::collections::{BTreeMap, BTreeSet};

use bevy::ecs::resource::Resource;
use bevy_egui::egui::{Pos2, Rect, Vec2, vec2};
use serde::{Deserialize, Serialize};

use crate::{panels::panel::Panel, widgets::style::GAP};

/// The open panels, and their places. At first only Status is open, and all are aligned at the left.
#[derive(Resource, Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Panels {
    open: BTreeSet<Panel>,
    /// Those that the user has moved, in points from the upper left corner of the window.
    moved: BTreeMap<Panel, (f32, f32)>,
    /// The order in which all of them are stacked at the left.
    stack: Vec<Panel>,
}

impl Default for Panels {
    fn default() -> Self {
        Self {
            open: BTreeSet::from([Panel::Status]),
            moved: BTreeMap::new(),
            stack: Panel::ALL.into(),
        }
    }
}

impl Panels {
    /// True if a panel is open.
    pub fn is_open(&self, panel: Panel) -> bool {
        self.open.contains(&panel)
    }

    /// The open panels, from the top of the stack downwards.
    pub(crate) fn open_in_order(&self) -> Vec<Panel> {
        let stack = self.stack.iter().copied();
        stack.filter(|&panel| self.is_open(panel)).collect()
    }

    /// Opens or closes a panel. One that is opened gets the place below those that are open, unless it has one beside them.
    pub fn set_open(&mut self, panel: Panel, is_open: bool) {
        if !is_open {
            self.open.remove(&panel);
        } else if !self.is_open(panel) {
            self.stack_below_open(panel);
            self.open.insert(panel);
        }
    }

    fn stack_below_open(&mut self, panel: Panel) {
        let is_open = |other: &Panel| self.open.contains(other);
        let below = self.stack.iter().rposition(is_open).map_or(0, |i| i + 1);
        if let Some(at) = self.stack.iter().position(|&other| other == panel)
            && at > below
        {
            self.stack[below..=at].rotate_right(1);
        }
    }

    /// Opens or closes all panels.
    pub fn set_all_open(&mut self, are_open: bool) {
        for panel in Panel::ALL {
            self.set_open(panel, are_open);
        }
    }

    /// Stacks the open panels at the left from the top downwards. Those that are closed get the places below.
    pub fn align(&mut self) {
        self.moved.clear();
        self.stack = Panel::ALL.into();
        self.stack.sort_by_key(|panel| !self.open.contains(panel));
    }

    /// Puts the upper left corner of a panel there.
    pub(crate) fn move_to(&mut self, panel: Panel, place: Pos2) {
        self.moved.insert(panel, place.into());
    }

    /// The upper left corner of a panel, so that all of it is seen on the desk if it is not larger than that.
    pub(crate) fn place(&self, panel: Panel, desk: Rect, size: impl Fn(Panel) -> Vec2) -> Pos2 {
        let place = match self.moved.get(&panel) {
            Some(&moved) => moved.into(),
            None => self.slot(panel, desk, &size),
        };
        kept_on(desk, place, size(panel))
    }

    /// The place of a panel in the stack. Where the desk is too low for all, it goes on in another column; a panel that fits below an
    /// earlier column, and is no wider, goes there.
    fn slot(&self, panel: Panel, desk: Rect, size: &impl Fn(Panel) -> Vec2) -> Pos2 {
        let mut columns = vec![Vec2::ZERO];
        let mut slot = (0, 0.0);
        for &next in &self.stack {
            let size = size(next);
            let last = columns.len() - 1;
            let has_room = |(i, column): (usize, &Vec2)| {
                let is_low = column.y == 0.0 || GAP + column.y + size.y <= desk.height();
                is_low && (i == last || size.x <= column.x)
            };
            let column = columns.iter().enumerate().position(has_room);
            let column = column.unwrap_or_else(|| {
                columns.push(Vec2::ZERO);
                columns.len() - 1
            });
            if next == panel {
                slot = (column, columns[column].y);
            }
            columns[column].x = columns[column].x.max(size.x);
            columns[column].y += size.y + GAP;
        }
        let (column, below) = slot;
        let beside: f32 = columns[..column].iter().map(|column| column.x + GAP).sum();
        desk.min + vec2(GAP + beside, GAP + below)
    }

    /// Completes an arrangement from a file, which may be older than a panel.
    pub(crate) fn completed(mut self) -> Self {
        let mut seen = BTreeSet::new();
        self.stack.retain(|&panel| seen.insert(panel));
        let missing = Panel::ALL.into_iter().filter(|panel| !seen.contains(panel));
        self.stack.extend(missing);
        self.moved
            .retain(|_, (x, y)| x.is_finite() && y.is_finite());
        self
    }
}

/// The place next to this one at which something of this size is on the desk; its upper left corner always is.
pub(crate) fn kept_on(desk: Rect, place: Pos2, size: Vec2) -> Pos2 {
    let room = (desk.size() - size).max(vec2(0.0, 0.0));
    place.clamp(desk.min, desk.min + room)
}

#[cfg(test)]
mod tests {
    use bevy_egui::egui::pos2;

    use super::*;

    const DESK: Rect = Rect {
        min: Pos2::ZERO,
        max: pos2(1000.0, 700.0),
    };

    /// One on which all panels have room.
    const WIDE: Rect = Rect {
        min: Pos2::ZERO,
        max: pos2(1300.0, 700.0),
    };

    fn size(_: Panel) -> Vec2 {
        vec2(300.0, 200.0)
    }

    fn place(panels: &Panels, panel: Panel) -> Pos2 {
        panels.place(panel, DESK, size)
    }

    #[test]
    fn only_status_is_open_at_first_in_the_upper_left_corner() {
        let panels = Panels::default();
        let open: Vec<_> = Panel::ALL
            .into_iter()
            .filter(|&panel| panels.is_open(panel))
            .collect();
        assert_eq!(open, [Panel::Status]);
        assert_eq!(place(&panels, Panel::Status), pos2(GAP, GAP));
    }

    #[test]
    fn every_panel_has_a_place_of_its_own_on_the_desk() {
        let mut panels = Panels::default();
        panels.set_all_open(true);
        let place = |panel| panels.place(panel, WIDE, size);
        let rects = Panel::ALL.map(|panel| Rect::from_min_size(place(panel), size(panel)));
        for (i, rect) in rects.iter().enumerate() {
            assert!(WIDE.contains_rect(*rect), "{:?} at {rect}", Panel::ALL[i]);
            let others = &rects[..i];
            assert!(others.iter().all(|other| !other.intersects(*rect)));
        }
    }

    #[test]
    fn a_stack_that_is_too_tall_goes_on_in_another_column() {
        let panels = Panels::default();
        let places: Vec<_> = Panel::ALL
            .into_iter()
            .map(|panel| panels.place(panel, WIDE, size))
            .collect();
        for (i, &place) in places.iter().enumerate() {
            let (column, row) = ((i / 3) as f32, (i % 3) as f32);
            let expected = pos2(GAP + column * (300.0 + GAP), GAP + row * (200.0 + GAP));
            assert_eq!(place, expected);
        }
    }

    #[test]
    fn a_panel_that_fits_below_an_earlier_column_goes_there() {
        let panels = Panels::default();
        let size = |panel: Panel| match panel {
            Panel::Robot => vec2(300.0, 500.0),
            Panel::Timeline => vec2(500.0, 100.0),
            Panel::Status
            | Panel::Camera
            | Panel::DemonstrationTools
            | Panel::Pose
            | Panel::Objects
            | Panel::Recordings
            | Panel::Plots
            | Panel::Messages => vec2(300.0, 120.0),
        };
        let place = |panel| panels.place(panel, DESK, size);
        let below = |rows: f32| GAP + rows * (120.0 + GAP);
        assert_eq!(place(Panel::Camera), pos2(GAP, below(1.0)));
        let second = GAP + 300.0 + GAP;
        assert_eq!(place(Panel::Robot), pos2(second, GAP));
        assert_eq!(place(Panel::DemonstrationTools), pos2(GAP, below(2.0)));
        let under_robot = GAP + 500.0 + GAP;
        assert_eq!(
            place(Panel::Timeline),
            pos2(second, under_robot),
            "too wide for the first"
        );
        assert_eq!(place(Panel::Objects), pos2(GAP, below(4.0)));
    }

    #[test]
    fn aligned_panels_are_in_order_and_closed_ones_below() {
        let mut panels = Panels::default();
        panels.set_open(Panel::Status, false);
        panels.set_open(Panel::DemonstrationTools, true);
        panels.set_open(Panel::Robot, true);
        panels.move_to(Panel::Robot, pos2(500.0, 500.0));
        panels.align();
        let tall = Rect::from_min_size(Pos2::ZERO, vec2(1000.0, 1e6));
        let place = |panel: &Panel| panels.place(*panel, tall, size);
        let mut order = Panel::ALL;
        order.sort_by_key(|panel| place(panel).y as i64);
        let open = [Panel::Robot, Panel::DemonstrationTools];
        assert_eq!(order[..2], open);
        assert!(order[2..].is_sorted());
        assert!(order.iter().all(|panel| place(panel).x == GAP));
        assert_eq!(place(&Panel::Robot).y, GAP);
    }

    #[test]
    fn a_panel_is_opened_below_the_open_ones_and_comes_back_where_it_was() {
        let mut panels = Panels::default();
        let below = |rows: f32| pos2(GAP, GAP + rows * (200.0 + GAP));
        panels.set_open(Panel::DemonstrationTools, true);
        assert_eq!(place(&panels, Panel::DemonstrationTools), below(1.0));
        panels.set_open(Panel::Status, false);
        panels.set_open(Panel::Camera, true);
        assert_eq!(place(&panels, Panel::DemonstrationTools), below(1.0));
        assert_eq!(place(&panels, Panel::Camera), below(2.0));
        panels.set_open(Panel::Status, true);
        assert_eq!(place(&panels, Panel::Status), below(0.0));
    }

    #[test]
    fn a_panel_that_was_moved_off_the_desk_comes_back() {
        let mut panels = Panels::default();
        for (to, expected) in [
            (pos2(-50.0, 20.0), pos2(0.0, 20.0)),
            (pos2(900.0, 800.0), pos2(700.0, 500.0)),
            (pos2(10.0, 20.0), pos2(10.0, 20.0)),
        ] {
            panels.move_to(Panel::Robot, to);
            assert_eq!(place(&panels, Panel::Robot), expected);
        }
    }

    #[test]
    fn a_panel_larger_than_the_desk_shows_its_title() {
        let place = kept_on(DESK, pos2(5.0, 5.0), vec2(2000.0, 2000.0));
        assert_eq!(place, DESK.min);
    }

    #[test]
    fn a_file_that_lacks_panels_or_has_odd_places_is_completed() {
        let panels = Panels {
            stack: vec![Panel::Robot, Panel::Robot],
            moved: BTreeMap::from([(Panel::Robot, (f32::NAN, 3.0))]),
            ..Panels::default()
        };
        let panels = panels.completed();
        assert_eq!(panels.stack.len(), Panel::ALL.len());
        assert_eq!(panels.stack[0], Panel::Robot);
        assert_eq!(panels.moved, BTreeMap::new());
    }
}
