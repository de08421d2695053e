//! Clicks in tests of panels.

use egui_kittest::{Harness, kittest::Queryable as _};

/// The state of a panel after a click on the widget of this name.
pub(crate) fn after_click<S>(mut harness: Harness<'static, S>, name: &str) -> S {
    harness.get_by_label(name).click();
    harness.run();
    harness.into_state()
}
