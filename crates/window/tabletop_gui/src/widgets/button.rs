//! Buttons with words.

use bevy_egui::egui::{Button, Response, RichText, Sense, Ui, vec2};

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

/// The state of a button that acts while it is held down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Hold {
    pub is_held: bool,
    /// True if it has gone down in this frame, even if it is up again.
    pub was_struck: bool,
}

/// A button that acts for as long as it is held down.
pub(crate) fn hold_button(
    ui: &mut Ui,
    is_enabled: bool,
    text: impl Into<RichText>,
    tooltip: &str,
    why_disabled: &str,
) -> Hold {
    let button = Button::new(text.into())
        .min_size(vec2(32.0, 0.0))
        // A widget that can only be clicked would be let go of after a second.
        .sense(Sense::click_and_drag());
    let button = ui
        .add_enabled(is_enabled, button)
        .on_hover_text(tooltip)
        .on_disabled_hover_text(why_disabled);
    let is_held = button.is_pointer_button_down_on();
    let has_gone_down = ui.input(|input| input.pointer.primary_pressed());
    Hold {
        is_held,
        was_struck: has_gone_down && (is_held || button.clicked()),
    }
}
