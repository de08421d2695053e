//! Ids of commands.

use bevy::reflect::Reflect;
use serde::Serialize;

/// The id of a command, unique in an app. A later command has a larger id.
///
/// A recording keeps no ids: a demonstration whose undone parts are gone is the same to the byte as one in which nothing was undone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Reflect, Serialize)]
pub struct CommandId(pub u64);
