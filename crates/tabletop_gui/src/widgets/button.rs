//! Buttons with words.

use bevy_egui::egui::{Button, Response, Ui};

/// A button that is grey where it cannot be used, and says what it does while the mouse rests on it.
pub(crate) fn button(ui: &mut Ui, is_enabled: bool, text: &str, tooltip: &str) -> Response {
    let button = ui.add_enabled(is_enabled, Button::new(text));
    button
        .on_hover_text(tooltip)
        .on_disabled_hover_text(tooltip)
}

/// A button that shows whether something is on.
pub(crate) fn switch(ui: &mut Ui, is_on: bool, text: &str, tooltip: &str) -> Response {
    ui.add(Button::new(text).selected(is_on))
        .on_hover_text(tooltip)
}
