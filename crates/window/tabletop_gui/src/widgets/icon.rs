//! Small pictures on buttons, painted with lines so that they are sharp at any scale.

use bevy_egui::egui::{
    Pos2, Rect, Response, Sense, Shape, Stroke, Ui, Vec2, WidgetInfo, WidgetType, pos2,
};

/// The subject of an icon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Icon {
    /// Lines of a list: everything.
    List,
    /// Boxes at a line on their left: aligned.
    AlignLeft,
    /// Boxes at lines on both sides.
    AlignSides,
    /// Light colours.
    Sun,
    /// Dark colours.
    Moon,
    /// A screen on its foot.
    Screen,
    /// Away.
    Cross,
}

impl Icon {
    /// Its lines, in a square of side 1.
    const fn lines(self) -> &'static [[(f32, f32); 2]] {
        match self {
            Self::List => &[
                [(0.1, 0.2), (0.2, 0.2)],
                [(0.35, 0.2), (0.95, 0.2)],
                [(0.1, 0.5), (0.2, 0.5)],
                [(0.35, 0.5), (0.95, 0.5)],
                [(0.1, 0.8), (0.2, 0.8)],
                [(0.35, 0.8), (0.95, 0.8)],
            ],
            Self::AlignLeft => &[
                [(0.1, 0.05), (0.1, 0.95)],
                [(0.3, 0.3), (0.95, 0.3)],
                [(0.3, 0.3), (0.5, 0.1)],
                [(0.3, 0.3), (0.5, 0.5)],
                [(0.3, 0.75), (0.7, 0.75)],
            ],
            Self::AlignSides => &[
                [(0.05, 0.05), (0.05, 0.95)],
                [(0.05, 0.3), (0.35, 0.3)],
                [(0.05, 0.7), (0.35, 0.7)],
                [(0.95, 0.05), (0.95, 0.95)],
                [(0.65, 0.3), (0.95, 0.3)],
                [(0.65, 0.7), (0.95, 0.7)],
            ],
            Self::Sun => &[
                [(0.5, 0.0), (0.5, 0.18)],
                [(0.5, 0.82), (0.5, 1.0)],
                [(0.0, 0.5), (0.18, 0.5)],
                [(0.82, 0.5), (1.0, 0.5)],
                [(0.15, 0.15), (0.27, 0.27)],
                [(0.73, 0.73), (0.85, 0.85)],
                [(0.15, 0.85), (0.27, 0.73)],
                [(0.73, 0.27), (0.85, 0.15)],
                [(0.35, 0.4), (0.5, 0.3)],
                [(0.5, 0.3), (0.65, 0.4)],
                [(0.65, 0.4), (0.65, 0.6)],
                [(0.65, 0.6), (0.5, 0.7)],
                [(0.5, 0.7), (0.35, 0.6)],
                [(0.35, 0.6), (0.35, 0.4)],
            ],
            Self::Moon => &[
                [(0.6, 0.05), (0.3, 0.15)],
                [(0.3, 0.15), (0.12, 0.4)],
                [(0.12, 0.4), (0.15, 0.7)],
                [(0.15, 0.7), (0.4, 0.93)],
                [(0.4, 0.93), (0.7, 0.9)],
                [(0.7, 0.9), (0.92, 0.7)],
                [(0.92, 0.7), (0.65, 0.65)],
                [(0.65, 0.65), (0.48, 0.48)],
                [(0.48, 0.48), (0.47, 0.25)],
                [(0.47, 0.25), (0.6, 0.05)],
            ],
            Self::Screen => &[
                [(0.05, 0.1), (0.95, 0.1)],
                [(0.95, 0.1), (0.95, 0.7)],
                [(0.95, 0.7), (0.05, 0.7)],
                [(0.05, 0.7), (0.05, 0.1)],
                [(0.5, 0.7), (0.5, 0.92)],
                [(0.25, 0.92), (0.75, 0.92)],
            ],
            Self::Cross => &[[(0.15, 0.15), (0.85, 0.85)], [(0.15, 0.85), (0.85, 0.15)]],
        }
    }

    fn paint(self, ui: &Ui, square: Rect, stroke: Stroke) {
        let at = |(x, y): (f32, f32)| -> Pos2 {
            let size = square.size();
            pos2(square.min.x + x * size.x, square.min.y + y * size.y)
        };
        for line in self.lines() {
            ui.painter().add(Shape::line_segment(line.map(at), stroke));
        }
    }
}

/// A button that shows nothing but a picture, with a name for those who cannot see it.
pub(crate) fn icon_button(ui: &Ui, rect: Rect, icon: Icon, name: &str, tooltip: &str) -> Response {
    let button = ui.interact(rect, ui.id().with(name), Sense::click());
    button.widget_info(|| WidgetInfo::labeled(WidgetType::Button, ui.is_enabled(), name));
    let visuals = ui.style().interact(&button);
    if button.hovered() || button.has_focus() {
        ui.painter()
            .rect_filled(rect, visuals.corner_radius, visuals.weak_bg_fill);
    }
    let side = 0.5 * rect.width().min(rect.height());
    let square = Rect::from_center_size(rect.center(), Vec2::splat(side));
    let stroke = Stroke::new(1.5, visuals.fg_stroke.color);
    icon.paint(ui, square, stroke);
    button.on_hover_text(tooltip)
}
