//! The focus of a widget that is not on the screen yet.

use bevy_egui::egui::{Context, Id, Response};

/// Lets the widget that answers to this name have the keyboard's focus as soon as it is on the screen.
pub(crate) fn call(context: &Context, name: Id) {
    context.data_mut(|data| data.insert_temp(name, ()));
}

/// Gives a widget the focus if it has been [called](call) by this name.
pub(crate) fn answer(widget: &Response, name: Id) {
    let is_called = widget.enabled()
        && widget
            .ctx
            .data_mut(|data| data.remove_temp::<()>(name))
            .is_some();
    if is_called {
        widget.request_focus();
    }
}
