//! The arrangement of panels: which are open, and their places (report section 2.4).

mod packing;

use std::collections::{BTreeMap, BTreeSet};

use bevy::ecs::resource::Resource;
use bevy_egui::egui::{Pos2, Rect, Vec2, vec2};
use serde::{Deserialize, Serialize};

use self::packing::{DeskSide, PanelPacking};
use crate::{
    panels::panel::{Panel, PanelEdge},
    widgets::style::GAP,
};

/// So much lower is each panel that lies over the others than the one before it, in points: its title is seen.
const CASCADE: f32 = 32.0;

/// The open panels, and their places. At first only Status is open.
#[derive(Resource, Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Panels {
    open: BTreeSet<Panel>,
    /// Those that the user has moved, in points from the upper left corner of the window.
    moved: BTreeMap<Panel, (f32, f32)>,
    /// The order in which all of them are stacked.
    stack: Vec<Panel>,
    alignment: PanelAlignment,
}

/// Where the panels stand that the user has not moved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum PanelAlignment {
    /// At both sides, so that the table between them is seen.
    #[default]
    Sides,
    /// All at the left.
    Left,
}

impl PanelAlignment {
    /// The order in which panels are stacked. At the sides, the first places are of those that a demonstration needs.
    const fn order(self) -> [Panel; Panel::ALL.len()] {
        match self {
            Self::Sides => [
                Panel::Status,
                Panel::DemonstrationTools,
                Panel::Pose,
                Panel::Objects,
                Panel::Timeline,
                Panel::Camera,
                Panel::Robot,
                Panel::Recordings,
                Panel::Plots,
                Panel::Messages,
            ],
            Self::Left => Panel::ALL,
        }
    }
}

impl Default for Panels {
    fn default() -> Self {
        Self {
            open: BTreeSet::from([Panel::Status]),
            moved: BTreeMap::new(),
            stack: PanelAlignment::default().order().into(),
            alignment: PanelAlignment::default(),
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

    /// Stacks the open panels from the top downwards, even those that the user has moved. Those that are closed get the places below.
    pub(crate) fn align(&mut self, alignment: PanelAlignment) {
        self.alignment = alignment;
        self.moved.clear();
        self.stack = alignment.order().into();
        self.stack.sort_by_key(|panel| !self.open.contains(panel));
    }

    /// Puts the upper left corner of a panel there.
    pub(crate) fn move_to(&mut self, panel: Panel, place: Pos2) {
        self.moved.insert(panel, place.into());
    }

    /// True if a panel lies along the lower edge of the desk, as wide as that.
    pub(crate) fn is_docked(&self, panel: Panel) -> bool {
        panel.edge() == PanelEdge::Bottom && !self.moved.contains_key(&panel)
    }

    /// The upper left corner of a panel, so that all of it is seen on the desk if it is not larger than that.
    pub(crate) fn place(&self, panel: Panel, desk: Rect, size: impl Fn(Panel) -> Vec2) -> Pos2 {
        let place = match self.moved.get(&panel) {
            Some(&moved) => moved.into(),
            None if self.is_docked(panel) => desk.left_bottom(),
            None => self.slot(panel, self.undocked(desk, &size), &size),
        };
        kept_on(desk, place, size(panel))
    }

    /// The part of the desk above the docked panels.
    pub(crate) fn undocked(&self, desk: Rect, size: &impl Fn(Panel) -> Vec2) -> Rect {
        let docked = self.open.iter().filter(|&&panel| self.is_docked(panel));
        let height: f32 = docked.map(|&panel| size(panel).y).sum();
        desk.with_max_y(desk.bottom() - height)
    }

    /// The place of a panel beside the others, from its side on, or over them where there is no more room.
    fn slot(&self, panel: Panel, desk: Rect, size: &impl Fn(Panel) -> Vec2) -> Pos2 {
        let mut packing = PanelPacking::new(desk);
        let mut over = 0.0;
        let mut slot = desk.min;
        for &next in self.stack.iter().filter(|&&next| !self.is_docked(next)) {
            let size = size(next);
            let place = packing.pack(size, self.side(next)).unwrap_or_else(|| {
                let middle = (desk.width() - size.x) / 2.0;
                let place = desk.min + vec2(middle, GAP + over);
                over += CASCADE;
                place
            });
            if next == panel {
                slot = place;
            }
        }
        slot
    }

    fn side(&self, panel: Panel) -> DeskSide {
        match (self.alignment, panel.edge()) {
            (PanelAlignment::Left, _) | (PanelAlignment::Sides, PanelEdge::Left) => DeskSide::Left,
            (PanelAlignment::Sides, PanelEdge::Right | PanelEdge::Bottom) => DeskSide::Right,
        }
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
        max: pos2(1700.0, 700.0),
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

    fn rects(panels: &Panels, desk: Rect) -> [Rect; Panel::ALL.len()] {
        Panel::ALL.map(|panel| Rect::from_min_size(panels.place(panel, desk, size), size(panel)))
    }

    #[test]
    fn every_panel_is_in_the_order_of_each_alignment() {
        for alignment in [PanelAlignment::Sides, PanelAlignment::Left] {
            let order = BTreeSet::from(alignment.order());
            assert_eq!(order, BTreeSet::from(Panel::ALL));
        }
    }

    #[test]
    fn every_panel_has_a_place_of_its_own_on_the_desk() {
        let mut panels = Panels::default();
        panels.set_all_open(true);
        for alignment in [PanelAlignment::Sides, PanelAlignment::Left] {
            panels.align(alignment);
            let rects = rects(&panels, WIDE);
            for (i, rect) in rects.iter().enumerate() {
                assert!(WIDE.contains_rect(*rect), "{:?} at {rect}", Panel::ALL[i]);
                let others = &rects[..i];
                assert!(others.iter().all(|other| !other.intersects(*rect)));
            }
        }
    }

    #[test]
    fn panels_stand_at_both_sides_above_the_timeline() {
        let mut panels = Panels::default();
        panels.set_open(Panel::Objects, true);
        let right = 1000.0 - 300.0 - GAP;
        assert_eq!(place(&panels, Panel::Objects), pos2(right, GAP));
        panels.set_open(Panel::Timeline, true);
        assert_eq!(place(&panels, Panel::Timeline), pos2(0.0, 500.0));
        panels.set_open(Panel::DemonstrationTools, true);
        panels.set_open(Panel::Camera, true);
        let below = GAP + 200.0 + GAP;
        assert_eq!(place(&panels, Panel::DemonstrationTools), pos2(GAP, below));
        let beside = GAP + 300.0 + GAP;
        assert_eq!(place(&panels, Panel::Camera), pos2(beside, GAP));
        panels.align(PanelAlignment::Left);
        assert_eq!(place(&panels, Panel::Objects), pos2(beside, below));
        panels.align(PanelAlignment::Sides);
        assert_eq!(place(&panels, Panel::Objects), pos2(right, GAP));
    }

    #[test]
    fn panels_without_room_lie_over_the_others_and_show_their_titles() {
        let mut panels = Panels::default();
        panels.set_all_open(true);
        let rects = rects(&panels, DESK);
        assert!(rects.iter().all(|rect| DESK.contains_rect(*rect)));
        let over: Vec<_> = rects.iter().filter(|rect| rect.min.x == 350.0).collect();
        assert!(over.len() > 1, "{rects:?}");
        for pair in over.windows(2) {
            assert_eq!(pair[1].min.y - pair[0].min.y, CASCADE);
        }
    }

    #[test]
    fn a_timeline_that_is_moved_is_docked_no_longer_until_all_are_aligned() {
        let mut panels = Panels::default();
        assert!(panels.is_docked(Panel::Timeline) && !panels.is_docked(Panel::Status));
        panels.move_to(Panel::Timeline, pos2(100.0, 50.0));
        assert!(!panels.is_docked(Panel::Timeline));
        assert_eq!(place(&panels, Panel::Timeline), pos2(100.0, 50.0));
        panels.align(PanelAlignment::Left);
        assert!(panels.is_docked(Panel::Timeline));
    }

    #[test]
    fn aligned_panels_are_in_order_and_closed_ones_below() {
        let mut panels = Panels::default();
        panels.set_open(Panel::Status, false);
        panels.set_open(Panel::DemonstrationTools, true);
        panels.set_open(Panel::Robot, true);
        panels.move_to(Panel::Robot, pos2(500.0, 500.0));
        panels.align(PanelAlignment::Left);
        let tall = Rect::from_min_size(Pos2::ZERO, vec2(1000.0, 1e6));
        let place = |panel: &Panel| panels.place(*panel, tall, size);
        let mut order: Vec<_> = Panel::ALL.into();
        order.retain(|&panel| !panels.is_docked(panel));
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
