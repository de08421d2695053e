//! The window of a panel: a title bar to move it by, a button that hides it, and its contents.

use bevy_egui::egui::{
    Align2, Area, Context, CornerRadius, Frame, Id, LayerId, Margin, Order, Pos2, Rect, ScrollArea,
    Sense, Stroke, StrokeKind, TextStyle, Ui, Vec2, WidgetInfo, WidgetType, vec2,
};

use crate::{
    panels::{
        arrangement::{Panels, kept_on},
        bar,
        panel::Panel,
        panel_order::PanelOrder,
    },
    widgets::{
        focus,
        icon::{Icon, icon_button},
        style::{ACCENT, CORNER, MARGIN, ThemeColors},
    },
};

/// Height of the title bar in points.
const TITLE_HEIGHT: f32 = 26.0;

/// The most height of a docked panel, as a share of the desk's.
const DOCK: f32 = 0.4;

/// Height of a panel that has not been seen yet.
const UNKNOWN_HEIGHT: f32 = 160.0;

/// Duration, in seconds, and thickness, in points, of a panel's flashing border.
const FLASH_SECONDS: f64 = 0.4;
const FLASH_WIDTH: f32 = 2.0;

impl Panel {
    /// Shows the panel unless it is closed, and returns the result of its contents.
    pub(crate) fn show<R>(
        self,
        context: &Context,
        panels: &mut Panels,
        content: impl FnOnce(&mut Ui) -> R,
    ) -> Option<R> {
        if !panels.is_open(self) {
            return None;
        }
        let desk = desk(context);
        PanelOrder::note(context, panels);
        let place = panels.place(self, desk, |panel| panel.reserved(context));
        let place = kept_on(desk, place, self.size(context));
        let (width, share) = match panels.is_docked(self) {
            true => (docked_width(context, desk), DOCK),
            false => (self.width(), 1.0),
        };
        let highest = share * desk.height() - TITLE_HEIGHT - 2.0 * f32::from(MARGIN);
        let area = Area::new(self.id()).fixed_pos(place).constrain(false);
        let window = area.show(context, |ui| {
            let spacing = ui.spacing().item_spacing;
            ui.spacing_mut().item_spacing = Vec2::ZERO;
            // Else the panel could not grow.
            ui.set_max_size(vec2(outer_width(width), desk.height()));
            let frame = Frame::window(ui.style()).inner_margin(0);
            let shown = frame.show(ui, |ui| {
                let handled = self.title_bar(ui, place, desk, width);
                let inside = Frame::new().inner_margin(Margin::same(MARGIN));
                let shown = inside.show(ui, |ui| {
                    ui.set_width(width);
                    ui.spacing_mut().item_spacing = spacing;
                    // Without the least height, contents that have grown would be scrolled in their former space.
                    let scroll = ScrollArea::vertical()
                        .min_scrolled_height(highest)
                        .max_height(highest);
                    scroll.auto_shrink([false, true]).show(ui, content).inner
                });
                (handled, shown.inner)
            });
            self.paint_flash(ui, shown.response.rect);
            shown.inner
        });
        let title = || WidgetInfo::labeled(WidgetType::Window, true, self.title());
        window.response.widget_info(title);
        let (handled, content) = window.inner;
        match handled {
            Some(Handled::Moved(to)) => panels.move_to(self, to),
            Some(Handled::Hidden) => panels.set_open(self, false),
            None => {}
        }
        Some(content)
    }

    /// Brings the panel before all others, and lets its border flash.
    pub(crate) fn point_out(self, context: &Context) {
        context.move_to_top(LayerId::new(Order::Middle, self.id()));
        let until = context.input(|input| input.time) + FLASH_SECONDS;
        context.data_mut(|data| data.insert_temp(self.flash_id(), until));
    }

    /// Lets the panel have the keyboard: its first button gets the focus.
    pub(crate) fn take_focus(self, context: &Context) {
        focus::call(context, self.focus_id());
    }

    /// Where it was drawn last.
    pub(crate) fn rect(self, context: &Context) -> Option<Rect> {
        context.memory(|memory| memory.area_rect(self.id()))
    }

    fn focus_id(self) -> Id {
        self.id().with("focus")
    }

    fn id(self) -> Id {
        Id::new(self.title())
    }

    fn flash_id(self) -> Id {
        self.id().with("flash")
    }

    fn size(self, context: &Context) -> Vec2 {
        let unseen = vec2(outer_width(self.width()) + border(context), UNKNOWN_HEIGHT);
        self.rect(context).map_or(unseen, |rect| rect.size())
    }

    /// The size for which it has its place among the others: its own, until all have settled. So no panel jumps when another grows.
    fn reserved(self, context: &Context) -> Vec2 {
        let id = self.id().with("reserved");
        let has_settled = PanelOrder::has_settled(context);
        let reserved = context
            .data(|data| data.get_temp(id))
            .filter(|_| has_settled);
        reserved.unwrap_or_else(|| {
            let size = self.size(context);
            context.data_mut(|data| data.insert_temp(id, size));
            size
        })
    }

    fn title_bar(self, ui: &mut Ui, place: Pos2, desk: Rect, width: f32) -> Option<Handled> {
        let size = vec2(outer_width(width), TITLE_HEIGHT);
        let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
        // As wide as the contents were last, which may need more room than the panel has.
        let seen = self.size(ui.ctx()).x - border(ui.ctx());
        let rect = rect.with_max_x(rect.left() + size.x.max(seen));
        let bar = ui.interact(rect, self.id().with("title bar"), Sense::DRAG);
        bar.widget_info(|| {
            WidgetInfo::labeled(WidgetType::Other, true, format!("Move {}", self.title()))
        });
        let corners = CornerRadius {
            nw: CORNER,
            ne: CORNER,
            ..CornerRadius::ZERO
        };
        ui.painter()
            .rect_filled(rect, corners, ThemeColors::of(ui.visuals()).title);
        let font = TextStyle::Button.resolve(ui.style());
        let color = ui.visuals().strong_text_color();
        let text = self.title();
        ui.painter()
            .text(rect.center(), Align2::CENTER_CENTER, text, font, color);
        let corner = Rect::from_min_max(rect.max - Vec2::splat(TITLE_HEIGHT), rect.max);
        let hide = icon_button(
            ui,
            corner.shrink(2.0),
            Icon::Cross,
            &format!("Hide {}", self.title()),
            "Hide this window",
        );
        focus::answer(&hide, self.focus_id());
        if hide.clicked() {
            return Some(Handled::Hidden);
        }
        let grip = bar.id.with("grip");
        if bar.drag_started() {
            let pressed = ui.input(|input| input.pointer.press_origin())?;
            ui.data_mut(|data| data.insert_temp(grip, pressed - place));
        }
        let grip: Vec2 = ui.data(|data| data.get_temp(grip))?;
        let pointer = bar.interact_pointer_pos().filter(|_| bar.dragged())?;
        Some(Handled::Moved(kept_on(
            desk,
            pointer - grip,
            self.size(ui.ctx()),
        )))
    }

    fn paint_flash(self, ui: &Ui, rect: Rect) {
        let until: Option<f64> = ui.data(|data| data.get_temp(self.flash_id()));
        if until.is_some_and(|until| ui.input(|input| input.time) < until) {
            let stroke = Stroke::new(FLASH_WIDTH, ACCENT);
            let painter = ui.painter();
            painter.rect_stroke(rect, CORNER, stroke, StrokeKind::Inside);
            ui.ctx().request_repaint();
        }
    }
}

/// The width inside the border of a panel with contents of this width.
fn outer_width(width: f32) -> f32 {
    width + 2.0 * f32::from(MARGIN)
}

/// The width of the border at both sides.
fn border(context: &Context) -> f32 {
    2.0 * context.global_style().visuals.window_stroke.width
}

/// The width of the contents of a panel that is as wide as the desk.
fn docked_width(context: &Context, desk: Rect) -> f32 {
    desk.width() - 2.0 * f32::from(MARGIN) - border(context)
}

/// The user's action on a title bar.
enum Handled {
    Moved(Pos2),
    Hidden,
}

/// The room of the panels: all above the bar.
pub(crate) fn desk(context: &Context) -> Rect {
    let mut desk = context.viewport_rect();
    desk.set_bottom(bar::top(context));
    desk
}

/// The part of the desk above the panels that are docked at its lower edge.
pub(crate) fn free_desk(context: &Context, panels: &Panels) -> Rect {
    panels.undocked(desk(context), &|panel| panel.size(context))
}

#[cfg(test)]
mod tests {
    use bevy_egui::egui::pos2;
    use egui_kittest::{Harness, kittest::Queryable as _};

    use super::*;

    const SIZE: Vec2 = vec2(1000.0, 700.0);

    fn harness() -> Harness<'static, Panels> {
        let show = |ui: &mut Ui, panels: &mut Panels| {
            for panel in Panel::ALL {
                panel.show(ui.ctx(), panels, |ui| ui.label(panel.tooltip()));
            }
        };
        Harness::builder()
            .with_size(SIZE)
            .build_ui_state(show, Panels::default())
    }

    fn top_left(harness: &Harness<Panels>, panel: Panel) -> Pos2 {
        let name = format!("Move {}", panel.title());
        harness.get_by_label(&name).rect().min
    }

    fn drag(harness: &mut Harness<Panels>, from: Pos2, to: Pos2) {
        harness.hover_at(from);
        harness.drag_at(from);
        harness.run();
        harness.hover_at(to);
        harness.run();
        harness.drop_at(to);
        harness.run();
    }

    #[test]
    fn only_open_panels_are_shown() {
        let mut harness = harness();
        assert!(harness.query_by_label("Move Status").is_some());
        assert!(harness.query_by_label("Move Robot").is_none());
        harness.state_mut().set_open(Panel::Robot, true);
        harness.run();
        assert!(harness.query_by_label("Move Robot").is_some());
    }

    #[test]
    fn a_panel_is_as_high_as_its_contents_until_it_fills_the_desk() {
        let show = |ui: &mut Ui, (panels, height): &mut (Panels, f32)| {
            let content = |ui: &mut Ui| ui.allocate_space(vec2(10.0, *height));
            Panel::Status.show(ui.ctx(), panels, content);
        };
        let mut harness = Harness::builder()
            .with_size(SIZE)
            .build_ui_state(show, (Panels::default(), 50.0));
        for (content, expected) in [
            (50.0, 50.0),
            (500.0, 500.0),
            (5000.0, SIZE.y - TITLE_HEIGHT - 16.0),
            (80.0, 80.0),
        ] {
            harness.state_mut().1 = content;
            harness.run();
            let window = harness.get_by_label("Status").rect();
            let height = window.height() - TITLE_HEIGHT - 16.0;
            assert!((height - expected).abs() < 3.0, "{height} for {content}");
        }
    }

    #[test]
    fn a_panel_grows_with_its_contents() {
        let show = |ui: &mut Ui, lines: &mut usize| {
            let mut panels = Panels::default();
            Panel::Status.show(ui.ctx(), &mut panels, |ui| {
                for line in 0..*lines {
                    ui.label(format!("line {line}"));
                }
            });
        };
        let mut harness = Harness::builder().with_size(SIZE).build_ui_state(show, 2);
        harness.run();
        *harness.state_mut() = 25;
        harness.run();
        let window = harness.get_by_label("Status").rect();
        let last = harness.get_by_label("line 24").rect();
        assert!(window.contains_rect(last), "{window} {last}");
    }

    #[test]
    fn the_timeline_lies_along_the_lower_edge_until_it_is_dragged_away() {
        let mut harness = harness();
        harness.state_mut().set_open(Panel::Timeline, true);
        harness.run();
        let window = |harness: &Harness<Panels>| harness.get_by_label("Timeline").rect();
        let docked = window(&harness);
        assert_eq!((docked.left(), docked.right()), (0.0, SIZE.x));
        assert_eq!(docked.bottom(), SIZE.y);
        let grip = top_left(&harness, Panel::Timeline) + vec2(50.0, 10.0);
        drag(&mut harness, grip, grip - vec2(0.0, 300.0));
        let dragged = window(&harness);
        assert!(
            dragged.width() < SIZE.x && dragged.bottom() < SIZE.y - 200.0,
            "{dragged}"
        );
    }

    #[test]
    fn no_panel_jumps_when_another_grows() {
        let show = |ui: &mut Ui, (panels, lines): &mut (Panels, usize)| {
            for panel in [Panel::Status, Panel::Robot] {
                panel.show(ui.ctx(), panels, |ui| {
                    for line in 0..*lines {
                        ui.label(format!("{panel:?} {line}"));
                    }
                });
            }
        };
        let mut panels = Panels::default();
        panels.set_open(Panel::Robot, true);
        let mut harness = Harness::builder()
            .with_size(SIZE)
            .with_step_dt(0.1)
            .build_ui_state(show, (panels, 2));
        harness.run_steps(10);
        let place = |harness: &Harness<(Panels, usize)>| {
            let title = harness.get_by_label("Move Robot").rect();
            let status = harness.get_by_label("Status").rect();
            (title.min, status.bottom())
        };
        let (before, bottom) = place(&harness);
        assert!(before.y > bottom, "below the other");
        harness.state_mut().1 = 5;
        harness.run_steps(10);
        assert_eq!(place(&harness).0, before);
        harness.state_mut().0.set_open(Panel::Robot, false);
        harness.run_steps(10);
        harness.state_mut().0.set_open(Panel::Robot, true);
        harness.run_steps(10);
        let (anew, bottom) = place(&harness);
        assert!(anew.y > bottom, "below the other again");
    }

    #[test]
    fn panels_stand_beside_each_other_however_slow_the_first_frames_are() {
        let show = |ui: &mut Ui, panels: &mut Panels| {
            for panel in [Panel::Status, Panel::DemonstrationTools] {
                panel.show(ui.ctx(), panels, |ui| {
                    ui.allocate_space(vec2(10.0, 2.0 * UNKNOWN_HEIGHT))
                });
            }
        };
        let mut panels = Panels::default();
        panels.set_open(Panel::DemonstrationTools, true);
        let mut harness = Harness::builder()
            .with_size(vec2(1000.0, 900.0))
            .with_step_dt(1.0)
            .build_ui_state(show, panels);
        harness.run_steps(10);
        let [upper, lower] =
            ["Status", "Demonstration Tools"].map(|title| harness.get_by_label(title).rect());
        assert!(lower.top() > upper.bottom(), "{upper} {lower}");
    }

    #[test]
    fn the_cross_hides_each_panel() {
        for panel in Panel::ALL {
            let mut harness = harness();
            harness.state_mut().set_open(panel, true);
            harness.run();
            let hide = format!("Hide {}", panel.title());
            harness.get_by_label(&hide).click();
            harness.run();
            assert!(!harness.state().is_open(panel), "{panel:?}");
        }
    }

    #[test]
    fn a_panel_follows_the_mouse_by_its_title() {
        let mut harness = harness();
        let before = top_left(&harness, Panel::Status);
        let grip = before + vec2(50.0, 10.0);
        drag(&mut harness, grip, grip + vec2(200.0, 100.0));
        let after = top_left(&harness, Panel::Status);
        assert_eq!(after, before + vec2(200.0, 100.0));
    }

    #[test]
    fn the_title_bar_is_as_wide_as_wide_contents_with_the_cross_at_its_right() {
        let show = |ui: &mut Ui, (panels, width): &mut (Panels, f32)| {
            let content = |ui: &mut Ui| ui.allocate_space(vec2(*width, 50.0));
            Panel::Status.show(ui.ctx(), panels, content);
        };
        let mut harness = Harness::builder()
            .with_size(SIZE)
            .build_ui_state(show, (Panels::default(), 500.0));
        for width in [500.0, 100.0] {
            harness.state_mut().1 = width;
            harness.run_steps(3);
            let window = harness.get_by_label("Status").rect();
            let bar = harness.get_by_label("Move Status").rect();
            assert!((window.width() - bar.width()).abs() < 4.0, "{window} {bar}");
            let cross = harness.get_by_label("Hide Status").rect();
            assert!(window.right() - cross.right() < 6.0, "{window} {cross}");
            assert!(window.contains_rect(cross), "{window} {cross}");
        }
    }

    #[test]
    fn a_panel_that_is_dragged_off_the_screen_stays_on_it() {
        for to in [pos2(-300.0, -300.0), pos2(5000.0, 5000.0)] {
            let mut harness = harness();
            let grip = top_left(&harness, Panel::Status) + vec2(50.0, 10.0);
            drag(&mut harness, grip, to);
            let window = harness.get_by_label("Status").rect();
            let screen = Rect::from_min_size(Pos2::ZERO, SIZE);
            assert!(screen.contains_rect(window), "{window}");
        }
    }

    #[test]
    fn a_panel_comes_back_when_the_screen_shrinks() {
        let mut harness = harness();
        harness
            .state_mut()
            .move_to(Panel::Status, pos2(690.0, 500.0));
        harness.run();
        harness.set_size(vec2(500.0, 300.0));
        harness.run();
        let window = harness.get_by_label("Status").rect();
        assert!(window.max.x <= 500.0 && window.max.y <= 300.0, "{window}");
    }

    #[test]
    fn a_panel_with_the_keyboard_is_hidden_by_enter() {
        let mut harness = harness();
        harness.state_mut().set_open(Panel::Robot, true);
        Panel::Robot.take_focus(&harness.ctx);
        harness.run();
        harness.key_press(bevy_egui::egui::Key::Enter);
        harness.run();
        assert!(!harness.state().is_open(Panel::Robot));
        assert!(harness.state().is_open(Panel::Status));
    }

    #[test]
    fn a_panel_that_is_pointed_out_flashes_and_then_rests() {
        let mut harness = harness();
        Panel::Status.point_out(&harness.ctx);
        harness.step();
        let accented = |harness: &Harness<Panels>| {
            let shapes = format!("{:?}", harness.output().shapes);
            shapes.contains(&format!("{ACCENT:?}"))
        };
        assert!(accented(&harness));
        // It would never end if a panel kept asking for pictures.
        harness.run();
        assert!(!accented(&harness));
    }
}
