//! A slider for an angle in whole degrees: a knob on a track, a button at either end, and the number.

use bevy_egui::egui::{
    Button, Color32, CursorIcon, Pos2, Rect, Response, RichText, Sense, Stroke, Ui, WidgetInfo,
    WidgetType, vec2,
};

use crate::widgets::number::number_field;
use tabletop_input::MAX_DEGREES;

/// Degrees for a press on the track beside the knob.
const TRACK_STEP: i32 = 45;

/// Degrees for a press on a button.
const BUTTON_STEP: i32 = 1;

/// Sizes in points.
const HEIGHT: f32 = 20.0;
const TRACK_WIDTH: f32 = 170.0;
const KNOB_RADIUS: f32 = 8.0;

/// Shows the angle, and returns it as the user changes it.
pub(crate) fn angle_slider(ui: &mut Ui, name: &str, color: Color32, degrees: i32) -> i32 {
    let mut changed = degrees;
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 6.0;
        ui.spacing_mut().button_padding.x = 4.0;
        ui.label(RichText::new(name).color(color).strong().monospace());
        if step_button(ui, "⏴", &format!("{name} down by 1°")) {
            changed -= BUTTON_STEP;
        }
        if let Some(degrees) = moved_on_track(ui, name, color, degrees) {
            changed = degrees;
        }
        if step_button(ui, "⏵", &format!("{name} up by 1°")) {
            changed += BUTTON_STEP;
        }
        let title = format!("{name} in degrees");
        let range = -MAX_DEGREES..=MAX_DEGREES;
        let number = number_field(&title, &mut changed, range, |number| number.suffix("°"));
        let number = ui.add_sized(vec2(50.0, HEIGHT), number);
        number.on_hover_text("Drag, or click and type");
    });
    changed.clamp(-MAX_DEGREES, MAX_DEGREES)
}

fn step_button(ui: &mut Ui, text: &str, name: &str) -> bool {
    let button = ui.add(Button::new(text).small().min_size(vec2(18.0, HEIGHT)));
    button.widget_info(|| WidgetInfo::labeled(WidgetType::Button, ui.is_enabled(), name));
    button.on_hover_text(name).clicked()
}

/// The track with its knob: the angle to which a drag of the knob or a press on the track brings it.
fn moved_on_track(ui: &mut Ui, name: &str, color: Color32, degrees: i32) -> Option<i32> {
    let size = vec2(TRACK_WIDTH, HEIGHT);
    let (rect, response) = ui.allocate_exact_size(size, Sense::drag());
    let response = response.on_hover_cursor(CursorIcon::PointingHand);
    response.widget_info(|| WidgetInfo::slider(ui.is_enabled(), f64::from(degrees), name));
    let track = SliderTrack::in_rect(rect);
    paint(ui, &track, &response, color, degrees);
    let knob = response.id;
    let cursor = response.interact_pointer_pos()?;
    if response.drag_started() {
        match track.pressed(cursor, degrees) {
            SliderPress::Knob { offset } => {
                ui.data_mut(|data| data.insert_temp(knob, offset));
            }
            SliderPress::Track { degrees } => {
                ui.data_mut(|data| data.remove::<f32>(knob));
                return Some(degrees);
            }
        }
    }
    let offset = ui.data(|data| data.get_temp::<f32>(knob))?;
    response
        .dragged()
        .then(|| track.degrees_at(cursor.x - offset))
}

fn paint(ui: &Ui, track: &SliderTrack, response: &Response, color: Color32, degrees: i32) {
    let color = if ui.is_enabled() {
        color
    } else {
        ui.visuals().weak_text_color()
    };
    let knob = track.knob(degrees);
    let painter = ui.painter();
    let groove = ui.visuals().widgets.inactive.bg_fill;
    painter.hline(track.left..=track.right, track.y, Stroke::new(4.0, groove));
    let middle = (track.left + track.right) / 2.0;
    painter.vline(
        middle,
        track.y - 6.0..=track.y + 6.0,
        Stroke::new(1.0, groove),
    );
    painter.hline(
        middle.min(knob.x)..=middle.max(knob.x),
        track.y,
        Stroke::new(4.0, color),
    );
    let outline = ui.style().interact(response).fg_stroke;
    painter.circle(knob, KNOB_RADIUS - 1.0, color, outline);
}

/// The track of the angles on the screen.
#[derive(Clone, Copy, Debug)]
struct SliderTrack {
    left: f32,
    right: f32,
    y: f32,
}

/// The part of a slider that a press has hit.
#[derive(Clone, Copy, Debug, PartialEq)]
enum SliderPress {
    /// The knob, so far to the right of its middle.
    Knob { offset: f32 },
    /// The track beside it, which makes this angle of it.
    Track { degrees: i32 },
}

impl SliderTrack {
    fn in_rect(rect: Rect) -> Self {
        Self {
            left: rect.left() + KNOB_RADIUS,
            right: rect.right() - KNOB_RADIUS,
            y: rect.center().y,
        }
    }

    fn knob(&self, degrees: i32) -> Pos2 {
        let fraction = (degrees + MAX_DEGREES) as f32 / (2 * MAX_DEGREES) as f32;
        Pos2::new(self.left + fraction * (self.right - self.left), self.y)
    }

    fn degrees_at(&self, x: f32) -> i32 {
        let fraction = ((x - self.left) / (self.right - self.left)).clamp(0.0, 1.0);
        (fraction * (2 * MAX_DEGREES) as f32).round() as i32 - MAX_DEGREES
    }

    fn pressed(&self, at: Pos2, degrees: i32) -> SliderPress {
        let offset = at.x - self.knob(degrees).x;
        if offset.abs() <= KNOB_RADIUS {
            SliderPress::Knob { offset }
        } else {
            let step = if offset > 0.0 {
                TRACK_STEP
            } else {
                -TRACK_STEP
            };
            let stepped = (degrees + step).clamp(-MAX_DEGREES, MAX_DEGREES);
            SliderPress::Track { degrees: stepped }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy_egui::egui::{Context, Event, Modifiers, PointerButton, RawInput};

    const TRACK: SliderTrack = SliderTrack {
        left: 100.0,
        right: 280.0,
        y: 10.0,
    };

    #[test]
    fn the_knob_stands_at_its_angle() {
        for (degrees, x) in [(-180, 100.0), (0, 190.0), (90, 235.0), (180, 280.0)] {
            assert_eq!(TRACK.knob(degrees).x, x);
            assert_eq!(TRACK.degrees_at(x), degrees);
        }
        assert_eq!(TRACK.degrees_at(0.0), -180);
        assert_eq!(TRACK.degrees_at(1000.0), 180);
    }

    #[test]
    fn a_press_on_the_knob_holds_it_where_it_was_hit() {
        let hit = Pos2::new(193.0, 12.0);
        assert_eq!(TRACK.pressed(hit, 0), SliderPress::Knob { offset: 3.0 });
    }

    #[test]
    fn a_press_on_the_track_steps_towards_it_as_far_as_the_track_goes() {
        for (x, from, to) in [
            (250.0, 0, 45),
            (110.0, 0, -45),
            (279.0, 150, 180),
            (101.0, -150, -180),
        ] {
            let pressed = TRACK.pressed(Pos2::new(x, 10.0), from);
            assert_eq!(pressed, SliderPress::Track { degrees: to });
        }
    }

    /// The angle after a click this far from the left.
    fn clicked_at(x: f32, degrees: i32) -> i32 {
        let context = Context::default();
        let mut degrees = degrees;
        let mut frame = |events| {
            let input = RawInput {
                screen_rect: Some(Rect::from_min_size(Pos2::ZERO, vec2(400.0, 100.0))),
                events,
                ..RawInput::default()
            };
            let _output = context.run_ui(input, |ui| {
                degrees = angle_slider(ui, "X", Color32::RED, degrees);
            });
        };
        let pos = Pos2::new(x, HEIGHT / 2.0 + 2.0);
        let button = |pressed| Event::PointerButton {
            pos,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::default(),
        };
        frame(vec![]);
        frame(vec![Event::PointerMoved(pos)]);
        frame(vec![button(true)]);
        frame(vec![button(false)]);
        degrees
    }

    #[test]
    fn a_click_steps_by_one_at_the_ends_and_by_45_on_the_track() {
        let mut angles: Vec<i32> = (0..400).map(|x| clicked_at(x as f32, 10)).collect();
        angles.dedup();
        // Left to right: name, button, track, knob, track, button, number.
        assert_eq!(angles, [10, 9, -35, 10, 55, 11, 10]);
    }
}
