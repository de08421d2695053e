//! The properties of the selected object, which can be changed.

use std::ops::RangeInclusive;

use bevy::math::Vec3;
use bevy_egui::egui::{TextEdit, Ui, WidgetType};
use tabletop_core::{
    ObjectEdit, ObjectSpec,
    limits::{MASSES, SPANS},
};
use tabletop_geometry::{Pose, Rgb};

use super::present_object::PresentObject;
use crate::widgets::{name::name, number::number_field};

/// Width of the names of the properties, in points.
const NAME_WIDTH: f32 = 66.0;

/// Where an object can be put, in units.
const LOCATIONS: RangeInclusive<f32> = -100.0..=100.0;

/// Friction of a surface.
const FRICTIONS: RangeInclusive<f32> = 0.0..=10.0;

/// The friction of an object whose surface is given one of its own first.
const FRICTION: f32 = 0.5;

/// An object whose properties are being changed.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct EditedObject {
    /// The object as it was before.
    before: ObjectSpec,
    /// The object as it is to be.
    after: ObjectSpec,
    /// Its angles as they are typed, in degrees.
    degrees: [f32; 3],
    /// True while a field is in use.
    is_busy: bool,
}

impl EditedObject {
    fn of(spec: &ObjectSpec) -> Self {
        Self {
            before: spec.clone(),
            after: spec.clone(),
            degrees: spec.pose.degrees().to_array().map(tidy),
            is_busy: false,
        }
    }

    fn is_changed(&self) -> bool {
        self.before != self.after
    }
}

/// Rounds angles for the screen; they are kept only if they are changed.
fn tidy(degrees: f32) -> f32 {
    (degrees * 100.0).round() / 100.0 + 0.0
}

/// Shows the properties of an object. Once a field is left, returns the change.
pub(super) fn show(
    ui: &mut Ui,
    object: &PresentObject,
    edited: &mut Option<EditedObject>,
) -> Option<ObjectEdit> {
    let is_in_use = |edited: &EditedObject| {
        edited.before.id == object.spec.id && (edited.is_busy || edited.is_changed())
    };
    if !edited.as_ref().is_some_and(is_in_use) {
        *edited = Some(EditedObject::of(&object.spec));
    }
    let fields = edited.as_mut()?;
    if let Some(holder) = &object.holder {
        ui.weak(format!("It is in {holder}; release it to change it."));
    }
    let shown = ui.add_enabled_ui(object.holder.is_none(), |ui| properties(ui, fields));
    fields.is_busy = shown.inner || ui.input(|input| input.pointer.any_down());
    if fields.is_busy || !fields.is_changed() {
        return None;
    }
    let EditedObject {
        before, mut after, ..
    } = edited.take()?;
    after.id = after.id.trim().to_owned();
    if after.id.is_empty() {
        after.id.clone_from(&before.id);
    }
    if after.pose == before.pose {
        // It may have moved since.
        after.pose = object.spec.pose;
    }
    after.dynamics.velocity = Vec3::ZERO;
    Some(ObjectEdit::Change {
        object: before.id,
        spec: Box::new(after),
    })
}

/// The fields of all properties. Returns whether one of them is in use.
fn properties(ui: &mut Ui, edited: &mut EditedObject) -> bool {
    let EditedObject { after, degrees, .. } = edited;
    let mut busy = false;
    row(ui, "Id", |ui, label| {
        let room = ui.available_size_before_wrap().x;
        let field = TextEdit::singleline(&mut after.id).desired_width(room);
        let field = ui.add(field).labelled_by(label);
        busy |= field.has_focus();
    });
    row(ui, "Place", |ui, _| {
        let mut place = after.pose.location.to_array();
        let names = ["Place X", "Place Y", "Place Z"];
        let (changed, used) = numbers(ui, names, &mut place, LOCATIONS);
        if changed {
            after.pose.location = Vec3::from_array(place);
        }
        busy |= used;
    });
    row(ui, "Angles °", |ui, _| {
        let names = ["Angle X", "Angle Y", "Angle Z"];
        let (changed, used) = numbers(ui, names, degrees, -180.0..=180.0);
        if changed {
            let [x, y, z] = degrees.map(f64::from);
            let turned = Pose::from_degrees(after.pose.location, [x, y, z]);
            after.pose.rotation = turned.rotation;
        }
        busy |= used;
    });
    busy |= size(ui, after);
    row(ui, "Colour", |ui, _| colors(ui, after));
    row(ui, "Mass kg", |ui, _| {
        busy |= number(ui, "Mass", &mut after.mass, MASSES, 0.05).1;
        if after.mass == 0.0 {
            ui.weak("immovable");
        }
    });
    row(ui, "Friction", |ui, _| {
        let mut has_own = after.dynamics.friction.is_some();
        let check = ui.checkbox(&mut has_own, "its own");
        check.on_hover_text("Otherwise that of the world");
        if has_own != after.dynamics.friction.is_some() {
            after.dynamics.friction = has_own.then_some(FRICTION);
        }
        if let Some(friction) = &mut after.dynamics.friction {
            busy |= number(ui, "Friction", friction, FRICTIONS, 0.01).1;
        }
    });
    busy
}

/// The lengths of the shape, if it has any.
fn size(ui: &mut Ui, after: &mut ObjectSpec) -> bool {
    let shape = after.shape.name();
    let mut busy = false;
    let lengths = after.shape.lengths_mut();
    let title = |index: usize| if index == 0 { shape } else { "" };
    let mut lengths: Vec<_> = lengths.into_iter().collect();
    if lengths.is_empty() {
        row(ui, shape, |ui, _| {
            ui.weak("its size is that of its parts");
        });
    }
    for (index, pair) in lengths.chunks_mut(2).enumerate() {
        row(ui, title(index), |ui, _| {
            for (name, length) in pair {
                ui.weak(*name);
                busy |= number(ui, name, length, SPANS, 0.02).1;
            }
        });
    }
    busy
}

/// A button for each colour of the object.
fn colors(ui: &mut Ui, after: &mut ObjectSpec) {
    let colors = after.shape.colors_mut();
    if colors.is_empty() {
        ui.weak("its colours tell its state");
    }
    for (number, color) in (1..).zip(colors) {
        let mut bytes = color.to_bytes();
        let field = ui.color_edit_button_srgb(&mut bytes);
        name(&field, WidgetType::ColorButton, &format!("Colour {number}"));
        if bytes != color.to_bytes() {
            let [red, green, blue] = bytes.map(|part| f32::from(part) / 255.0);
            *color = Rgb::new(red, green, blue);
        }
    }
}

fn row(ui: &mut Ui, title: &str, content: impl FnOnce(&mut Ui, bevy_egui::egui::Id)) {
    ui.horizontal_wrapped(|ui| {
        let start = ui.cursor().left();
        let label = ui.label(title).id;
        ui.add_space((start + NAME_WIDTH - ui.cursor().left()).max(0.0));
        content(ui, label);
    });
}

/// Three numbers. Returns whether one was changed, and whether one is in use.
pub(super) fn numbers(
    ui: &mut Ui,
    names: [&'static str; 3],
    values: &mut [f32; 3],
    range: RangeInclusive<f32>,
) -> (bool, bool) {
    let mut all = (false, false);
    for (name, value) in names.into_iter().zip(values) {
        let (changed, used) = number(ui, name, value, range.clone(), 0.05);
        all = (all.0 | changed, all.1 | used);
    }
    all
}

fn number(
    ui: &mut Ui,
    name: &'static str,
    value: &mut f32,
    range: RangeInclusive<f32>,
    speed: f64,
) -> (bool, bool) {
    let field = number_field(name, value, range, |field| {
        field
            .speed(speed)
            .max_decimals(3)
            .clamp_existing_to_range(false)
    });
    let field = ui.add(field);
    (field.changed(), field.has_focus() || field.dragged())
}
