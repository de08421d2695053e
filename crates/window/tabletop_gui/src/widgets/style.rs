//! The style of everything in the window: colours, spaces, corners.

use bevy_egui::egui::{self, Color32, Stroke, Vec2, vec2};

/// The colour of widgets that are on or in use.
pub(crate) const ACCENT: Color32 = Color32::from_rgb(64, 196, 180);

/// The colours of a theme.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ThemeColors {
    /// Background of selected things.
    selected: Color32,
    /// Behind the contents of panels, and behind their titles.
    surface: Color32,
    pub title: Color32,
    /// Behind every other row of a list.
    stripe: Color32,
    /// Borders and lines between groups.
    line: Color32,
    /// Buttons: at rest, under the mouse, pressed.
    button: Color32,
    hovered: Color32,
    pressed: Color32,
    /// The ground on which something is slid or typed.
    groove: Color32,
    field: Color32,
    text: Color32,
    strong: Color32,
    weak: Color32,
    /// Colours of warnings and faults.
    pub warning: Color32,
    pub fault: Color32,
}

const DARK: ThemeColors = ThemeColors {
    selected: Color32::from_rgb(26, 78, 73),
    surface: Color32::from_rgb(24, 26, 30),
    title: Color32::from_rgb(38, 42, 48),
    stripe: Color32::from_rgb(31, 34, 39),
    line: Color32::from_rgb(56, 61, 69),
    button: Color32::from_rgb(50, 55, 63),
    hovered: Color32::from_rgb(66, 73, 83),
    pressed: Color32::from_rgb(34, 112, 104),
    groove: Color32::from_rgb(74, 81, 92),
    field: Color32::from_rgb(14, 15, 18),
    text: Color32::from_rgb(212, 216, 222),
    strong: Color32::from_rgb(245, 247, 250),
    weak: Color32::from_rgb(150, 157, 168),
    warning: Color32::from_rgb(255, 200, 90),
    fault: Color32::from_rgb(255, 125, 115),
};

const LIGHT: ThemeColors = ThemeColors {
    selected: Color32::from_rgb(160, 224, 215),
    surface: Color32::from_rgb(244, 245, 247),
    title: Color32::from_rgb(222, 226, 231),
    stripe: Color32::from_rgb(235, 237, 240),
    line: Color32::from_rgb(190, 196, 204),
    button: Color32::from_rgb(222, 226, 231),
    hovered: Color32::from_rgb(205, 211, 218),
    pressed: Color32::from_rgb(140, 212, 202),
    groove: Color32::from_rgb(178, 185, 194),
    field: Color32::from_rgb(255, 255, 255),
    text: Color32::from_rgb(40, 44, 50),
    strong: Color32::from_rgb(10, 12, 15),
    weak: Color32::from_rgb(95, 102, 112),
    warning: Color32::from_rgb(150, 90, 0),
    fault: Color32::from_rgb(190, 30, 20),
};

impl ThemeColors {
    /// The colours of what is drawn with these visuals.
    pub const fn of(visuals: &egui::Visuals) -> &'static Self {
        match visuals.dark_mode {
            true => &DARK,
            false => &LIGHT,
        }
    }

    /// The colour of plain text.
    pub const fn text(&self) -> Color32 {
        self.text
    }
}

/// Between two panels, in points.
pub(crate) const GAP: f32 = 6.0;

/// Around the contents of a panel, in points.
pub(crate) const MARGIN: i8 = 8;

/// Radius of the corners of panels and their parts, in points.
pub(crate) const CORNER: u8 = 5;
const SMALL_CORNER: u8 = 3;

/// The time in which a panel appears, in seconds.
const FADE: f32 = 0.1;

/// The fonts of egui, where what the first ones lack, such as arrows, comes from the one for code.
pub(crate) fn fonts() -> egui::FontDefinitions {
    let mut fonts = egui::FontDefinitions::default();
    let of_code = fonts.families.get(&egui::FontFamily::Monospace);
    let of_code: Vec<_> = of_code.cloned().unwrap_or_default();
    if let Some(of_texts) = fonts.families.get_mut(&egui::FontFamily::Proportional) {
        let lacking = of_code.into_iter().filter(|font| !of_texts.contains(font));
        let lacking: Vec<_> = lacking.collect();
        of_texts.extend(lacking);
    }
    fonts
}

/// Makes a style ours.
pub(crate) fn dress(style: &mut egui::Style) {
    style.animation_time = FADE;
    let spacing = &mut style.spacing;
    spacing.item_spacing = vec2(8.0, 4.0);
    spacing.button_padding = vec2(8.0, 2.0);
    spacing.interact_size = Vec2::new(36.0, 22.0);
    spacing.window_margin = egui::Margin::same(MARGIN);
    spacing.tooltip_width = 320.0;
    paint(&mut style.visuals);
}

fn paint(visuals: &mut egui::Visuals) {
    let colors = *ThemeColors::of(visuals);
    visuals.window_fill = colors.surface;
    visuals.panel_fill = colors.surface;
    visuals.window_stroke = Stroke::new(1.0, colors.line);
    visuals.window_shadow = egui::Shadow::NONE;
    visuals.popup_shadow = egui::Shadow::NONE;
    visuals.window_corner_radius = CORNER.into();
    visuals.menu_corner_radius = CORNER.into();
    visuals.extreme_bg_color = colors.field;
    visuals.faint_bg_color = colors.stripe;
    visuals.weak_text_color = Some(colors.weak);
    visuals.hyperlink_color = ACCENT;
    visuals.warn_fg_color = colors.warning;
    visuals.error_fg_color = colors.fault;
    visuals.selection.bg_fill = colors.selected;
    visuals.selection.stroke = Stroke::new(1.0, colors.strong);
    visuals.slider_trailing_fill = true;
    let widgets = &mut visuals.widgets;
    widgets.noninteractive.bg_fill = colors.surface;
    widgets.noninteractive.weak_bg_fill = colors.surface;
    widgets.noninteractive.bg_stroke = Stroke::new(1.0, colors.line);
    widgets.noninteractive.fg_stroke = Stroke::new(1.0, colors.text);
    let ThemeColors {
        button,
        hovered,
        pressed,
        groove,
        line,
        weak,
        text,
        strong,
        ..
    } = colors;
    for (state, button, groove, border, text) in [
        (&mut widgets.inactive, button, groove, line, text),
        (&mut widgets.hovered, hovered, groove, weak, strong),
        (&mut widgets.active, pressed, ACCENT, ACCENT, strong),
        (&mut widgets.open, hovered, groove, ACCENT, strong),
    ] {
        state.weak_bg_fill = button;
        state.bg_fill = groove;
        state.bg_stroke = Stroke::new(1.0, border);
        state.fg_stroke = Stroke::new(1.5, text);
        state.expansion = 0.0;
        state.corner_radius = SMALL_CORNER.into();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_stand_out_from_what_is_behind_them_in_each_theme() {
        for colors in [DARK, LIGHT] {
            let luminance = |color: Color32| {
                let [red, green, blue, _] = egui::Rgba::from(color).to_array();
                0.2126 * red + 0.7152 * green + 0.0722 * blue
            };
            // WCAG's contrast of normal text.
            let contrast = |a: Color32, b: Color32| {
                let [a, b] = [luminance(a) + 0.05, luminance(b) + 0.05];
                a.max(b) / a.min(b)
            };
            for text in [
                colors.text,
                colors.strong,
                colors.weak,
                colors.warning,
                colors.fault,
            ] {
                let least = contrast(text, colors.surface);
                assert!(least >= 4.5, "{text:?}: {least}");
            }
            assert!(contrast(colors.text, colors.button) >= 4.5);
            assert!(contrast(colors.strong, colors.pressed) >= 4.5);
        }
    }

    #[test]
    fn texts_have_arrows() {
        let context = egui::Context::default();
        context.set_fonts(fonts());
        let _output = context.run_ui(egui::RawInput::default(), |ui| {
            let font = egui::FontId::proportional(13.0);
            for arrow in ['←', '↑', '→', '↓'] {
                assert!(
                    ui.fonts_mut(|fonts| fonts.has_glyph(&font, arrow)),
                    "{arrow}"
                );
            }
        });
    }
}
