//! Global transforms within a tick.

use bevy::{
    ecs::schedule::ScheduleConfigs,
    ecs::system::ScheduleSystem,
    prelude::*,
    transform::systems::{mark_dirty_trees, propagate_parent_transforms},
};

/// Brings global transforms up to date in the middle of a frame, with the same result as Bevy's own systems. Those share
/// the work among threads at a cost many times that of a tick, so they run only when a tree has moved, after
/// the moved entities are marked (Rapier runs them unmarked, and kinematic bodies with children lose their moves).
pub(crate) fn propagate() -> ScheduleConfigs<ScheduleSystem> {
    (
        sync_roots,
        (mark_dirty_trees, propagate_parent_transforms)
            .chain()
            .run_if(any_tree_has_moved),
    )
        .chain()
}

fn sync_roots(
    mut roots: Query<
        (&Transform, &mut GlobalTransform),
        (
            Or<(Changed<Transform>, Added<GlobalTransform>)>,
            Without<ChildOf>,
            Without<Children>,
        ),
    >,
) {
    for (transform, mut global) in &mut roots {
        *global = GlobalTransform::from(*transform);
    }
}

fn any_tree_has_moved(
    moved: Query<(), (Changed<Transform>, Or<(With<ChildOf>, With<Children>)>)>,
) -> bool {
    !moved.is_empty()
}
