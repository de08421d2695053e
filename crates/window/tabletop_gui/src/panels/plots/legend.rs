//! The legend below the plot: the names of the curves in their colours. It is as large as they need, which one inside the plot is not.

use std::collections::BTreeSet;

use bevy_egui::egui::{
    Color32, Label, Response, Sense, TextFormat, TextStyle, Ui, WidgetInfo, WidgetType,
    ecolor::Hsva, text::LayoutJob,
};

/// The turn on the colour circle from curve to curve: the golden ratio, so that few are alike.
const TURN: f32 = 0.618_034;

/// The colour of a curve, by its number.
pub(super) fn color(number: usize) -> Color32 {
    Hsva::new(number as f32 * TURN % 1.0, 0.85, 0.5, 1.0).into()
}

/// Shows the legend, and returns the curve that the user hides, or shows again.
pub(super) fn show(ui: &mut Ui, names: &[&str], hidden: &BTreeSet<String>) -> Option<String> {
    let entries = |ui: &mut Ui| {
        let mut clicked = None;
        for (number, &name) in names.iter().enumerate() {
            if entry(ui, name, color(number), !hidden.contains(name)).clicked() {
                clicked = Some(name.to_owned());
            }
        }
        clicked
    };
    ui.horizontal_wrapped(entries).inner
}

fn entry(ui: &mut Ui, name: &str, color: Color32, is_shown: bool) -> Response {
    let (mark, ink) = match is_shown {
        true => ("■ ", ui.visuals().text_color()),
        false => ("□ ", ui.visuals().weak_text_color()),
    };
    let font = TextStyle::Small.resolve(ui.style());
    let mut text = LayoutJob::default();
    text.append(mark, 0.0, TextFormat::simple(font.clone(), color));
    text.append(name, 0.0, TextFormat::simple(font, ink));
    let label = Label::new(text).extend().selectable(false);
    let entry = ui.add(label.sense(Sense::click()));
    entry.widget_info(|| WidgetInfo::selected(WidgetType::Checkbox, true, is_shown, name));
    entry.on_hover_text("Hides this curve, or shows it again")
}
