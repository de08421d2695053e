//! The style of everything in the window: colours, spaces, corners.

use bevy::prelude::*;
use bevy_egui::{
    EguiContexts, EguiPrimaryContextPass,
    egui::{self, Color32, Stroke, Vec2, vec2},
};

/// The colour of widgets that are on or in use.
pub(crate) const ACCENT: Color32 = Color32::from_rgb(64, 196, 180);

/// Background of selected things.
const SELECTED: Color32 = Color32::from_rgb(26, 78, 73);

/// Behind the contents of panels, and behind their titles.
const SURFACE: Color32 = Color32::from_rgb(24, 26, 30);
pub(crate) const TITLE: Color32 = Color32::from_rgb(38, 42, 48);

/// Borders and lines between groups.
const LINE: Color32 = Color32::from_rgb(56, 61, 69);

/// Buttons: at rest, under the mouse, pressed.
const BUTTON: Color32 = Color32::from_rgb(50, 55, 63);
const HOVERED: Color32 = Color32::from_rgb(66, 73, 83);
const PRESSED: Color32 = Color32::from_rgb(34, 112, 104);

/// The ground on which something is typed or slid.
const GROOVE: Color32 = Color32::from_rgb(74, 81, 92);
const FIELD: Color32 = Color32::from_rgb(14, 15, 18);

const TEXT: Color32 = Color32::from_rgb(212, 216, 222);
const STRONG: Color32 = Color32::from_rgb(245, 247, 250);
const WEAK: Color32 = Color32::from_rgb(150, 157, 168);

/// Colours of events, warnings and faults.
pub(crate) const EVENT: Color32 = TEXT;
pub(crate) const WARNING: Color32 = Color32::from_rgb(255, 200, 90);
pub(crate) const FAULT: Color32 = Color32::from_rgb(255, 125, 115);

/// Between two panels, in points.
pub(crate) const GAP: f32 = 6.0;

/// Around the contents of a panel, in points.
pub(crate) const MARGIN: i8 = 8;

/// Radius of the corners of panels and their parts, in points.
pub(crate) const CORNER: u8 = 5;
const SMALL_CORNER: u8 = 3;

/// The time in which a panel appears, in seconds.
const FADE: f32 = 0.1;

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(EguiPrimaryContextPass, apply);
}

fn apply(mut is_applied: Local<bool>, mut contexts: EguiContexts) {
    if *is_applied {
        return;
    }
    if let Ok(context) = contexts.ctx_mut() {
        context.set_theme(egui::Theme::Dark);
        context.style_mut_of(egui::Theme::Dark, dress);
        *is_applied = true;
    }
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
    visuals.window_fill = SURFACE;
    visuals.panel_fill = SURFACE;
    visuals.window_stroke = Stroke::new(1.0, LINE);
    visuals.window_shadow = egui::Shadow::NONE;
    visuals.popup_shadow = egui::Shadow::NONE;
    visuals.window_corner_radius = CORNER.into();
    visuals.menu_corner_radius = CORNER.into();
    visuals.extreme_bg_color = FIELD;
    visuals.faint_bg_color = Color32::from_rgb(31, 34, 39);
    visuals.weak_text_color = Some(WEAK);
    visuals.hyperlink_color = ACCENT;
    visuals.warn_fg_color = WARNING;
    visuals.error_fg_color = FAULT;
    visuals.selection.bg_fill = SELECTED;
    visuals.selection.stroke = Stroke::new(1.0, STRONG);
    visuals.slider_trailing_fill = true;
    let widgets = &mut visuals.widgets;
    widgets.noninteractive.bg_fill = SURFACE;
    widgets.noninteractive.weak_bg_fill = SURFACE;
    widgets.noninteractive.bg_stroke = Stroke::new(1.0, LINE);
    widgets.noninteractive.fg_stroke = Stroke::new(1.0, TEXT);
    for (state, button, groove, border, text) in [
        (&mut widgets.inactive, BUTTON, GROOVE, LINE, TEXT),
        (&mut widgets.hovered, HOVERED, GROOVE, WEAK, STRONG),
        (&mut widgets.active, PRESSED, ACCENT, ACCENT, STRONG),
        (&mut widgets.open, HOVERED, GROOVE, ACCENT, STRONG),
    ] {
        state.weak_bg_fill = button;
        state.bg_fill = groove;
        state.bg_stroke = Stroke::new(1.0, border);
        state.fg_stroke = Stroke::new(1.5, text);
        state.expansion = 0.0;
        state.corner_radius = SMALL_CORNER.into();
    }
}
