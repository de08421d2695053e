//! Assembly of the elements of a task file into bodies and joints.

mod chain;
mod jointed;
mod lidbox;

use serde::Serialize;
use tabletop_core::{JointSpec, ObjectSpec, SceneItem, SceneSpec, Table};

use crate::ids::{IdAllocator, with_unique_ids};

/// Everything that a scene puts on the table: single objects with unique ids, and the joints between them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Assembly {
    /// The table.
    pub table: Table,
    /// The objects, in the order of the file; chains and lid boxes as their single objects.
    pub objects: Vec<ObjectSpec>,
    /// The joints, in the order of the file.
    pub joints: Vec<JointSpec>,
}

/// Takes a scene apart into objects and joints, and makes the ids unique.
pub fn assemble(scene: &SceneSpec, ids: &mut IdAllocator) -> Assembly {
    let mut assembly = Assembly::on(scene.table);
    for item in &scene.items {
        assembly.add(item, ids);
    }
    assembly
}

impl Assembly {
    /// An assembly of just this table.
    pub const fn on(table: Table) -> Self {
        Self {
            table,
            objects: Vec::new(),
            joints: Vec::new(),
        }
    }

    /// Adds the objects and joints of an item.
    pub fn add(&mut self, item: &SceneItem, ids: &mut IdAllocator) {
        match item {
            SceneItem::Object(spec) => self.objects.push(with_unique_ids(spec.clone(), ids)),
            SceneItem::Chain(spec) => {
                let (objects, joints) = chain::build(spec, ids);
                self.objects.extend(objects);
                self.joints.extend(joints);
            }
            SceneItem::LidBox(spec) => {
                let (objects, joint) = lidbox::build(spec, ids);
                self.objects.extend(objects);
                self.joints.push(joint);
            }
            SceneItem::Jointed(spec) => {
                let (objects, joint) = jointed::build(spec, ids);
                self.objects.extend(objects);
                self.joints.push(joint);
            }
        }
    }
}
