//! Names of widgets that show none.

use bevy_egui::egui::{Response, WidgetInfo, WidgetType};

/// Gives a widget without words a name.
pub(crate) fn name(response: &Response, kind: WidgetType, name: &str) {
    response.widget_info(|| WidgetInfo::labeled(kind, response.enabled(), name));
}
