//! Rollback: the entities that undo and redo restore.

use bevy::prelude::*;

/// Marks an entity that undo and redo restore: an object, a joint, the table, a link of the robot. The owners of its components declare
/// which of these are restored.
#[derive(Component, Clone, Copy, Debug, Default, Reflect)]
#[reflect(Component)]
pub struct Rollback;
