//! The objects on the table: a list in which they are selected, and what can be done with those that are.

use bevy::math::Vec3;
use bevy_egui::egui::{
    Color32, Rect, ScrollArea, Sense, TextStyle, Ui, Vec2, WidgetInfo, WidgetType, vec2,
};
use tabletop_core::{ObjectEdit, ObjectSpec};
use tabletop_geometry::{Bounds, Pose};

use super::{
    inspector::{self, EditedObject},
    new_objects,
    present_object::PresentObject,
};
use crate::widgets::button::button;

/// Height of the list in points.
const LIST_HEIGHT: f32 = 130.0;

/// Side of the square that shows the colour of an object, in points.
const SWATCH: f32 = 10.0;

/// Distance of a copy from the objects around it, in units.
const GAP: f32 = 0.2;

/// Number of places beside each other that are tried for a copy.
const PLACES: usize = 40;

/// The selected objects, and what the user does with them.
#[derive(Default)]
pub(super) struct ObjectList {
    /// Their ids, in the order in which they were selected. Undo can bring back the object of an id that is not on the table.
    selected: Vec<String>,
    copied: Vec<ObjectSpec>,
    edited: Option<EditedObject>,
    offset: [f32; 3],
}

/// A wish of the user for the list.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum ListRequest {
    /// Choose the object of this id for the keyboard.
    Choose(String),
    Edit(Vec<ObjectEdit>),
}

impl ObjectList {
    /// True if the object of this id is selected.
    pub fn has(&self, id: &str) -> bool {
        self.selected.iter().any(|it| it == id)
    }

    /// Keeps objects for pasting.
    pub fn copy(&mut self, specs: Vec<ObjectSpec>) {
        self.copied = specs;
    }

    /// The edits that take the selected objects from the table: none if one of them is held.
    pub fn removed(&self, objects: &[PresentObject]) -> Vec<ObjectEdit> {
        let selected = self.selected_of(objects);
        if selected.iter().any(|it| it.holder.is_some()) {
            return Vec::new();
        }
        let removed = selected.iter();
        let removed = removed.map(|it| ObjectEdit::Remove(it.spec.id.clone()));
        removed.collect()
    }

    /// Keeps the selected objects for pasting.
    pub fn copy_selected(&mut self, objects: &[PresentObject]) {
        self.copy(self.selected_specs(objects));
    }

    /// The edits that put the copied objects on the table.
    pub fn pasted(&self, objects: &[PresentObject]) -> Vec<ObjectEdit> {
        copies(objects, &self.copied)
    }

    fn selected_specs(&self, objects: &[PresentObject]) -> Vec<ObjectSpec> {
        let selected = self.selected_of(objects).into_iter();
        selected.map(|it| it.spec.clone()).collect()
    }

    fn selected_of<'a>(&self, objects: &'a [PresentObject]) -> Vec<&'a PresentObject> {
        let is_selected = |it: &&PresentObject| self.selected.contains(&it.spec.id);
        objects.iter().filter(is_selected).collect()
    }
}

#[cfg(test)]
impl ObjectList {
    /// Selects objects, and chooses by how much they are to be moved.
    pub fn select_for_move(&mut self, ids: &[&str], offset: [f32; 3]) {
        self.selected = ids.iter().map(|&id| id.to_owned()).collect();
        self.offset = offset;
    }
}

/// Shows the list.
pub(super) fn show(
    ui: &mut Ui,
    objects: &[PresentObject],
    list: &mut ObjectList,
) -> Option<ListRequest> {
    let mut chosen = None;
    let mut edits = Vec::new();
    ui.horizontal(|ui| {
        let count = match objects.len() {
            1 => "1 object on the table".to_owned(),
            many => format!("{many} objects on the table"),
        };
        ui.label(count);
        edits.extend(new_objects::show(ui).map(|spec| added(objects, spec)));
    });
    let height = ui.text_style_height(&TextStyle::Body) + 4.0;
    ScrollArea::vertical()
        .id_salt("objects")
        .max_height(LIST_HEIGHT)
        .auto_shrink([false, true])
        .show_rows(ui, height, objects.len(), |ui, seen| {
            for object in &objects[seen] {
                if row(ui, height, object, &mut list.selected) {
                    chosen = Some(ListRequest::Choose(object.spec.id.clone()));
                }
            }
        });
    edits.extend(tools(ui, objects, list));
    let of_list = |id: &String| objects.iter().find(|it| it.spec.id == *id);
    let selected: Vec<_> = list.selected.iter().filter_map(of_list).collect();
    match selected[..] {
        [] => {}
        [one] => {
            if let Some(edit) = inspector::show(ui, one, &mut list.edited) {
                if let ObjectEdit::Change { object, spec } = &edit {
                    // Undo may bring back the earlier id.
                    list.selected = vec![object.clone(), spec.id.clone()];
                }
                edits.push(edit);
            }
        }
        _ => edits.extend(move_together(ui, &selected, &mut list.offset)),
    }
    chosen.or((!edits.is_empty()).then_some(ListRequest::Edit(edits)))
}

/// The row of an object. Returns whether the user has selected it.
fn row(ui: &mut Ui, height: f32, object: &PresentObject, selected: &mut Vec<String>) -> bool {
    let id = &object.spec.id;
    let is_selected = selected.contains(id);
    let size = vec2(ui.available_width(), height);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    response
        .widget_info(|| WidgetInfo::selected(WidgetType::SelectableLabel, true, is_selected, id));
    let visuals = ui.style().interact_selectable(&response, is_selected);
    if is_selected || response.hovered() {
        ui.painter().rect_filled(rect, 3.0, visuals.bg_fill);
    }
    if let Some(solid) = object.spec.shape.drawn().first() {
        let [red, green, blue] = solid.color.to_bytes();
        let corner = rect.left_center() + vec2(4.0, -SWATCH / 2.0);
        let swatch = Rect::from_min_size(corner, Vec2::splat(SWATCH));
        let color = Color32::from_rgb(red, green, blue);
        ui.painter().rect_filled(swatch, 2.0, color);
    }
    let about = match &object.holder {
        Some(holder) => format!("{}, in {holder}", object.spec.shape.name()),
        None => object.spec.shape.name().to_owned(),
    };
    let visuals = ui.visuals();
    let inks = [visuals.strong_text_color(), visuals.weak_text_color()];
    let painter = ui.painter_at(rect);
    let font = TextStyle::Body.resolve(ui.style());
    let mut at = rect.left_center() + vec2(SWATCH + 10.0, 0.0);
    for (text, ink) in [id.clone(), about].into_iter().zip(inks) {
        let text = painter.layout_no_wrap(text, font.clone(), ink);
        let size = text.size();
        painter.galley(at - vec2(0.0, size.y / 2.0), text, ink);
        at.x += size.x + 8.0;
    }
    if !response.clicked() {
        return false;
    }
    let adds = ui.input(|input| input.modifiers.command);
    match adds {
        true => selected.retain(|it| it != id),
        false => selected.clear(),
    }
    let is_added = !(adds && is_selected);
    if is_added {
        selected.push(id.clone());
    }
    is_added
}

/// The buttons that copy and remove.
fn tools(ui: &mut Ui, objects: &[PresentObject], list: &mut ObjectList) -> Vec<ObjectEdit> {
    let has_some = !list.selected_of(objects).is_empty();
    let removed = list.removed(objects);
    let mut edits = Vec::new();
    ui.horizontal(|ui| {
        let duplicate = "Puts the same objects again beside them";
        if button(ui, has_some, "Duplicate", duplicate).clicked() {
            edits = copies(objects, &list.selected_specs(objects));
        }
        if button(ui, has_some, "Copy", "Keeps these objects for Paste").clicked() {
            list.copy_selected(objects);
        }
        let paste = "Puts the copied objects on the table";
        if button(ui, !list.copied.is_empty(), "Paste", paste).clicked() {
            edits = list.pasted(objects);
        }
        let delete = "Takes these objects from the table; Undo brings them back";
        if button(ui, !removed.is_empty(), "Delete", delete).clicked() {
            edits = removed;
        }
        if button(ui, !objects.is_empty(), "All", "Selects all objects").clicked() {
            list.selected = objects.iter().map(|it| it.spec.id.clone()).collect();
        }
    });
    edits
}

/// The fields that move several objects by the same way.
fn move_together(
    ui: &mut Ui,
    selected: &[&PresentObject],
    offset: &mut [f32; 3],
) -> Vec<ObjectEdit> {
    let are_free = selected.iter().all(|it| it.holder.is_none());
    ui.horizontal(|ui| {
        ui.label(format!("{} objects, move by", selected.len()));
        inspector::numbers(ui, ["Move X", "Move Y", "Move Z"], offset, -50.0..=50.0);
        let text = "Moves all of them by so many units of 10 cm";
        let moves = *offset != [0.0; 3] && are_free;
        if !button(ui, moves, "Move", text).clicked() {
            return Vec::new();
        }
        selected
            .iter()
            .map(|it| {
                let mut spec = it.spec.clone();
                spec.pose.location += Vec3::from_array(*offset);
                spec.dynamics.velocity = Vec3::ZERO;
                ObjectEdit::Change {
                    object: it.spec.id.clone(),
                    spec: Box::new(spec),
                }
            })
            .collect()
    })
    .inner
}

/// A new object above everything at the middle of the table.
fn added(objects: &[PresentObject], mut spec: ObjectSpec) -> ObjectEdit {
    let low = spec.shape.bounds(Pose::at(Vec3::ZERO)).low.z;
    let at_middle = |height| Pose {
        location: Vec3::new(0.0, 0.0, height - low),
        ..spec.pose
    };
    let tops = objects
        .iter()
        .map(|it| it.spec.shape.bounds(it.spec.pose))
        .filter(|bounds| {
            let column = spec.shape.bounds(at_middle(bounds.low.z));
            column.overlaps(*bounds, GAP)
        })
        .map(|bounds| bounds.high.z + GAP);
    spec.pose = at_middle(tops.fold(0.0, f32::max));
    ObjectEdit::Add(Box::new(spec))
}

/// The same objects again, together beside themselves where there is room.
fn copies(objects: &[PresentObject], specs: &[ObjectSpec]) -> Vec<ObjectEdit> {
    let bounds = |spec: &ObjectSpec| spec.shape.bounds(spec.pose);
    let Some(all) = specs.iter().map(bounds).reduce(Bounds::union) else {
        return Vec::new();
    };
    let step = all.high.x - all.low.x + GAP;
    let moved = |bounds: Bounds, steps: f32| Bounds {
        low: bounds.low + Vec3::X * step * steps,
        high: bounds.high + Vec3::X * step * steps,
    };
    // To the right, then to the left, then farther.
    let steps = (1..=PLACES).map(|place| match place % 2 {
        1 => place.div_ceil(2) as f32,
        _ => -((place / 2) as f32),
    });
    let is_free = |steps: &f32| {
        let place = moved(all, *steps);
        objects
            .iter()
            .all(|it| !bounds(&it.spec).overlaps(place, GAP / 4.0))
    };
    let steps = steps.into_iter().find(is_free).unwrap_or(1.0);
    specs
        .iter()
        .map(|spec| {
            let mut spec = spec.clone();
            spec.pose.location.x += step * steps;
            spec.dynamics.velocity = Vec3::ZERO;
            spec.id = spec.id.split('#').next().unwrap_or_default().to_owned();
            ObjectEdit::Add(Box::new(spec))
        })
        .collect()
}
