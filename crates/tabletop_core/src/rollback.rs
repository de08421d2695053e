//! What undo and redo take back.

use bevy::prelude::*;

/// Marks an entity that undo and redo take back: objects, joints, the table, links of the robot. Whoever owns its components says
/// which of them.
#[derive(Component, Clone, Copy, Debug, Default, Reflect)]
#[reflect(Component)]
pub struct Rollback;
