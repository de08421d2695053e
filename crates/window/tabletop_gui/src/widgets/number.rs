//! Fields for numbers.

use std::ops::RangeInclusive;

use bevy_egui::egui::{
    DragValue, Id, Key, Response, Ui, Widget, WidgetType, emath::Numeric, response::Flags,
};

use super::{name::name, typed_number::TypedRange};

/// A number of a range that is dragged, or typed: Enter and a click elsewhere take what is typed, Escape drops it. It is changed when the number is, and
/// not with each letter.
pub(crate) fn number_field<N: Numeric>(
    title: &str,
    number: &mut N,
    range: RangeInclusive<N>,
    style: impl FnOnce(DragValue) -> DragValue,
) -> impl Widget {
    move |ui: &mut Ui| -> Response {
        let before = *number;
        let typed = TypedRange(range.clone());
        let editor = DragValue::new(number).range(range);
        let editor = style(editor).update_while_editing(false);
        let is_dropped = is_dropped(ui, ui.next_auto_id());
        let context = ui.ctx().clone();
        let editor = editor.custom_parser(move |text| match is_dropped {
            true => None,
            false => typed.take(&context, title, text),
        });
        let mut field = ui.add(editor);
        field.flags.set(Flags::CHANGED, *number != before);
        name(&field, WidgetType::DragValue, title);
        field
    }
}

/// True if what was typed into a field is no number, because Escape has ended it. egui would take it a frame after that.
fn is_dropped(ui: &Ui, field: Id) -> bool {
    let is_typed = ui.memory(|memory| memory.has_focus(field));
    let is_escaped = ui.input(|input| input.key_pressed(Key::Escape));
    ui.data_mut(|data| {
        let is_dropped: &mut bool = data.get_temp_mut_or_default(field.with("dropped"));
        *is_dropped = !is_typed && (is_escaped || *is_dropped);
        *is_dropped
    })
}

#[cfg(test)]
mod tests {
    use bevy_egui::egui::{Event, vec2};
    use egui_kittest::{Harness, kittest::Queryable as _};

    use super::*;
    use crate::widgets::typed_number::take_refusals;

    /// Two numbers, and how often they have changed.
    struct Form {
        numbers: [f32; 2],
        changes: usize,
    }

    fn harness() -> Harness<'static, Form> {
        let show = |ui: &mut Ui, form: &mut Form| {
            let [first, second] = &mut form.numbers;
            let first = ui.add(number_field("First", first, -200.0..=200.0, |field| field));
            let second = number_field("Second", second, -180.0..=180.0, |field| field.suffix("°"));
            let second = ui.add_sized(vec2(50.0, 20.0), second);
            form.changes += usize::from(first.changed()) + usize::from(second.changed());
        };
        let form = Form {
            numbers: [1.0, 2.0],
            changes: 0,
        };
        Harness::new_ui_state(show, form)
    }

    fn write(harness: &mut Harness<Form>, name: &str, text: &str) {
        harness.get_by_label(name).click();
        harness.run();
        harness.event(Event::Text(text.to_owned()));
        harness.run();
    }

    #[test]
    fn enter_and_a_click_elsewhere_take_what_is_typed() {
        let mut harness = harness();
        write(&mut harness, "First", "7");
        assert_eq!(harness.state().numbers, [1.0, 2.0], "not yet");
        write(&mut harness, "Second", "8");
        assert_eq!(harness.state().numbers, [7.0, 2.0]);
        harness.key_press(Key::Enter);
        harness.run();
        assert_eq!(harness.state().numbers, [7.0, 8.0]);
        assert_eq!(harness.state().changes, 2);
    }

    #[test]
    fn what_is_no_number_is_refused_once_in_a_sentence() {
        let mut harness = harness();
        for (text, reason) in [
            (
                "2,25",
                "First: `2,25` is not a number, expected a decimal point: 2.25",
            ),
            (
                "nan",
                "First: `nan` is not a number, expected one from -200 to 200",
            ),
            (
                "1e9",
                "First: 1e9 is out of range, expected a number from -200 to 200",
            ),
        ] {
            write(&mut harness, "First", text);
            harness.key_press(Key::Enter);
            harness.run();
            harness.run();
            assert_eq!(harness.state().numbers, [1.0, 2.0], "{text}");
            assert_eq!(take_refusals(&harness.ctx), [reason]);
        }
        write(&mut harness, "First", "nan");
        harness.key_press(Key::Escape);
        harness.run();
        assert_eq!(take_refusals(&harness.ctx), [""; 0]);
    }

    #[test]
    fn escape_drops_what_is_typed() {
        for name in ["First", "Second"] {
            let mut harness = harness();
            write(&mut harness, name, "7");
            harness.key_press(Key::Escape);
            harness.run();
            assert_eq!(harness.state().numbers, [1.0, 2.0], "{name}");
            assert_eq!(harness.state().changes, 0, "{name}");
        }
    }

    #[test]
    fn a_number_can_be_typed_after_escape() {
        let mut harness = harness();
        write(&mut harness, "First", "7");
        harness.key_press(Key::Escape);
        harness.run();
        write(&mut harness, "First", "9");
        harness.key_press(Key::Enter);
        harness.run();
        assert_eq!(harness.state().numbers, [9.0, 2.0]);
    }
}
