//! Ids that a task file can have.

use tabletop_core::{BondEnd, ChainSpec, LidBoxSpec, ObjectSpec, SceneItem, Shape};

/// The item with other ids.
pub(super) fn with_ids(item: &SceneItem, mut new: impl FnMut(&str) -> String) -> SceneItem {
    let mut item = item.clone();
    match &mut item {
        SceneItem::Object(ObjectSpec { id, .. })
        | SceneItem::Chain(ChainSpec { id, .. })
        | SceneItem::LidBox(LidBoxSpec { id, .. }) => *id = new(id),
        SceneItem::Jointed(jointed) => {
            for object in &mut jointed.objects {
                object.id = new(&object.id);
            }
        }
    }
    item
}

/// Gives the parts of an item's objects ids that a task file can have.
pub(super) fn mark_parts(item: &mut SceneItem) {
    match item {
        SceneItem::Object(object) => mark_parts_of(&mut object.shape),
        SceneItem::Jointed(jointed) => {
            for object in &mut jointed.objects {
                mark_parts_of(&mut object.shape);
            }
        }
        SceneItem::Chain(_) | SceneItem::LidBox(_) => {}
    }
}

fn mark_parts_of(shape: &mut Shape) {
    if let Shape::Composite { parts } = shape {
        for part in parts {
            part.id = with_marks_of_ids(&part.id);
            mark_parts_of(&mut part.shape);
        }
    }
    if let Shape::BondPoint(point) = shape
        && let BondEnd::Guest(guest) = &mut point.end
    {
        guest.host = with_marks_of_ids(&guest.host);
    }
}

/// The nearest id that a task file can have.
pub(super) fn with_marks_of_ids(id: &str) -> String {
    id.replace(
        |mark: char| mark != '_' && !mark.is_ascii_alphanumeric(),
        "_",
    )
}
