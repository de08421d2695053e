//! Objects with a joint between them.

use tabletop_core::{JointSpec, JointedSpec, ObjectSpec};

use crate::ids::{IdAllocator, with_unique_ids};

/// The two objects, and the joint between them.
pub(super) fn build(spec: &JointedSpec, ids: &mut IdAllocator) -> ([ObjectSpec; 2], JointSpec) {
    let objects = spec.placed().map(|object| with_unique_ids(object, ids));
    let joint = JointSpec {
        objects: objects.each_ref().map(|object| object.id.clone()),
        frames: spec.frames(),
        kind: spec.kind(),
        collides: spec.collides,
    };
    (objects, joint)
}
