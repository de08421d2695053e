//! How commands are told apart.

/// Tells a command from all others of an app. Of two commands, the one that was written later has the larger id.
///
/// A recording keeps no ids: a demonstration without what was undone is the same to the byte as one in which nothing was.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, bevy::reflect::Reflect,
)]
pub struct CommandId(pub u64);
