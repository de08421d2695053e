//! The objects of an imported recording.

use std::path::Path;

use bevy::math::Vec3;
use tabletop_core::{LidBoxSpec, ObjectSpec, SceneItem, SceneSpec, Shape};
use tabletop_geometry::Rgb;
use tabletop_recorder::object_fault;
use tabletop_task::{Demonstration, ShownObject};

use crate::import::motion::Motions;

/// Makes objects plausible that the recording describes wrongly, and leaves out those that have no pose. Returns what was strange.
pub(super) fn plausible(shown: &mut Demonstration, source: &Path) -> Vec<String> {
    let source = source.display();
    let mut remarks = Vec::new();
    for object in &mut shown.objects {
        let spec = &mut object.spec;
        if let Some(fault) = object_fault(spec) {
            remarks.push(format!(
                "{source}: {}: {fault}; it is taken for a block of one unit and 1 kg",
                spec.id
            ));
            *spec = ObjectSpec {
                descriptions: spec.descriptions.clone(),
                ..ObjectSpec::new(spec.id.clone(), spec.pose, 1.0, UNIT_BLOCK)
            };
        }
    }
    shown.objects.retain(|object| {
        let has_pose = object.track.at(object.created).is_some();
        if !has_pose {
            let id = &object.spec.id;
            remarks.push(format!("{source}: {id} has no pose and is left out"));
        }
        has_pose
    });
    remarks
}

const UNIT_BLOCK: Shape = Shape::Block {
    span: Vec3::ONE,
    color: Rgb::GRAY,
};

/// The scene with which the recording begins, as a task file would describe it: the setup, or boxes with their lids and all other objects.
pub(super) fn beginning_scene(
    shown: &Demonstration,
    motions: &Motions,
    setup: Option<&SceneSpec>,
) -> SceneSpec {
    if let Some(setup) = setup {
        return setup.clone();
    }
    let there: Vec<_> = motions.at_beginning(shown).collect();
    let named = |id: &str| there.iter().find(|(object, _)| object.spec.id == id);
    let lidded: Vec<_> = shown
        .joints
        .iter()
        .filter_map(|joint| {
            let [container, lid] = joint.objects.each_ref().map(|id| named(id));
            let ((container, pose), (lid, _)) = (container?, lid?);
            let item = lid_box(container, lid, *pose)?;
            Some((joint.objects.clone(), item))
        })
        .collect();
    let is_alone = |id: &String| !lidded.iter().any(|(ids, _)| ids.contains(id));
    let alone = there.iter().filter(|(object, _)| is_alone(&object.spec.id));
    let alone = alone.map(|(object, pose)| {
        let mut spec = object.spec.clone();
        spec.pose = *pose;
        SceneItem::Object(spec)
    });
    let boxes = lidded
        .iter()
        .map(|(_, item)| SceneItem::LidBox(item.clone()));
    SceneSpec {
        table: shown.table,
        items: alone.chain(boxes).collect(),
    }
}

/// The box with a sliding lid that two objects are.
fn lid_box(
    container: &ShownObject,
    lid: &ShownObject,
    pose: tabletop_geometry::Pose,
) -> Option<LidBoxSpec> {
    let Shape::Box {
        span,
        thickness,
        color,
    } = container.spec.shape
    else {
        return None;
    };
    let Shape::Lid {
        handle_span,
        handle_thickness,
        handle_color,
        ..
    } = lid.spec.shape
    else {
        return None;
    };
    Some(LidBoxSpec {
        id: container.spec.id.strip_suffix("-box")?.to_owned(),
        pose,
        span,
        thickness,
        box_mass: container.spec.mass,
        lid_mass: lid.spec.mass,
        color,
        handle_span,
        handle_thickness,
        handle_color,
        descriptions: Vec::new(),
    })
}
