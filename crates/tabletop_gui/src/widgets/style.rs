//! How the panels look: dark and flat.

use bevy::prelude::*;
use bevy_egui::{EguiContexts, EguiPrimaryContextPass, egui};

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(EguiPrimaryContextPass, apply);
}

fn apply(mut is_applied: Local<bool>, mut contexts: EguiContexts) {
    if *is_applied {
        return;
    }
    if let Ok(context) = contexts.ctx_mut() {
        context.set_theme(egui::Theme::Dark);
        context.style_mut_of(egui::Theme::Dark, flatten);
        *is_applied = true;
    }
}

fn flatten(style: &mut egui::Style) {
    let visuals = &mut style.visuals;
    visuals.window_shadow = egui::Shadow::NONE;
    visuals.popup_shadow = egui::Shadow::NONE;
    visuals.window_corner_radius = egui::CornerRadius::ZERO;
    visuals.menu_corner_radius = egui::CornerRadius::ZERO;
}
